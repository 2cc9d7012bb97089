"""Doing something now and then that could be done all the time."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import ParamSpec

P = ParamSpec("P")


def at_intervals(
    seconds: float, act: Callable[P, object], *, largest_share: float = 1.0
) -> Callable[P, None]:
    """A function to be called often, which calls `act` the first time and then at most every so often.

    Args:
        seconds: Between the end of one call and the next.
        act: What is done.
        largest_share: Of the time, that `act` may take: it is called less often if it takes long.
    """
    due_at = float("-inf")

    def maybe(*arguments: P.args, **options: P.kwargs) -> None:
        nonlocal due_at
        began = time.monotonic()
        if began >= due_at:
            act(*arguments, **options)
            ended = time.monotonic()
            due_at = ended + max(seconds, (ended - began) / largest_share)

    return maybe
