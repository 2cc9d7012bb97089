"""A robot's trial in which the words may change, judged anew from every change on.

Axes: N physics steps, J joints, 3 objects (blue, green, red).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import Instruction, Readings
from arm2d.records import brief
from mujoco_port.acting.closed_loop import ClosedLoop
from mujoco_port.acting.eyes import geometric_eyes
from mujoco_port.acting.lab import Lab
from mujoco_port.acting.rollout import MOST_STEPS, Carrying, Eyes, PhysicalRecord
from mujoco_port.acting.verdict import Verdict, judge, progress_of
from mujoco_port.live.planar import PlanarTrial

# [physics steps] What was touched when the words changed and was let go for so long counts from then on.
LET_GO: Final = 50


@dataclass(frozen=True)
class Start:
    """Where a trial begins.

    Attributes:
        alpha: [deg], of S1.
        discs: [3, 2] in [cm], centres of blue, green and red.
    """

    alpha: float
    discs: NDArray[np.float64]

    __repr__ = brief


@dataclass(frozen=True)
class Stretch:
    """One control step: N moments of the physics.

    Attributes:
        angles: [N, J] in [rad].
        head: [N, H] in [rad], of neck and eyes.
        places: [N, 3, 7], of the objects: centre in [m] and quaternion.
        touched: [N, 3], which objects are touched.
        planar: [N, 2] in [deg], alpha and beta.
    """

    angles: NDArray[np.float64]
    head: NDArray[np.float64]
    places: NDArray[np.float64]
    touched: NDArray[np.bool_]
    planar: NDArray[np.float64]

    __repr__ = brief


class LiveTrial:
    """A trial under way, on the robot and in the 2D world beside it.

    Args:
        lab: The robot at its table.
        genotype: [G], of the agent.
        readings: Its world.
        instruction: What is heard first.
        start: Where it begins.
        closed: Whether the agent lives in the robot; else it lives in the 2D world.
        eyes: What it sees in closed loop; without, it knows where the objects are.
    """

    def __init__(
        self,
        lab: Lab,
        genotype: NDArray[np.float64],
        readings: Readings,
        instruction: Instruction,
        start: Start,
        *,
        closed: bool = False,
        eyes: Eyes | None = None,
    ) -> None:
        self._readings, self.steps = readings, 0
        self.planar = PlanarTrial(genotype, instruction, start.alpha, start.discs, readings)
        self._acting = ClosedLoop(genotype, instruction, start.alpha, readings, lab.body) if closed else None
        self._carrying = Carrying(
            lab.body,
            lab.kinematics,
            self._acting or self.planar,
            eyes or geometric_eyes(lab.body),
            instruction,
            start.discs,
        )
        if closed:
            self.planar.first()
        self._excused = np.zeros(3, bool)
        self._verdict: Verdict | None = None

    def say(self, instruction: Instruction) -> None:
        """Let other words be heard; both judges begin anew."""
        touched = self._carrying.record.contact[-LET_GO:].any(axis=0)
        self._excused = touched & (np.arange(3) != int(instruction.object))
        self._carrying.ask(instruction)
        self.planar.say(instruction)
        if self._acting is not None:
            self._acting.heard = instruction
        self._verdict = None

    def step(self) -> Stretch:
        """Carry out one control step.

        Raises:
            OutOfReachError: If the robot cannot reach a place.
            UnstableError: If the simulation blows up.
        """
        self._carrying.step()
        if self._acting is not None:
            self.planar.after()
        self.steps += 1
        record = self._carrying.record
        rows = slice(-len(record.alpha) // record.steps, None)
        if self._verdict is None:
            verdict = judge(self._judged(record), self._readings)
            if verdict.certain or record.steps >= MOST_STEPS:
                self._verdict = verdict
        places = record.places[rows]
        beta = np.interp(np.linspace(0.0, 1.0, len(places)), [0.0, 1.0], record.orders[-2:, 1])
        return Stretch(
            record.angles[rows],
            record.head[rows],
            places,
            record.contact[rows] != 0,
            np.stack([record.alpha[rows], beta], axis=-1),
        )

    @property
    def inputs(self) -> NDArray[np.float64]:
        """[18], what the agent sensed at the beginning of the last step."""
        sensed = self.planar.sensed if self._acting is None else self._acting.sensed
        return np.array(sensed[max(self.steps - 1, 0)])

    @property
    def share(self) -> float:
        """How much of what is asked the robot does at this moment, from 0 to 1."""
        record = self._judged(self._carrying.record)
        if not len(record.alpha):
            return 0.0
        if self._verdict is not None and self._verdict.success:
            return 1.0
        progress, goal = progress_of(record, self._readings)
        return min(1.0, float(progress[-1]) / goal)

    @property
    def verdict(self) -> Verdict | None:
        """What has become of the instruction on the robot, once that is certain or time is over."""
        return self._verdict

    @property
    def ended(self) -> bool:
        """Whether both judges have decided."""
        return self._verdict is not None and (
            self.planar.judgement.success is not None or self._carrying.record.steps >= MOST_STEPS
        )

    def _judged(self, record: PhysicalRecord) -> PhysicalRecord:
        """The record without what is forgiven: what was touched when words changed, until it is let go."""
        if not self._excused.any():
            return record
        contact = record.contact.copy()
        for disc in np.flatnonzero(self._excused):
            contact[: held(contact[:, disc] != 0), disc] = 0
        return replace(record, contact=contact)


def held(touched: NDArray[np.bool_]) -> int:
    """How many of the first moments [N] go by until it has been let go for `LET_GO` moments on end."""
    free = 0
    for moment, touches in enumerate(touched):
        free = 0 if touches else free + 1
        if free == LET_GO:
            return moment + 1
    return len(touched)
