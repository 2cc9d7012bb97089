"""Files of measured runs, a row for each: what the rows of all studies have in common, written and read back.

A row names the run with every reading, so a run whose row is there need not be evolved again, on whatever
machine it was.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, Final, Protocol, TypeVar

from arm2d import Readings
from arm2d.readings import PLAIN
from evolution.agents.firsts import NEVER
from evolution.report.columns import PlainTable
from evolution.runs.storage import make_folder, write_atomically
from evolution.search.config import RunConfig

READINGS: Final = tuple(each.name for each in fields(Readings))


class Row(Protocol):
    """A measured run: which it was, and how its evolution went."""

    @property
    def config(self) -> RunConfig:
        """The run."""
        ...

    @property
    def plateau(self) -> float:
        """Median best fitness over the last sixth of its generations."""
        ...

    @property
    def first_solved(self) -> int:
        """First generation in which one genotype carried out all its trials; -1 if none."""
        ...

    @property
    def solved_late(self) -> float:
        """Share of the last third of generations in which one did."""
        ...


R = TypeVar("R", bound=Row)
Columns = Mapping[str, Callable[[R], Any]]

# How the evolution went, as columns.
COURSE: Final[Mapping[str, Callable[[Any], Any]]] = {
    "plateau": lambda run: f"{run.plateau:.6f}",
    "first generation that solved all trials": lambda run: (
        "never" if run.first_solved == NEVER else run.first_solved
    ),
    "share of late generations that did": lambda run: f"{run.solved_late:.4f}",
}


def course_of(told: Mapping[str, str]) -> dict[str, Any]:
    """The fields of a measured run that the columns `COURSE` tell; raises ValueError."""
    plateau, first, share = (told[name] for name in COURSE)
    return {
        "plateau": float(plateau),
        "first_solved": NEVER if first == "never" else int(first),
        "solved_late": float(share),
    }


def reading_columns() -> dict[str, Callable[[Any], str]]:
    """A column for every reading of a run."""
    return {name: lambda run, name=name: _text(run.config.readings.to_mapping()[name]) for name in READINGS}


def readings_of(told: Mapping[str, str]) -> Readings:
    """The readings that these columns tell; raises ValueError."""
    return PLAIN.with_values({name: _value(name, told[name]) for name in READINGS})


def write_table(columns: Columns[R], runs: Iterable[R], path: Path) -> None:
    """Write a file of rows, at once or not at all.

    Raises:
        OSError: If it cannot be written.
    """
    make_folder(path.parent)
    write_atomically(path, PlainTable(columns, runs).to_csv().encode())


def read_table(path: Path, columns: Columns[R], run_of: Callable[[Mapping[str, str]], R]) -> list[R]:
    """The runs of a file of rows; none if it is not there.

    Args:
        path: Of the file.
        columns: That it must have.
        run_of: A run from its row, by the names of the columns; raises ValueError if it tells none.

    Raises:
        ValueError: If it is no such file, or a row cannot be understood.
    """
    if not path.exists():
        return []
    try:
        lines = list(csv.reader(path.read_text(encoding="utf-8").splitlines()))
    except (OSError, ValueError, csv.Error):
        raise ValueError(f"{path} cannot be read; it must be a file of measured rows") from None
    if not lines or lines[0] != list(columns):
        raise ValueError(f"{path} is no file of measured rows of this version; move it away and repeat")
    runs = []
    for number, line in enumerate(lines[1:], 2):
        try:
            runs.append(run_of(dict(zip(columns, line, strict=True))))
        except ValueError as error:
            raise ValueError(f"{path}, line {number}, cannot be understood: {error}") from None
    if len({run.config for run in runs}) < len(runs):
        raise ValueError(f"{path} holds a run twice; leave one of both rows")
    return runs


def _text(value: Any) -> str:
    """A reading as text that gives it back."""
    return " ".join(map(repr, value)) if isinstance(value, list) else str(value)


def _value(name: str, text: str) -> Any:
    """A reading from its text."""
    default = getattr(Readings, name)
    if isinstance(default, tuple):
        return tuple(float(part) for part in text.split())
    return float(text) if isinstance(default, float) else text
