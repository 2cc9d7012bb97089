"""What is filmed: a trial on the robot, moment by moment, and what the agent senses and thinks in it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import ActionWord, ObjectWord, Readings, Task, TrialRecord
from arm2d import constants as c
from arm2d.drawing import state_at
from arm2d.network.controller import decode
from arm2d.records import brief
from arm2d.tasks.hearing import words_of
from arm2d.worlds.progress import progress_of
from models.robots import Robot
from mujoco_port.film.kinematic import FRAMES_PER_STEP, roll_out

if TYPE_CHECKING:
    from mujoco_port.acting.rollout import PhysicalRecord
    from mujoco_port.acting.verdict import Verdict

Neurons = Callable[[NDArray[np.float64]], tuple[NDArray[np.float64], NDArray[np.float64]]]


@dataclass(frozen=True)
class Mind:
    """An agent's K steps, from what comes in to what goes out.

    Attributes:
        inputs: [K, 18], I1 to I18.
        rates: [K, N], of the inter-neurons, from 0 to 1.
        motors: [K, 4], of the motor neurons, from 0 to 1.
        share: [K + 1], how much of what is asked is done.
        score: [K + 1], F1 + F2 + F3 so far; None where none is defined.
    """

    inputs: NDArray[np.float64]
    rates: NDArray[np.float64]
    motors: NDArray[np.float64]
    share: NDArray[np.float64]
    score: NDArray[np.float64] | None

    __repr__ = brief

    @property
    def steps(self) -> int:
        """K."""
        return len(self.inputs)

    def heard(self, step: int, task: Task) -> tuple[ActionWord | None, ObjectWord | None]:
        """The words heard in a step; None for one that is not said."""
        return words_of(self.inputs[step, 12:], task)


def task_heard(record: TrialRecord) -> Task:
    """The task whose words a record's agent hears."""
    third = "ignore" if record.instruction.action is ActionWord.IGNORE else "indicate"
    return record.task or Task(third=third)


def mind_of(record: TrialRecord, genotype: ArrayLike | None) -> Mind:
    """The mind behind a recorded trial.

    Without a genotype, neurons are shown by their states, and motors by the turns they brought about.
    """
    progress = progress_of(record)
    if genotype is not None:
        rates, motors = think(record.inputs, genotype, record.readings)
    else:
        rates, motors = _squash(record.states), _motors_of_turns(record.turns)
    return Mind(record.inputs, rates, motors, progress.share, progress.score)


def think(
    inputs: NDArray[np.float64], genotype: ArrayLike, readings: Readings
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What inter-neurons [K, N] and motor neurons [K, 4] do while these inputs [K, 18] come in (eq. 1 to 3).

    To be looked at: what decides a trial is the kernel's arithmetic.
    """
    neurons = thinking(genotype, readings)
    rates, motors = zip(*map(neurons, inputs), strict=True)
    return np.array(rates), np.array(motors)


def thinking(genotype: ArrayLike, readings: Readings) -> Neurons:
    """The network, step by step: from 18 inputs to its inter-neurons [N] and motor neurons [4]."""
    net = decode(genotype, readings)
    y = np.zeros(net.decay_constants.shape[1])

    def step(inputs: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        nonlocal y
        s = _squash(net.gain[0] * inputs + net.input_bias[0])  # eq. 1
        drive = s @ net.sensory_weights[0] + _squash(y + net.inter_biases[0]) @ net.recurrent_weights[0]
        y = y + c.DT / net.decay_constants[0] * (drive - y)  # eq. 2
        rates = _squash(y + net.inter_biases[0])
        return rates, _squash(rates @ net.motor_weights[0] + net.motor_bias[0])  # eq. 3

    return step


def _squash(values: NDArray[np.float64]) -> NDArray[np.float64]:
    return 1.0 / (1.0 + np.exp(-values))


def _motors_of_turns(turns: NDArray[np.float64]) -> NDArray[np.float64]:
    """What four motor neurons must have done, [K, 4], for turns [K, 2]: go, and which way, for S1 and S2."""
    return np.stack([(turns != 0.0) * 1.0, 0.5 - 0.5 * np.sign(turns)], axis=-1).reshape(-1, 4)


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
        head: [F, H] in [rad], how neck and eyes moved; None where nothing has moved them.
    """

    record: TrialRecord
    steps: NDArray[np.float64]
    angles: NDArray[np.float64]
    objects: NDArray[np.float64]
    touched: NDArray[np.bool_]
    planar: NDArray[np.float64]
    mind: Mind
    verdicts: tuple[tuple[str, bool], ...]
    head: NDArray[np.float64] | None = None

    __repr__ = brief

    @property
    def moment_s(self) -> float:
        """[s] from one moment to the next."""
        return float(self.steps[1] - self.steps[0]) * c.DT if len(self.steps) > 1 else c.DT

    @property
    def pointing(self) -> NDArray[np.bool_]:
        """[F], whether INDICATE is heard."""
        last, task = self.mind.steps - 1, task_heard(self.record)
        words = [self.mind.heard(step, task)[0] for step in range(last + 1)]
        return np.array([words[min(int(step), last)] is ActionWord.INDICATE for step in self.steps])


def kinematic_take(
    record: TrialRecord, robot: Robot, frames_per_step: float, genotype: ArrayLike | None = None
) -> Take:
    """A trial as the robot follows it, objects as in the planar world.

    Args:
        record: The trial.
        robot: Who follows it.
        frames_per_step: Moments for each control step.
        genotype: [G], of the agent; without it its neurons are shown by what they brought about.

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
        genotype: [G], of the agent.
    """
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
        head=record.head[rows],
    )


def _acting_mind(planar: TrialRecord, record: PhysicalRecord, genotype: ArrayLike | None) -> Mind:
    """The agent's mind while the robot acts: in the planar world, or in closed loop in the robot itself."""
    from mujoco_port.acting.verdict import progress_of as acting_progress

    progress, goal = acting_progress(record, planar.readings)
    ends = np.arange(record.steps + 1) * (len(progress) // record.steps)
    share = np.minimum(1.0, np.concatenate([[0.0], progress])[ends] / goal)
    mind = replace(mind_of(planar, genotype), share=share, score=None)
    if record.inputs is None or genotype is None:
        return mind
    rates, motors = think(record.inputs, genotype, planar.readings)
    return replace(mind, inputs=record.inputs, rates=rates, motors=motors)
