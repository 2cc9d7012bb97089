"""What is asked of the keys and values of a TOML file, and what is said when they are others."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import Any, Final, TypeVar

T = TypeVar("T")
KINDS: Final = {bool: "true or false", int: "a whole number", str: "text in quotes"}


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
