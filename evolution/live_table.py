"""The one table of all runs and stages: live on a terminal, now and then plain lines elsewhere."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Final

from rich.console import Console, Group, RenderableType
from rich.live import Live
from rich.table import Table
from rich.text import Text

from evolution.standing import Pace, Standing, time_left

# Seconds between two redrawings of the table, and between two groups of plain lines.
LIVE_INTERVAL: Final = 1.0
PLAIN_INTERVAL: Final = 30.0
STYLES: Final = {
    "waiting": "dim", "evolving": "cyan", "testing": "magenta", "done": "green", "damaged": "bold red",
}  # fmt: skip


def run_table(
    standings: Sequence[Standing], pace: Pace, at_once: int, most_rows: int | None = None
) -> RenderableType:
    """The whole in one line, then all runs, one row each; damage is told in full.

    Where there is room for `most_rows` only, runs at work stay longest, then waiting ones.
    """
    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("run", no_wrap=True)
    table.add_column("state", no_wrap=True)
    for heading in ("generation", "best", "tested", "left"):
        table.add_column(heading, justify="right", no_wrap=True)
    for each in _most_telling(standings, most_rows):
        left = pace.left(each) if each.at_work else float("nan")
        state = Text(each.state, style=STYLES[each.state])
        table.add_row(each.name, state, _generation(each), _best(each), _tested(each), duration(left))
    damage = [Text(each.damage, style="red") for each in standings if each.damage]
    return Group(Text(summary_line(standings, pace, at_once)), table, *damage)


def summary_line(standings: Sequence[Standing], pace: Pace, at_once: int) -> str:
    """The whole in one line."""
    done = sum(each.done for each in standings)
    line = f"{done} of {len(standings)} runs done, {sum(each.at_work for each in standings)} at work"
    left = time_left(standings, pace, at_once)
    return line + (f", {duration(left)} to go" if left and not math.isnan(left) else "")


def plain_lines(standings: Sequence[Standing], pace: Pace, at_once: int) -> list[str]:
    """The whole in one line, and a line for every run at work."""
    lines = [summary_line(standings, pace, at_once)]
    for each in standings:
        if each.at_work:
            lines.append(
                f"  {each.name}: {each.state}, generation {_generation(each)}, best {_best(each)}, "
                f"tested {_tested(each)}"
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
        yield _at_intervals(
            PLAIN_INTERVAL,
            lambda: console.print("\n".join(plain_lines(*read(), at_once)), highlight=False, soft_wrap=True),
        )
        return
    # Redrawn by our calls only, without a thread of its own.
    with Live(console=console, auto_refresh=False) as live:

        def redraw() -> None:
            most_rows = max(console.height - 4, 1)
            live.update(run_table(*read(), at_once, most_rows), refresh=True)

        yield _at_intervals(LIVE_INTERVAL, redraw)
        redraw()


def _at_intervals(seconds: float, show: Callable[[], None]) -> Callable[[], None]:
    """Call `show` at most every so many seconds."""
    shown_at = float("-inf")

    def maybe_show() -> None:
        nonlocal shown_at
        if time.monotonic() - shown_at >= seconds:
            show()
            shown_at = time.monotonic()

    return maybe_show


def _most_telling(standings: Sequence[Standing], most: int | None) -> list[Standing]:
    """As many as there is room for, in their order."""
    order = sorted(range(len(standings)), key=lambda i: (not standings[i].at_work, standings[i].done))
    return [standings[i] for i in sorted(order[:most])]


def _generation(each: Standing) -> str:
    return f"{each.generations} of {each.config.settings.generations}"


def _best(each: Standing) -> str:
    return "-" if math.isnan(each.best) else f"{each.best:.3f}"


def _tested(each: Standing) -> str:
    return f"{100 * each.tested / each.to_test:.0f} %" if each.to_test else "-"
