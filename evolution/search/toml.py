"""TOML that anyone may have written: read within bounds, held against known keys and kinds."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Final, TypeVar

from arm2d.files import read_file

T = TypeVar("T")

# A config.toml has some 700 characters.
LONGEST_TEXT: Final = 32_768
DEEPEST: Final = 8
# A dotted key keeps the parser busy for a time that grows with the square of its parts.
MOST_POINTS: Final = 2_000
KINDS: Final = {bool: "true or false", int: "a whole number", str: "text in quotes"}


def read_toml_file(path: Path) -> dict[str, Any]:
    """The values of a file, of which no more is read than is allowed; raises as `read_toml`."""
    return read_toml(read_file(path, 4 * LONGEST_TEXT).decode())


def read_toml(text: str, longest: int = LONGEST_TEXT) -> dict[str, Any]:
    """The values of a TOML text.

    Raises:
        ValueError: If it is none, is longer than `longest`, is nested deeper than `DEEPEST`, or has a line of
            more than `MOST_POINTS` points.
    """
    if len(text) > longest:
        raise ValueError(f"it is longer than {longest:,} characters")
    if any(line.count(".") > MOST_POINTS for line in text.splitlines()):
        raise ValueError(f"a line has more than {MOST_POINTS:,} points; break it up")
    try:
        values = tomllib.loads(text)
    except RecursionError:
        raise ValueError(f"its values are nested deeper than {DEEPEST} levels") from None
    except ValueError as error:
        raise ValueError(f"this is not TOML: {error}") from None
    _check_depth(values)
    return values


def check_keys(kind: str, values: Iterable[str], known: Iterable[str], where: str = "") -> None:
    """Refuse a key that is none of the known ones; one that is near is suggested.

    Raises:
        ValueError: With all the known ones.
    """
    known = list(known)
    for name in values:
        if name not in known:
            near = get_close_matches(name, known, n=1)
            hint = f"did you mean {near[0]}? there" if near else "there"
            raise ValueError(f"unknown {kind} {name!r}{where}; {hint} are {', '.join(known)}")


def one_of_kind(name: str, value: Any, kind: type[T]) -> T:
    """A value, refused if it is not true or false, a whole number, or text, as it should be."""
    if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
        raise ValueError(f"{name} = {value!r} must be {KINDS[kind]}")
    return value


def table_of(name: str, value: Any) -> Mapping[str, Any]:
    """A value, refused if it is no table."""
    if not isinstance(value, Mapping):
        raise ValueError(f"{name} = {value!r} must be a table, such as [{name}]")
    return value


def _check_depth(values: Mapping[str, Any]) -> None:
    """Refuse values in values in values, which could not even be shown."""
    level: list[Any] = [values]
    for _ in range(DEEPEST):
        groups = [value.values() if isinstance(value, Mapping) else value for value in level]
        level = [value for group in groups for value in group if isinstance(value, (Mapping, list))]
    if level:
        raise ValueError(f"its values are nested deeper than {DEEPEST} levels")
