"""A table for programs: what each column is called beside what stands under it."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

T = TypeVar("T")


@dataclass(frozen=True)
class PlainTable(Generic[T]):
    """Things of one kind, a row for each.

    Attributes:
        columns: What stands in a column, from what the row is about, by the column's name.
        things: What the rows are about.
    """

    columns: Mapping[str, Callable[[T], Any]]
    things: Iterable[T]

    def rows(self) -> list[dict[str, Any]]:
        """Every row by the names of the columns."""
        return [{name: value(thing) for name, value in self.columns.items()} for thing in self.things]

    def to_csv(self) -> str:
        """Comma-separated lines, the names of the columns first, even if there is no row."""
        text = io.StringIO()
        writer = csv.DictWriter(text, self.columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(self.rows())
        return text.getvalue()
