"""Open loop: the agent lives in the 2D world, and the robot does what S2 does there."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from arm2d import Instruction, Readings, Task
from arm2d import constants as c
from arm2d.geometry import Point, turned
from arm2d.reference import PAPERS, Side, controller, sense, touch
from arm2d.tasks.hearing import bits_heard
from mujoco_port.acting.rollout import Angles, PhysicalRecord


class PlanarAgent:
    """An agent that lives in the 2D world, one step at a time.

    Args:
        genotype: [G].
        alpha: [deg], where S1 starts.
        discs: [3, 2] in [cm], centres of blue, green and red.
        readings: The world.
        delay: Steps from what is sensed to the turn that answers to it, beyond the step of the 2D world.
        task: How the words are said, if not as in the paper.

    Attributes:
        alpha: Of S1, [deg].
        beta: Of S2, [deg].
        places: Centres of the discs, [cm].
        sides: On which side of S2 each is touched.
        turned: By how much S1 has turned in the last step, [deg].
    """

    def __init__(
        self,
        genotype: NDArray[np.float64],
        alpha: float,
        discs: NDArray[np.float64],
        readings: Readings,
        delay: int = 0,
        task: Task | None = None,
    ) -> None:
        self._think, self._readings = controller(genotype, readings), readings
        self.alpha, self.beta, self.turned = alpha, c.BETA_MAX, 0.0
        self.places: list[Point] = [(x, y) for x, y in discs.tolist()]
        self.sides: list[Side] = [None, None, None]
        self._turns = deque([(0.0, 0.0)] * delay)
        self._task, self._steps = task or PAPERS, 0

    def step(self, heard: Instruction) -> list[float]:
        """Sense, think and turn, while two words are heard; I1 to I18 as they were sensed."""
        alpha, beta, readings = self.alpha, self.beta, self._readings
        words = bits_heard(heard, self._task, self._steps)
        inputs = sense(alpha, beta, self.places, self.sides, words, readings)
        self._steps += 1
        self._turns.append(self._think(inputs))
        self.alpha, self.beta = turned(alpha, beta, self._turns.popleft())
        self.turned = self.alpha - alpha
        self.places, self.sides = touch(
            alpha, beta, self.alpha, self.beta, self.places, self.sides, readings.object_radius
        )
        return inputs


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
        genotype: [G].
        instruction: What is heard.
        alpha: [deg], where S1 starts.
        discs: [3, 2] in [cm], centres of blue, green and red.
        readings: The world.
        delay: Steps from what is sensed to the turn that answers to it, beyond the step of the 2D world.
        task: How the words are said, if not as in the paper.
    """
    agent = PlanarAgent(genotype, alpha, discs, readings, delay, task)
    while True:
        yield agent.alpha, agent.beta
        agent.step(instruction)


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
