"""Whose mind moves the robot."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm2d import Instruction, Readings
from arm2d.records import brief


@dataclass(frozen=True)
class Actor:
    """Whose mind moves the robot.

    Attributes:
        name: For people.
        genotype: [G].
        readings: The world it evolved in.
        instructions: The nine that it hears.
    """

    name: str
    genotype: NDArray[np.float64]
    readings: Readings
    instructions: tuple[Instruction, ...]

    __repr__ = brief
