"""Numbers as text, the same in every table, sentence and figure."""

from __future__ import annotations

import math
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from arm2d import Condition

TITLES: Final = MappingProxyType(
    {Condition.WITH_INDICATE: "With-Indicate", Condition.WITH_IGNORE: "With-Ignore"}
)
NOT_GIVEN: Final = "not given"


@dataclass(frozen=True)
class Line:
    """One row of a table of pairs: what it is, then (paper, ours) for each condition."""

    what: str
    pairs: tuple[tuple[str, str], ...]


def percent(share: float) -> str:
    """A share in per cent; small ones with more digits, so that few agents are not shown as none."""
    if share == 0:
        return "0 %"
    return f"{100 * share:.1f} %" if share >= 0.001 else f"{100 * share:.3f} %"


def p_value(p: float) -> str:
    """A p-value as exact as it makes sense."""
    if math.isnan(p):
        return "not defined"
    if p < 1e-300:
        return "below 1e-300"
    return f"{p:.2g}" if p < 0.995 else "1"


def of(part: int, whole: int) -> str:
    """Such as "3 of 10"."""
    return f"{part:,} of {whole:,}"


def points(difference: float) -> str:
    """A difference of shares in percentage points, with its sign."""
    rounded = round(100 * difference, 1) + 0.0  # no minus before nought
    return f"{rounded:+.1f}".replace("-", "−") if rounded else "0.0"  # noqa: RUF001 - minus
