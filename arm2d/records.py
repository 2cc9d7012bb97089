"""Records with arrays: shown on one short line, with sizes in place of numbers; compared number by number."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, Final

import numpy as np

LONGEST_VALUE: Final = 48


def brief(self: Any) -> str:
    """A dataclass on one line, such as `Lineage(generations=[301], genotypes=[301, 84])`.

    In the body of a class, `__repr__ = brief` makes it the one that Python shows.
    """
    shown = (f"{each.name}={_value(getattr(self, each.name))}" for each in fields(self) if each.repr)
    return f"{type(self).__name__}({', '.join(shown)})"


def _value(value: object) -> str:
    """A field's value; an array by its shape."""
    if isinstance(value, np.ndarray) and value.ndim:
        return f"[{', '.join(map(str, value.shape))}]"
    text = repr(value)
    return text if len(text) <= LONGEST_VALUE else f"{text[: LONGEST_VALUE - 4]} ..."


def alike(self: Any, other: object) -> bool:
    """Whether two records are of one class and hold the same, arrays compared number by number, NaN as equal.

    In the body of a dataclass, `__eq__ = alike` takes the place of what Python writes, which fails on arrays.
    """
    if type(other) is not type(self):
        return NotImplemented
    return all(_same(getattr(self, each.name), getattr(other, each.name)) for each in fields(self))


def _same(value: Any, other: Any) -> bool:
    """Whether two fields hold the same: arrays, mappings of them, or anything else."""
    if isinstance(value, np.ndarray):
        return np.array_equal(value, other, equal_nan=value.dtype.kind == "f")
    if isinstance(value, Mapping):
        return value.keys() == other.keys() and all(_same(value[key], other[key]) for key in value)
    return bool(value == other)
