"""What a viewer may ask for: one JSON object, `{"do": "say", "words": "touch green"}`.

An order names what it changes, and the rest stays as it is in the session. A page that sent the rest as it
last heard of it would take back what was ordered a moment ago.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Any, Final

from arm2d import ActionWord, Instruction, ObjectWord
from arm2d.trials import START_AREAS

LONGEST: Final = 1000  # characters
SPEEDS: Final = (0.25, 0.5, 1.0, 2.0, 4.0)
LARGEST_SEED: Final = 2**32 - 1


@dataclass(frozen=True)
class Say:
    """Let other words be heard; None leaves a word as it is."""

    action: ActionWord | None
    object: ObjectWord | None

    @classmethod
    def both(cls, instruction: Instruction) -> Say:
        """Both words of an instruction."""
        return cls(instruction.action, instruction.object)


@dataclass(frozen=True)
class Place:
    """Put an object somewhere, x and y in [cm] of the 2D world."""

    object: ObjectWord
    x: float
    y: float


@dataclass(frozen=True)
class Reset:
    """Stand at a fresh start, drawn in an area with a seed; None leaves either as it is."""

    area: str | None = None
    seed: int | None = None


@dataclass(frozen=True)
class Loop:
    """Let the agent live in the robot, or in the 2D world."""

    closed: bool


@dataclass(frozen=True)
class Run:
    """Begin, go on, or stand still."""

    on: bool


@dataclass(frozen=True)
class Again:
    """Back to the same start."""


@dataclass(frozen=True)
class Speed:
    """Let time go faster or slower."""

    factor: float


Order = Say | Place | Reset | Loop | Run | Again | Speed


def read_order(text: str | bytes) -> Order:
    """The order that a viewer sends.

    Raises:
        ValueError: If it is none, in a sentence for the viewer.
    """
    if not isinstance(text, str) or len(text) > LONGEST:
        raise ValueError(f"an order is text of at most {LONGEST} characters")
    try:
        order = json.loads(text)
    except (ValueError, RecursionError):
        raise ValueError("an order is a JSON object") from None
    if not isinstance(order, dict):
        raise ValueError("an order is a JSON object")
    kind = order.get("do")
    if not isinstance(kind, str) or kind not in KINDS:
        raise ValueError(f"an order does one of: {', '.join(KINDS)}")
    return KINDS[kind](order)


def _say(order: Mapping[str, Any]) -> Say:
    words = order.get("words")
    if not isinstance(words, str):
        raise ValueError('words are text, such as "touch green"')
    one = words.strip().upper()
    if one in ActionWord.__members__:
        return Say(ActionWord[one], None)
    if one in ObjectWord.__members__:
        return Say(None, ObjectWord[one])
    return Say.both(Instruction.parse(words))


def _place(order: Mapping[str, Any]) -> Place:
    name = order.get("object")
    if not isinstance(name, str) or name.upper() not in ObjectWord.__members__:
        raise ValueError("an object is blue, green or red")
    return Place(ObjectWord[name.upper()], _number(order, "x"), _number(order, "y"))


def _reset(order: Mapping[str, Any]) -> Reset:
    area, seed = order.get("area"), order.get("seed")
    if area is not None and area not in START_AREAS:
        raise ValueError("an area is right or left")
    if seed is not None and not _is_seed(seed):
        raise ValueError(f"a seed is a whole number from 0 to {LARGEST_SEED}")
    return Reset(area, seed)


def _is_seed(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= LARGEST_SEED


def _speed(order: Mapping[str, Any]) -> Speed:
    factor = _number(order, "factor")
    if factor not in SPEEDS:
        raise ValueError(f"a speed is one of {', '.join(f'{each:g}' for each in SPEEDS)}")
    return Speed(factor)


def _number(order: Mapping[str, Any], name: str) -> float:
    """A finite number."""
    value = order.get(name)
    if isinstance(value, bool) or not isinstance(value, int | float) or not _fits(value):
        raise ValueError(f"{name} is a number")
    return float(value)


def _fits(value: float) -> bool:
    """Whether it is finite, and no whole number beyond all floating-point numbers."""
    try:
        return isfinite(value)
    except OverflowError:
        return False


def _yes(order: Mapping[str, Any], name: str) -> bool:
    value = order.get(name)
    if not isinstance(value, bool):
        raise ValueError(f"{name} is true or false")
    return value


KINDS: Final[Mapping[str, Callable[[Mapping[str, Any]], Order]]] = {
    "say": _say,
    "place": _place,
    "reset": _reset,
    "loop": lambda order: Loop(_yes(order, "closed")),
    "run": lambda order: Run(_yes(order, "on")),
    "again": lambda order: Again(),
    "speed": _speed,
}
