"""Key numbers of several experiments and of the paper side by side, for programs and for a terminal."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np
from rich.table import Table

from arm2d import Condition
from evolution.report.columns import PlainTable
from evolution.results import published
from evolution.results.key_numbers import AT_LIMIT, PLATEAU, SOLVED, WITH_FULL, KeyNumber, by_condition
from evolution.results.records import Results
from evolution.results.wording import TITLES, of, percent


class SideBySide(NamedTuple):
    """A key number of one condition in several experiments, by their names; some may lack it."""

    condition: Condition
    number: KeyNumber
    found: Mapping[str, KeyNumber]


def key_number_table(experiments: Mapping[str, Results]) -> PlainTable[SideBySide]:
    """Conditions and key numbers: the paper's, then ours, of how many, and their range, by experiment."""

    def ours(name: str, text: Callable[[KeyNumber], str]) -> Callable[[SideBySide], str]:
        return lambda row: text(row.found[name]) if name in row.found else ""

    parts: dict[str, Callable[[KeyNumber], str]] = {
        "": lambda number: _rounded(number.ours),
        ", of": lambda number: str(number.of),
        ", lowest run": lambda number: _rounded(number.runs.min() if len(number.runs) else None),
        ", highest run": lambda number: _rounded(number.runs.max() if len(number.runs) else None),
    }
    return PlainTable(
        {
            "condition": lambda row: row.condition,
            "number": lambda row: row.number.name,
            "published": lambda row: _rounded(row.number.published),
            **{f"{name}{part}": ours(name, text) for name in experiments for part, text in parts.items()},
        },
        [
            SideBySide(condition, number, {name: numbers[place] for name, numbers in by_name.items()})
            for condition, by_name in by_condition(experiments).items()
            for place, number in enumerate(next(iter(by_name.values())))
        ],
    )


def comparison_table(experiments: Mapping[str, Results]) -> Table:
    """The same for a terminal."""
    table = Table("condition", "number", "published", *experiments)
    plain = {AT_LIMIT, SOLVED, WITH_FULL}

    def text(name: str, value: float | None, n: int) -> str:
        if value is None or value != value:
            return "-"
        if name == PLATEAU:
            return f"{value:.3f}"
        return of(int(value), n) if name in plain else percent(value)

    for condition, by_name in by_condition(experiments).items():
        for place, number in enumerate(next(iter(by_name.values()))):
            found = {name: numbers[place] for name, numbers in by_name.items()}
            ours = [
                text(number.name, found[name].ours, found[name].of) if name in found else "-"
                for name in experiments
            ]
            table.add_row(
                TITLES[condition], number.name, text(number.name, number.published, published.RUNS), *ours
            )
    return table


def _rounded(value: float | None) -> str:
    """A number as short as it is to four decimals, or nothing."""
    if value is None or np.isnan(value):
        return ""
    return f"{value:.4f}".rstrip("0").rstrip(".")
