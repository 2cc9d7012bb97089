"""The one table of all runs and stages: live on a terminal, now and then plain lines elsewhere."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from statistics import median
from typing import Final, NamedTuple

from rich.console import Console, Group, RenderableType
from rich.live import Live
from rich.text import Text

from evolution.experiments.standing import Pace, Standing, time_left
from evolution.experiments.variants import told_apart
from evolution.runs.intervals import at_intervals

# Seconds between two redrawings of the table, and between two groups of plain lines.
LIVE_INTERVAL: Final = 1.0
PLAIN_INTERVAL: Final = 30.0
# Showing may take at most this share of the time.
LARGEST_SHARE: Final = 0.02
STYLES: Final = {
    "waiting": "dim", "evolving": "cyan", "testing": "magenta", "done": "green", "damaged": "bold red",
}  # fmt: skip
GAP: Final = "  "


class Row(NamedTuple):
    """A line of a table: variant and rest of the name, then cells, the first of which may have a style."""

    variant: str
    rest: str
    cells: tuple[str, ...]
    style: str = ""


def run_table(
    standings: Sequence[Standing],
    pace: Pace,
    at_once: int,
    most_rows: int | None = None,
    width: int | None = None,
) -> RenderableType:
    """The whole in one line, then all runs, one row each; damage is told in full.

    Where there is no room for all of them, the runs at work have a row each, and the others are summed up by
    variant and condition.

    Args:
        standings: Of all runs.
        pace: Of the runs.
        at_once: Processes at a time.
        most_rows: Lines that there is room for; by default any number.
        width: Characters in a line, to which the names of variants are cut; by default they are whole.
    """
    damage = [Text(each.damage, style="red") for each in standings if each.damage]
    line = Text(summary_line(standings, pace, at_once))
    if most_rows is None or len(standings) <= most_rows:
        return Group(line, *_rows_of_runs(standings, pace, width), *damage)
    at_work = [each for each in standings if each.at_work][: max(most_rows // 2, 1)]
    room = max(most_rows - len(at_work) - len(damage) - 3, 1)
    return Group(line, *_rows_of_runs(at_work, pace, width), Text(), *_sums(standings, room, width), *damage)


def _rows_of_runs(standings: Sequence[Standing], pace: Pace, width: int | None) -> list[Text]:
    """One row for each run."""
    headings, cells = ["run", "state", "generation", "best"], [_state, _generation, _best]
    if any(each.to_test for each in standings):
        headings, cells = [*headings, "tested"], [*cells, _tested]
    rows = []
    for standing in standings:
        left = duration(pace.left(standing) if standing.at_work else float("nan"))
        texts = (*(cell(standing) for cell in cells), left)
        rows.append(Row(standing.variant, standing.short_name, texts, STYLES[standing.state]))
    return _aligned([*headings, "left"], rows, width)


def _sums(standings: Sequence[Standing], most_rows: int, width: int | None) -> list[Text]:
    """One row for each variant and condition, those at work first, then those that wait."""
    groups: dict[tuple[str, str], list[Standing]] = {}
    for standing in standings:
        groups.setdefault((standing.variant, str(standing.config.condition)), []).append(standing)
    rows = []
    for variant, condition in sorted(groups, key=lambda group: _rest(groups[group]))[:most_rows]:
        runs = groups[variant, condition]
        best = [each.best for each in runs if not math.isnan(each.best)]
        texts = (
            f"{sum(each.done for each in runs)} of {len(runs)}",
            str(sum(each.at_work for each in runs)),
            str(sum(each.state == "waiting" for each in runs)),
            f"{max(best):.3f}" if best else "-",
            f"{median(best):.3f}" if best else "-",
        )
        rows.append(Row(variant, condition, texts))
    lines = _aligned(["all runs of", "done", "at work", "waiting", "best", "median best"], rows, width)
    hidden = len(groups) - most_rows
    return [*lines, Text(f"and {hidden} more", style="dim")] if hidden > 0 else lines


def _rest(runs: Sequence[Standing]) -> int:
    """0 for a group at work, 1 for one that waits, 2 for one that is done."""
    return 0 if any(each.at_work for each in runs) else 2 if all(each.done for each in runs) else 1


def _aligned(headings: Sequence[str], rows: Sequence[Row], width: int | None) -> list[Text]:
    """Headings and rows as lines, names to the left; where a line is too narrow, its end is cut off."""
    columns = [
        max(map(len, column)) for column in zip(headings[1:], *(row.cells for row in rows), strict=True)
    ]
    room = sys.maxsize if width is None else width - sum(columns) - len(GAP) * len(columns)
    rests = max((len(row.rest) for row in rows), default=0)
    variants = told_apart([row.variant for row in rows], room - rests - len(", "))
    names = [f"{variants[row.variant]}, {row.rest}" if row.variant else row.rest for row in rows]
    first = max(map(len, [headings[0], *names]))

    def line(name: str, cells: Sequence[str], style: str) -> Text:
        # The first cell is a word, the others are numbers.
        padded = [cells[0].ljust(columns[0])] + [
            cell.rjust(size) for cell, size in zip(cells[1:], columns[1:], strict=True)
        ]
        parts = [name.ljust(first), GAP, (padded[0], style), GAP, GAP.join(padded[1:])]
        return Text.assemble(*parts, no_wrap=True, overflow="crop" if width else "ignore")

    heading = line(headings[0], headings[1:], "")
    heading.stylize("bold")
    return [heading, *(line(name, row.cells, row.style) for name, row in zip(names, rows, strict=True))]


def summary_line(standings: Sequence[Standing], pace: Pace, at_once: int) -> str:
    """The whole in one line."""
    done = sum(each.done for each in standings)
    line = f"{done} of {len(standings)} runs done, {sum(each.at_work for each in standings)} at work"
    left = time_left(standings, pace, at_once)
    return line + (f", {duration(left)} to go" if left and not math.isnan(left) else "")


def plain_lines(standings: Sequence[Standing], pace: Pace, at_once: int) -> list[str]:
    """The whole in one line, and a line for every run at work."""
    lines = [summary_line(standings, pace, at_once)]
    for standing in standings:
        if standing.at_work:
            lines.append(
                f"  {standing.name}: {standing.state}, generation {_generation(standing)}, "
                f"best {_best(standing)}, tested {_tested(standing)}"
            )
    return lines


def duration(seconds: float) -> str:
    """A time, as exact as anyone wants to know it; a dash if it is not known."""
    if math.isnan(seconds):
        return "-"
    if seconds < 90:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60:02d} min"


@contextmanager
def shown_table(
    console: Console, read: Callable[[], tuple[Sequence[Standing], Pace]], at_once: int
) -> Iterator[Callable[[], None]]:
    """While open, gives a function to be called often; now and then it reads anew and shows.

    Args:
        console: Where to; what is printed to it meanwhile stands above the table.
        read: Gives the runs' standings and pace.
        at_once: Processes at a time, for what is left.
    """
    if not console.is_terminal:

        def print_lines() -> None:
            console.print("\n".join(plain_lines(*read(), at_once)), highlight=False, soft_wrap=True)

        yield at_intervals(PLAIN_INTERVAL, print_lines, largest_share=LARGEST_SHARE)
        return
    # Redrawn by our calls only, without a thread of its own.
    with Live(console=console, auto_refresh=False) as live:

        def redraw() -> None:
            most_rows = max(console.height - 4, 1)
            live.update(run_table(*read(), at_once, most_rows, console.width), refresh=True)

        yield at_intervals(LIVE_INTERVAL, redraw, largest_share=LARGEST_SHARE)
        redraw()


def _state(each: Standing) -> str:
    return each.state


def _generation(each: Standing) -> str:
    return f"{each.generations} of {each.config.settings.generations}"


def _best(each: Standing) -> str:
    return "-" if math.isnan(each.best) else f"{each.best:.3f}"


def _tested(each: Standing) -> str:
    return f"{100 * each.tested / each.to_test:.0f} %" if each.to_test else "-"
