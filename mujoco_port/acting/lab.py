"""Trials on an acting robot: the public face of the physics.

record, verdict = mujoco_port.Lab("icub", readings).open_loop(genotype, trial, readings)
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import ActionWord, Instruction, ObjectWord, Readings, TrialRecord, Trials
from arm2d.constants import DT
from models.robots import Robot, get_robot
from mujoco_port.acting.closed_loop import ClosedLoop
from mujoco_port.acting.control import Body
from mujoco_port.acting.eyes import geometric_eyes
from mujoco_port.acting.open_loop import OpenLoop, planar_angles
from mujoco_port.acting.rollout import MOST_STEPS, Eyes, PhysicalRecord, Pilot, carry_out
from mujoco_port.acting.verdict import Verdict, judge
from mujoco_port.reach.kinematics import ArmKinematics
from mujoco_port.reach.workspace import for_world

DEFAULT: Final = Readings()


class Lab:
    """A robot at its table, ready for one trial after the other.

    Args:
        robot: Its record, or its name.
        readings: A world, for which the table is laid (`for_world`). Trials of worlds with discs of another
            size, or in sectors of another width, need a lab of their own.

    Attributes:
        body: The robot in MuJoCo.
        kinematics: Its inverse kinematics.

    Raises:
        NoPhysicsError: If the robot's record says too little for it to act.
    """

    def __init__(self, robot: Robot | str = "icub", readings: Readings = DEFAULT) -> None:
        chosen = for_world(get_robot(robot) if isinstance(robot, str) else robot, readings)
        self.body = Body(chosen)
        self.kinematics = ArmKinematics(chosen)

    def check_world(self, readings: Readings) -> None:
        """Refuse a world for which this table is not laid.

        Raises:
            ValueError: If its discs have another size, or begin elsewhere.
        """
        plane = self.body.robot.plane
        if (wanted := for_world(self.body.robot, readings).plane) != plane:
            laid = (plane.object_radius - plane.hand_edge) / plane.scale
            raise ValueError(
                f"this table is laid for discs of {laid:.3g} cm that begin {plane.rim:.1f} cm from J1, those "
                f"of this trial have {readings.object_radius:g} cm and begin at {wanted.rim:.1f}; make a lab "
                "for its world: Lab(robot, readings)"
            )

    def open_loop(
        self, genotype: NDArray[np.float64], trial: Trials, readings: Readings, delay: int = 0
    ) -> tuple[PhysicalRecord, Verdict]:
        """Let the agent live in the 2D world, and the robot do what S2 does there.

        Args:
            genotype: [G].
            trial: A batch of one.
            readings: The world.
            delay: Steps by which the agent is answered late there; 1 as late as in closed loop.

        Raises:
            ValueError, OutOfReachError: As `carry_out`.
        """
        instruction, discs = instruction_of(trial), trial.discs[0]
        alpha = float(trial.alpha[0])
        angles = planar_angles(genotype, instruction, alpha, discs, readings, delay, trial.task)
        return self.carry_out(OpenLoop(angles), instruction, discs, readings)

    def closed_loop(
        self, genotype: NDArray[np.float64], trial: Trials, readings: Readings, eyes: Eyes | None = None
    ) -> tuple[PhysicalRecord, Verdict]:
        """Let the agent live in the robot.

        Args:
            genotype: [G].
            trial: A batch of one.
            readings: How the paper is understood.
            eyes: What it sees; without, it knows where the objects are.

        Raises:
            ValueError, OutOfReachError: As `carry_out`.
        """
        instruction, alpha = instruction_of(trial), float(trial.alpha[0])
        pilot = ClosedLoop(genotype, instruction, alpha, readings, self.body, trial.task)
        record, verdict = self.carry_out(pilot, instruction, trial.discs[0], readings, eyes)
        return replace(record, inputs=np.array(pilot.sensed)), verdict

    def follow(self, record: TrialRecord) -> tuple[PhysicalRecord, Verdict]:
        """Let the robot do what S2 does in a recorded trial, to its end, such as one of `mujoco_port.drive`.

        Raises:
            ValueError: If it is longer than a trial on the robot can be, or as `carry_out`.
            OutOfReachError: If the robot cannot reach a place.
        """
        if record.steps > MOST_STEPS:
            raise ValueError(
                f"this trial has {record.steps} steps of {DT:g} s; on an acting robot it can have at most "
                f"{MOST_STEPS}"
            )
        orders = OpenLoop(zip(record.alpha.tolist(), record.beta.tolist(), strict=True))
        return self.carry_out(orders, record.instruction, record.discs[0], record.readings, to_the_end=True)

    def carry_out(
        self,
        pilot: Pilot,
        instruction: Instruction,
        discs: NDArray[np.float64],
        readings: Readings,
        eyes: Eyes | None = None,
        *,
        to_the_end: bool = False,
    ) -> tuple[PhysicalRecord, Verdict]:
        """Carry out a trial under anybody's orders, until its verdict is certain or the orders end.

        Raises:
            ValueError: If the table is not laid for this world.
            OutOfReachError: If the robot cannot reach a place.
        """
        self.check_world(readings)
        record = carry_out(
            self.body,
            self.kinematics,
            pilot,
            geometric_eyes(self.body) if eyes is None else eyes,
            instruction,
            discs,
            lambda so_far: not to_the_end and judge(so_far, readings).certain,
        )
        return record, judge(record, readings)


def instruction_of(trial: Trials) -> Instruction:
    """What is asked in a batch of one trial.

    Raises:
        ValueError: If it is not one trial.
    """
    if len(trial) != 1:
        raise ValueError(f"these are {len(trial)} trials; the robot carries out one at a time: trials[0]")
    return Instruction(ActionWord(int(trial.actions[0])), ObjectWord(int(trial.objects[0])))
