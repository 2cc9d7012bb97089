"""The one table of all runs and stages: live on a terminal, now and then plain lines elsewhere."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from statistics import median
from typing import Final

from rich.console import Console, Group, RenderableType
from rich.live import Live
from rich.table import Table
from rich.text import Text

from evolution.experiments.standing import Pace, Standing, time_left

# Seconds between two redrawings of the table, and between two groups of plain lines.
LIVE_INTERVAL: Final = 1.0
PLAIN_INTERVAL: Final = 30.0
# Showing may take at most this share of the time.
LARGEST_SHARE: Final = 0.02
STYLES: Final = {
    "waiting": "dim", "evolving": "cyan", "testing": "magenta", "done": "green", "damaged": "bold red",
}  # fmt: skip


def run_table(
    standings: Sequence[Standing], pace: Pace, at_once: int, most_rows: int | None = None
) -> RenderableType:
    """The whole in one line, then all runs, one row each; damage is told in full.

    Where there is no room for all of them, the runs at work have a row each, and the others are summed up by
    variant and condition.
    """
    damage = [Text(each.damage, style="red") for each in standings if each.damage]
    line = Text(summary_line(standings, pace, at_once))
    if most_rows is None or len(standings) <= most_rows:
        return Group(line, _table_of_runs(standings, pace), *damage)
    at_work = [each for each in standings if each.at_work][: max(most_rows // 2, 1)]
    room = max(most_rows - len(at_work) - len(damage) - 3, 1)
    return Group(line, _table_of_runs(at_work, pace), Text(), *_sums(standings, room), *damage)


def _table_of_runs(standings: Sequence[Standing], pace: Pace) -> Table:
    """One row for each run."""
    table = _table("run", "state", "generation", "best", "tested", "left", left=2)
    for each in standings:
        left = pace.left(each) if each.at_work else float("nan")
        state = Text(each.state, style=STYLES[each.state])
        table.add_row(each.name, state, _generation(each), _best(each), _tested(each), duration(left))
    return table


def _sums(standings: Sequence[Standing], most_rows: int) -> list[RenderableType]:
    """One row for each variant and condition, those at work first, then those that wait."""
    groups: dict[str, list[Standing]] = {}
    for each in standings:
        groups.setdefault(each.name.rpartition(", ")[0], []).append(each)
    order = sorted(groups, key=lambda name: _rest(groups[name]))
    table = _table("all runs of", "done", "at work", "waiting", "best", "median best", left=1)
    for name in order[:most_rows]:
        runs = groups[name]
        done, at_work = sum(each.done for each in runs), sum(each.at_work for each in runs)
        waiting = sum(each.state == "waiting" for each in runs)
        best = [each.best for each in runs if not math.isnan(each.best)]
        middle = f"{median(best):.3f}" if best else "-"
        highest = f"{max(best):.3f}" if best else "-"
        table.add_row(name, f"{done} of {len(runs)}", str(at_work), str(waiting), highest, middle)
    hidden = len(order) - most_rows
    return [table, Text(f"and {hidden} more", style="dim")] if hidden > 0 else [table]


def _rest(runs: Sequence[Standing]) -> int:
    """0 for a group at work, 1 for one that waits, 2 for one that is done."""
    return 0 if any(each.at_work for each in runs) else 2 if all(each.done for each in runs) else 1


def _table(*headings: str, left: int) -> Table:
    """A table without lines, its first columns to the left."""
    table = Table(box=None, pad_edge=False, header_style="bold")
    for i, heading in enumerate(headings):
        table.add_column(heading, no_wrap=i > 0, justify="left" if i < left else "right")
    return table


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
    """Call `show` at most every so many seconds, and less often if it takes long."""
    due_at = float("-inf")

    def maybe_show() -> None:
        nonlocal due_at
        began = time.monotonic()
        if began >= due_at:
            show()
            ended = time.monotonic()
            due_at = ended + max(seconds, (ended - began) / LARGEST_SHARE)

    return maybe_show


def _generation(each: Standing) -> str:
    return f"{each.generations} of {each.config.settings.generations}"


def _best(each: Standing) -> str:
    return "-" if math.isnan(each.best) else f"{each.best:.3f}"


def _tested(each: Standing) -> str:
    return f"{100 * each.tested / each.to_test:.0f} %" if each.to_test else "-"
