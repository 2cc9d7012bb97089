"""Records on one short line: what they are, with the sizes of their arrays in place of the numbers."""

from __future__ import annotations

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
