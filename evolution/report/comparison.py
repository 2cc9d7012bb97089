"""Key numbers of several experiments beside each other, for a terminal."""

from __future__ import annotations

from collections.abc import Mapping

from rich.table import Table

from evolution.results.key_numbers import AT_LIMIT, PLATEAU, SOLVED, WITH_FULL, by_condition
from evolution.results.records import Results
from evolution.results.wording import TITLES, of, percent


def comparison_table(results: Mapping[str, Results]) -> Table:
    """The same as comparison.csv, for people."""
    table = Table("condition", "number", "published", *results)
    plain = {AT_LIMIT, SOLVED, WITH_FULL}

    def text(name: str, value: float | None, n: int) -> str:
        if value is None or value != value:
            return "-"
        if name == PLATEAU:
            return f"{value:.3f}"
        return of(int(value), n) if name in plain else percent(value)

    for condition, by_name in by_condition(results).items():
        for place, number in enumerate(next(iter(by_name.values()))):
            ours = [
                text(number.name, by_name[each][place].ours, by_name[each][place].of)
                if each in by_name
                else "-"
                for each in results
            ]
            table.add_row(TITLES[condition], number.name, text(number.name, number.published, 10), *ours)
    return table
