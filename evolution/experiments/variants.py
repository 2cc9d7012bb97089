"""The variants of an experiment, what is compared in it, and the names of their folders."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields, replace
from itertools import count, takewhile
from typing import Any, Final

from arm2d import Condition, Readings
from arm2d.readings import PLAIN
from evolution.search.config import RunConfig
from evolution.search.settings import Settings

DEFAULT_NAME: Final = "default"
PLAIN_NAME: Final = "plain"
LONGEST_NAME: Final = 200
LEAST_WIDTH: Final = 8  # of a name that is cut
# A condition's name would make a variant's folder look like an experiment of one variant.
RESERVED: Final = {"logs", "results", "studies", *(str(each) for each in Condition)}
PATTERN: Final = re.compile(r"[A-Za-z0-9][A-Za-z0-9._+-]*")


@dataclass(frozen=True)
class Variant:
    """What runs have in common that differ in condition and seed only.

    Attributes:
        readings: How the paper is understood.
        settings: The genetic algorithm.
    """

    readings: Readings
    settings: Settings

    @classmethod
    def of(cls, config: RunConfig) -> Variant:
        """That of a run."""
        return cls(config.readings, config.settings)

    def name(self, common: Settings | None = None) -> str:
        """As `variant_name`."""
        return variant_name(self.readings, self.settings, common)


def variant_name(readings: Readings, settings: Settings | None = None, common: Settings | None = None) -> str:
    """What is special about readings and settings, fit for a folder, such as `object-radius-8`.

    Args:
        readings: Named wherever they differ from the default readings; or from the plain ones, after the word
            `plain`, if they differ in fewer from those.
        settings: Named wherever they differ from `common`; by default not at all.
        common: By default the paper's settings.

    Returns:
        Field names with dashes and their values, joined by `+`; `default` if nothing is special.
    """
    parts = min(value_names(readings, Readings()), [PLAIN_NAME, *value_names(readings, PLAIN)], key=len)
    if settings is not None:
        parts += value_names(settings, common or Settings())
    return "+".join(parts) or DEFAULT_NAME


def value_name(name: str, value: Any) -> str:
    """A field and its value, fit for a folder: `sector-centres-45-90-135`. Equal names mean equal values."""
    values = value if isinstance(value, (list, tuple)) else [value]
    return "-".join([name, *map(_plain, values)]).replace("_", "-")


def check_name(name: Any) -> str:
    """A name that a user gave to a variant.

    Raises:
        ValueError: If it cannot be a folder's name, or is needed for another one.
    """
    if not isinstance(name, str) or not PATTERN.fullmatch(name) or len(name) > LONGEST_NAME:
        raise ValueError(
            f"variant name {name!r} cannot be a folder's; give letters, digits, - _ + and ., "
            f"at most {LONGEST_NAME}, the first a letter or digit"
        )
    if name in RESERVED:
        raise ValueError(f"variant name {name!r} is taken; {', '.join(sorted(RESERVED))} are")
    return name


def common_settings(variants: Iterable[Variant]) -> Settings:
    """The paper's settings, but for the fields in which all the given ones agree: these are theirs."""
    found = [each.settings for each in variants]
    shared = {
        field.name: getattr(found[0], field.name)
        for field in fields(Settings)
        if len({getattr(settings, field.name) for settings in found}) == 1
    }
    return replace(Settings(), **shared) if shared else Settings()


def told_apart(names: Sequence[str], width: int) -> dict[str, str]:
    """Every name in at most so many characters; no two different ones look the same.

    The middle is cut; where that makes two the same, the beginning that they share; else they are numbered.

    Args:
        names: To be shown together.
        width: At most so many characters, but not fewer than `LEAST_WIDTH`.
    """
    width = max(width, LEAST_WIDTH)
    tail = width // 2
    short = {
        name: name if len(name) <= width else f"{name[: width - tail - 1]}…{name[-tail:]}" for name in names
    }
    for alike in _same(short):
        shared = takewhile(lambda letters: len(set(letters)) == 1, zip(*alike, strict=False))
        start = max(len(list(shared)) - 1, 0)
        short |= {name: f"…{name[start:]}"[:width] for name in alike}
    numbers = count(1)
    for alike in _same(short):
        for name in alike:
            mark = f"…{next(numbers)}"
            short[name] = short[name][: width - len(mark)] + mark
    return short


def _same(short: dict[str, str]) -> list[list[str]]:
    """The names that have become the same, group by group."""
    times = Counter(short.values())
    return [[name for name in short if short[name] == each] for each, n in times.items() if n > 1]


def value_names(record: Any, base: Any) -> list[str]:
    """Name and value, fit for a folder, of every field in which a record differs from another."""
    values = [(each.name, getattr(record, each.name)) for each in fields(base)]
    return [value_name(name, value) for name, value in values if value != getattr(base, name)]


def _plain(value: Any) -> str:
    """A value in letters and digits; whole numbers without a point."""
    if isinstance(value, float):
        return str(int(value)) if value.is_integer() else repr(value)
    return str(value)
