"""The same trial in the 2D world, step by step beside the robot's, with words that may change."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from arm2d import ActionWord, Instruction, Readings
from arm2d import constants as c
from arm2d.geometry import offset_of
from arm2d.reference import goal, is_good, score, sees
from mujoco_port.acting.open_loop import PlanarAgent
from mujoco_port.acting.rollout import Angles, PhysicalRecord


class PlanarTrial:
    """An agent in the 2D world; in open loop the robot's pilot.

    Args:
        genotype: [G].
        instruction: What is heard and judged.
        alpha: [deg], where S1 starts.
        discs: [3, 2] in [cm].
        readings: The world.

    Attributes:
        sensed: I1 to I18 of every step so far.
    """

    def __init__(
        self,
        genotype: NDArray[np.float64],
        instruction: Instruction,
        alpha: float,
        discs: NDArray[np.float64],
        readings: Readings,
    ) -> None:
        self._agent, self._readings = PlanarAgent(genotype, alpha, discs, readings), readings
        self.sensed: list[list[float]] = []
        self.judgement = Judgement(instruction, self._agent, readings)

    def say(self, instruction: Instruction) -> None:
        """Let other words be heard from the next step on, and judge them from here."""
        self.judgement = Judgement(instruction, self._agent, self._readings)

    def first(self) -> tuple[Angles, Angles]:
        """The start and the first step."""
        return self._here(), self.after()

    def after(self, so_far: PhysicalRecord | None = None, seen: NDArray[np.float64] | None = None) -> Angles:
        """One step further, whatever has become of the robot."""
        del so_far, seen
        self.sensed.append(self._agent.step(self.judgement.instruction))
        self.judgement.follow()
        return self._here()

    def _here(self) -> Angles:
        return self._agent.alpha, self._agent.beta


class Judgement:
    """How well an instruction is carried out in the 2D world, by the rules of `arm2d.reference`.

    What the arm touches at the beginning, when the words change in mid-trial, is held against it only once
    it has let go of it, as on the page of `evolution.player`.

    Args:
        instruction: What is judged.
        agent: Who carries it out.
        readings: The world.

    Attributes:
        success: Whether it was carried out, once that is certain; until then None.
    """

    def __init__(self, instruction: Instruction, agent: PlanarAgent, readings: Readings) -> None:
        self.instruction = instruction
        self.success: bool | None = None
        self._agent, self._readings = agent, readings
        self._excused = [side is not None for side in agent.sides]
        self._first = offset_of(agent.alpha, agent.places[instruction.object])
        self._steps, self._run, self._best, self._stretch = 0, 0.0, 0.0, 0.0

    def follow(self) -> None:
        """Judge the step that the agent has just made."""
        if self.success is not None:
            return
        agent, readings = self._agent, self._readings
        action, target = self.instruction.action, self.instruction.object
        offset = offset_of(agent.alpha, agent.places[target])
        seen = sees(agent.alpha, agent.places[target], readings)
        if seen:
            self._stretch = max(self._stretch, 1.0 - agent.beta / c.BETA_MAX)
        pairs = zip(self._excused, agent.sides, strict=True)
        self._excused = [excused and side is not None for excused, side in pairs]
        collided = any(
            side is not None and disc != target and not self._excused[disc]
            for disc, side in enumerate(agent.sides)
        )
        self._count(is_good(action, offset, seen, agent.sides[target], agent.turned, readings))
        self._steps += 1
        enough = self._best >= goal(action, readings) - c.THRESHOLD_TOLERANCE
        if enough or collided or self._steps >= c.MAX_STEPS:
            self.success = score(
                action,
                self._first,
                offset,
                seen,
                collided,
                self._best,
                agent.beta,
                self._stretch,
                self._steps,
                readings,
            ).success

    def _count(self, good: bool) -> None:
        """Go on with a run of good steps, or end it."""
        if good:
            self._run += self._agent.turned if self.instruction.action is ActionWord.MOVE else 1.0
        elif self._readings.run_counting == "uninterrupted":
            self._run = 0.0
        self._best = max(self._best, abs(self._run))
