"""What is filmed: a trial on the robot, moment by moment, with what is said of it beside."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import ActionWord, TrialRecord
from arm2d.constants import DT
from arm2d.drawing import state_at
from models.robots import Robot
from mujoco_port.film.kinematic import roll_out
from mujoco_port.film.mind import Mind, mind_of, think

if TYPE_CHECKING:
    from mujoco_port.acting.rollout import PhysicalRecord
    from mujoco_port.acting.verdict import Verdict


@dataclass(frozen=True)
class Take:
    """F moments of a trial; axes J joints, 3 objects (blue, green, red).

    Attributes:
        record: The trial in the planar world.
        steps: [F], moments in control steps of that trial, rising; the last one is the robot's end.
        angles: [F, J] in [rad].
        objects: [F, 3, 2] in [m], places on the table where they stand upright; or [F, 3, 7], position in
            [m] and quaternion.
        touched: [F, 3], which objects glow.
        planar: [F, 2], alpha and beta in [deg] of the arm whose end the hand is.
        mind: What the agent senses and thinks.
        verdicts: Who judges and whether the instruction was carried out, one after the other.
    """

    record: TrialRecord
    steps: NDArray[np.float64]
    angles: NDArray[np.float64]
    objects: NDArray[np.float64]
    touched: NDArray[np.bool_]
    planar: NDArray[np.float64]
    mind: Mind
    verdicts: tuple[tuple[str, bool], ...]

    @property
    def moment_s(self) -> float:
        """[s] from one moment to the next."""
        return float(self.steps[1] - self.steps[0]) * DT if len(self.steps) > 1 else DT

    @property
    def pointing(self) -> NDArray[np.bool_]:
        """[F], whether INDICATE is heard."""
        ignores = self.record.instruction.action is ActionWord.IGNORE
        third = ActionWord.IGNORE if ignores else ActionWord.INDICATE
        last = self.mind.steps - 1
        words = [self.mind.heard(step, third).action for step in range(last + 1)]
        return np.array([words[min(int(step), last)] is ActionWord.INDICATE for step in self.steps])


def kinematic_take(
    record: TrialRecord, robot: Robot, frames_per_step: float, genotype: ArrayLike | None = None
) -> Take:
    """A trial as the robot follows it, objects as in the planar world.

    Args:
        record: The trial.
        robot: Who follows it.
        frames_per_step: Moments for each control step.
        genotype: [84], of the agent; without it its neurons are shown by what they brought about.

    Raises:
        OutOfReachError: If the robot cannot follow.
    """
    rollout = roll_out(record, robot, frames_per_step)
    states = [state_at(record, step) for step in rollout.steps]
    return Take(
        record=record,
        steps=rollout.steps,
        angles=rollout.angles,
        objects=rollout.objects,
        touched=np.array([state[3] for state in states]),
        planar=np.array([state[:2] for state in states]),
        mind=mind_of(record, genotype),
        verdicts=(("planar world", record.success),),
    )


def physical_take(
    planar: TrialRecord, record: PhysicalRecord, verdict: Verdict, genotype: ArrayLike | None = None
) -> Take:
    """A trial that the robot has carried out by itself, objects where they were pushed to.

    Args:
        planar: The same trial in the planar world.
        record: What the robot did.
        verdict: What became of it.
        genotype: [84], of the agent.
    """
    from mujoco_port.film.kinematic import FRAMES_PER_STEP

    rows_per_step = len(record.alpha) // record.steps
    rows = np.arange(0, len(record.alpha), round(rows_per_step / FRAMES_PER_STEP))
    steps = rows / rows_per_step
    beta = np.interp(steps, np.arange(len(record.orders)), record.orders[:, 1])
    return Take(
        record=planar,
        steps=steps,
        angles=record.angles[rows],
        objects=record.places[rows],
        touched=record.contact[rows] != 0,
        planar=np.stack([record.alpha[rows], beta], axis=-1),
        mind=_acting_mind(planar, record, genotype),
        verdicts=(("planar world", planar.success), ("robot", verdict.success)),
    )


def _acting_mind(planar: TrialRecord, record: PhysicalRecord, genotype: ArrayLike | None) -> Mind:
    """The agent's mind while the robot acts: in the planar world, or in closed loop in the robot itself."""
    from mujoco_port.acting.verdict import progress_of

    progress, goal = progress_of(record, planar.readings)
    ends = np.arange(record.steps + 1) * (len(progress) // record.steps)
    share = np.minimum(1.0, np.concatenate([[0.0], progress])[ends] / goal)
    mind = replace(mind_of(planar, genotype), share=share, score=None)
    if record.inputs is None or genotype is None:
        return mind
    rates, motors = think(record.inputs, genotype, planar.readings)
    return replace(mind, inputs=record.inputs, rates=rates, motors=motors)
