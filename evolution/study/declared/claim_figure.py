"""Does INDICATE foster compositionality? Every declared question in one picture, by source of runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from arm2d.drawing import FULL, INK, SMALL, STYLE, look
from evolution.figures.page import FAINT, OURS, RIGHT_END, beside, headed
from evolution.study.declared.claim import Answer
from evolution.study.declared.regression import SIGNIFICANT

# The questions of one panel share a scale: shares of what the panel's title says.
PANELS: Final = {
    "of all late agents": ("fully compositional agents", "partially compositional agents", "agents in "),
    "of runs": ("runs with ",),
    # Named masters in the rows, by the limit of the classes, 75 %: they carry the seven out.
    "of the agents that carry out the seven experienced instructions": ("masters that ",),
    "of the agents of a class: those that pass all changes of one word in mid-trial": (
        "fully compositional agents that",
        "partially compositional agents that",
        "non-compositional agents that",
    ),
}
SPREAD: Final = 0.28  # between sources, of a row
ROW_HEIGHT: Final = 0.4  # [inch]
# Means of fewer runs than this are drawn pale: an interval from so few says little.
FEW, PALE = 5, 0.35
SOURCE_COLOURS: Final = (OURS, "#C2782B", "#444444")


def claim_figure(sources: Mapping[str, Sequence[Answer]], title: str, about: str = "") -> Figure:
    """A row for each question, a dot with its 95 % interval for each source of runs.

    To the right of the line INDICATE is ahead. Dots are filled where the corrected p is below 0.05, and pale
    where fewer than `FEW` runs of a condition can tell; beside them stand the means of both conditions, and
    of how many runs, or of how many worlds that both met.
    """
    names = list(dict.fromkeys(answer.question for own in sources.values() for answer in own))
    panels = {title: own for title, starts in PANELS.items() if (own := _of_panel(names, title, starts))}
    rows = [len(own) for own in panels.values()]
    with look(STYLE):
        figure = Figure(figsize=(FULL, 1.4 + 0.36 * len(rows) + ROW_HEIGHT * sum(rows)), layout="constrained")
        grid = figure.subplots(len(rows), 1, height_ratios=[n + 0.6 for n in rows], squeeze=False)[:, 0]
        for axes, (what, own) in zip(grid, panels.items(), strict=True):
            for place, found in enumerate(sources.values()):
                _draw(axes, found, own, place, len(sources))
            _finish(axes, what, own)
        head = "With-Indicate : With-Ignore,\nmeans of so many runs"
        style = {"va": "bottom", "ha": "left", "fontsize": SMALL, "color": FAINT}
        beside(grid[0], head, (1.0, -0.55), (5.0, 4.0), xycoords=RIGHT_END, **style)
        grid[-1].set_xlabel("With-Indicate less With-Ignore [points]")
        figure.legend(handles=_legend(sources), loc="outside lower center", ncols=len(sources) + 2)
        headed(figure, title, about)
    return figure


def _of_panel(names: Sequence[str], title: str, starts: tuple[str, ...]) -> list[str]:
    """The questions whose shares are of what a panel's title says."""
    own = [name for name in names if name.startswith(starts)]
    # Classes begin alike; those that pass tests are a panel of their own.
    passing = "mid-trial" in title
    return [name for name in own if ("that pass" in name) == passing]


def _draw(axes: Axes, found: Sequence[Answer], names: Sequence[str], place: int, sources: int) -> None:
    """One source's answers."""
    colour = SOURCE_COLOURS[place]
    for answer in found:
        if answer.question not in names:
            continue
        y = names.index(answer.question) + SPREAD * (place - (sources - 1) / 2)
        difference, known = answer.difference, answer.corrected < SIGNIFICANT
        own = {"color": colour, "alpha": 1.0 if min(answer.runs) >= FEW else PALE}
        axes.plot([100 * difference.low, 100 * difference.high], [y, y], lw=1.1, zorder=3, **own)
        face = colour if known else "white"
        axes.plot([100 * difference.value], [y], "o", ms=3.6, mfc=face, mew=0.8, zorder=4, **own)
        style = {"va": "center", "ha": "left", "fontsize": SMALL, "color": colour}
        beside(axes, _means(answer), (1.0, y), (5.0, 0.0), xycoords=RIGHT_END, **style)


def _means(answer: Answer) -> str:
    """The means of both conditions, and the runs behind them."""
    ours, theirs = (percent(mean) for mean in answer.means)
    first, second = answer.runs
    return f"{ours} : {theirs} % of {first}" + (f" : {second}" if second != first else "")


def percent(share: float) -> str:
    """A share in per cent with two digits, and 100."""
    return f"{100 * share:.0f}" if share >= 0.095 else f"{100 * share:.2g}"


def _finish(axes: Axes, what: str, names: Sequence[str]) -> None:
    axes.set_title(what, fontsize=SMALL, color=FAINT, loc="left")
    axes.set_yticks(range(len(names)), [_short(name) for name in names])
    axes.set_ylim(len(names) - 0.45, -0.55)
    axes.axvline(0.0, color=INK, lw=0.7, zorder=1, label="zero")
    axes.xaxis.set_major_locator(MaxNLocator(7, integer=True))
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x", color=FAINT, alpha=0.15, lw=0.5)
    axes.spines["left"].set_visible(False)


def _short(name: str) -> str:
    """A question without what its panel's title says."""
    for start in ("agents in ", "masters that ", "runs with "):
        name = name.removeprefix(start)
    return name.replace(" agents that pass ", ", ").replace(" transitions", " word").removesuffix(" agents")


def _legend(sources: Mapping[str, Sequence[Answer]]) -> list[Line2D]:
    dot = {"marker": "o", "ms": 3.6}
    return [
        *(Line2D([], [], color=SOURCE_COLOURS[i], **dot, label=name) for i, name in enumerate(sources)),
        Line2D([], [], color=INK, ls="", **dot, label="filled: p < 0.05 after correction"),
        Line2D([], [], color=INK, alpha=PALE, **dot, label=f"pale: fewer than {FEW} runs"),
    ]
