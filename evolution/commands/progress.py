"""Showing how a run gets on: a live line on a terminal, now and then a line elsewhere."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from evolution.runs.intervals import at_intervals
from evolution.runs.run import Progress as Scored

# Seconds between two plain lines, and between two redrawings of the live one.
PLAIN_INTERVAL: Final = 10.0
LIVE_INTERVAL: Final = 0.25


@contextmanager
def shown_progress(console: Console, total: int) -> Iterator[Callable[[Scored], None]]:
    """While open, gives a function to be called after each generation of a run of `total`."""
    if console.is_terminal:
        with _live_bar(console) as bar:
            yield _and_the_last(total, LIVE_INTERVAL, _redraw(bar, total))
    else:
        yield _and_the_last(total, PLAIN_INTERVAL, _plain_line(console, total))


def _and_the_last(total: int, seconds: float, show: Callable[[Scored], None]) -> Callable[[Scored], None]:
    """Call `show` at most every so many seconds, and for the last generation."""
    now_and_then = at_intervals(seconds, show)
    return lambda scored: (show if scored.generation == total - 1 else now_and_then)(scored)


def _live_bar(console: Console) -> Progress:
    """The live line: it is redrawn by our calls only, without a thread of its own."""
    return Progress(
        TextColumn("generation"),
        MofNCompleteColumn(),
        BarColumn(),
        TextColumn("best {task.fields[best]:.3f}  mean {task.fields[mean]:.3f}"),
        TimeRemainingColumn(),
        console=console,
        auto_refresh=False,
        transient=False,
    )


def _redraw(bar: Progress, total: int) -> Callable[[Scored], None]:
    """Bring the live line up to date."""
    task = None

    def redraw(scored: Scored) -> None:
        nonlocal task
        if task is None:
            task = bar.add_task("", total=total, best=0.0, mean=0.0, completed=scored.generation)
        bar.update(task, completed=scored.generation + 1, best=scored.best, mean=scored.mean, refresh=True)

    return redraw


def _plain_line(console: Console, total: int) -> Callable[[Scored], None]:
    """Print a line with the time still to go, at the pace so far."""
    first: tuple[int, float] | None = None

    def print_line(scored: Scored) -> None:
        nonlocal first
        now = time.monotonic()
        first = first or (scored.generation, now)
        done, elapsed = scored.generation - first[0], now - first[1]
        remaining = f", {elapsed / done * (total - 1 - scored.generation):.0f} s to go" if done else ""
        console.print(
            f"generation {scored.generation + 1} of {total}: "
            f"best {scored.best:.3f}, mean {scored.mean:.3f}{remaining}",
            highlight=False,
        )

    return print_line
