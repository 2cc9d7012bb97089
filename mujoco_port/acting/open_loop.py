"""Open loop: the agent lives in the 2D world, and the robot does what S2 does there."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from itertools import count

import numpy as np
from numpy.typing import NDArray

from arm2d import Instruction, Readings, Task
from arm2d import constants as c
from arm2d.reference import PAPERS, Side, controller, sense, touch
from arm2d.tasks.hearing import bits_heard
from mujoco_port.acting.rollout import Angles, PhysicalRecord


def planar_angles(
    genotype: NDArray[np.float64],
    instruction: Instruction,
    alpha: float,
    discs: NDArray[np.float64],
    readings: Readings,
    delay: int = 0,
    task: Task | None = None,
) -> Iterator[Angles]:
    """Alpha and beta in [deg] at the start of a trial of the 2D world and after every step, without an end.

    A trial there ends as soon as its instruction is carried out. On the robot, it is carried out a moment or
    a few degrees later: until then agent and world go on as they did.

    Args:
        genotype: [84].
        instruction: What is heard.
        alpha: [deg], where S1 starts.
        discs: [3, 2] in [cm], centres of blue, green and red.
        readings: The world.
        delay: Steps from what is sensed to the turn that answers to it, beyond the step of the 2D world.
        task: How the words are said, if not as in the paper.
    """
    think = controller(genotype, readings)
    places = [(x, y) for x, y in discs.tolist()]
    sides: list[Side] = [None, None, None]
    beta = c.BETA_MAX
    turns = deque([(0.0, 0.0)] * delay)
    for step in count():
        yield alpha, beta
        words = bits_heard(instruction, task or PAPERS, step)
        turns.append(think(sense(alpha, beta, places, sides, words, readings)))
        turn1, turn2 = turns.popleft()
        new_alpha = min(c.ALPHA_MAX, max(c.ALPHA_MIN, alpha + turn1))
        new_beta = min(c.BETA_MAX, max(c.BETA_MIN, beta + turn2))
        places, sides = touch(alpha, beta, new_alpha, new_beta, places, sides, readings.object_radius)
        alpha, beta = new_alpha, new_beta


class OpenLoop:
    """Orders that follow the 2D world, which knows nothing of the robot.

    Args:
        angles: As `planar_angles` gives them; two at least.
    """

    def __init__(self, angles: Iterator[Angles]) -> None:
        self._angles = angles

    def first(self) -> tuple[Angles, Angles]:
        """The start and the first step."""
        return next(self._angles), next(self._angles)

    def after(self, so_far: PhysicalRecord, seen: NDArray[np.float64]) -> Angles | None:
        """The step after, whatever has become of the robot so far, and whatever it sees."""
        del so_far, seen
        return next(self._angles, None)
