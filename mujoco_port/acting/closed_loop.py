"""Closed loop: the agent's inputs come from the robot, and the 2D world is not asked.

What S2 knows, the robot has to find out: beta from where its hand is, touch from the skin on the two sides of
its hand, the objects' bearings from eyes in J1, or at the end of S1, that look along S1. An order takes
effect one control step after what it answers to was sensed: the cubic that leads to a place has to know how
fast it is to be left.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from arm2d import Instruction, Readings, Task
from arm2d import constants as c
from arm2d.geometry import turned
from arm2d.reference import LEFT, PAPERS, RIGHT, Side, controller, sense
from arm2d.tasks.hearing import bits_heard
from mujoco_port.acting.contacts import LEFT_SIDE, RIGHT_SIDE
from mujoco_port.acting.control import Body
from mujoco_port.acting.rollout import Angles, PhysicalRecord
from mujoco_port.reach.workspace import beta_of

SKIN_MEMORY = 10  # physics steps: 20 ms, in which a touch that chatters is still felt


class ClosedLoop:
    """An agent with a robot's body.

    Args:
        genotype: [G].
        instruction: What is heard.
        alpha: [deg], where S1 starts.
        readings: How the paper is understood.
        body: The robot.
        task: How the words are said, if not as in the paper.

    Attributes:
        heard: The instruction that is heard from the next step on.
        sensed: I1 to I18 of every control step so far.
    """

    def __init__(
        self,
        genotype: NDArray[np.float64],
        instruction: Instruction,
        alpha: float,
        readings: Readings,
        body: Body,
        task: Task | None = None,
    ) -> None:
        self._think = controller(genotype, readings)
        self.heard, self._readings, self._body = instruction, readings, body
        self._task = task or PAPERS
        self.sensed: list[list[float]] = []
        self._here: Angles = (alpha, c.BETA_MAX)  # where S2 is to be at this moment
        self._next: Angles = self._here

    def first(self) -> tuple[Angles, Angles]:
        """The start; nothing has been sensed yet."""
        return self._here, self._next

    def after(self, so_far: PhysicalRecord, seen: NDArray[np.float64]) -> Angles:
        """Sense, think, and turn from where the order before led."""
        alpha = self._here[0]
        beta = beta_of(self._body.robot.plane, self._body.hand)
        sides = felt(so_far.contact[-SKIN_MEMORY:])
        places = [(x, y) for x, y in seen.tolist()]
        words = bits_heard(self.heard, self._task, len(self.sensed))
        inputs = sense(alpha, beta, places, sides, words, self._readings)
        self.sensed.append(inputs)
        self._here, self._next = self._next, turned(*self._next, self._think(inputs))
        return self._next


def felt(contact: NDArray[np.uint8]) -> list[Side]:
    """On which side each object is felt, from the latest rows [N, 3] of the contacts."""
    bits = np.bitwise_or.reduce(contact, axis=0) if len(contact) else np.zeros(3, np.uint8)
    return [RIGHT if each & RIGHT_SIDE else LEFT if each & LEFT_SIDE else None for each in bits]
