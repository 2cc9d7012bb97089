"""TOML that anyone may have written, read within bounds."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from arm2d.files import read_file

# A config.toml has some 700 characters.
LONGEST_TEXT: Final = 32_768
DEEPEST: Final = 8
# A dotted key keeps the parser busy for a time that grows with the square of its parts.
MOST_POINTS: Final = 2_000


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


def _check_depth(values: Mapping[str, Any]) -> None:
    """Refuse values in values in values, which could not even be shown."""
    level: list[Any] = [values]
    for _ in range(DEEPEST):
        groups = [each.values() if isinstance(each, Mapping) else each for each in level]
        level = [value for group in groups for value in group if isinstance(value, (Mapping, list))]
    if level:
        raise ValueError(f"its values are nested deeper than {DEEPEST} levels")
