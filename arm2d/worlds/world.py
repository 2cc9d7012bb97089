"""The world, one trial at a time, for a controller of one's own.

world = arm2d.World()
inputs = world.reset("touch green", seed=1)
while not world.ended:
    inputs = world.step(controller(inputs))     # two of -1, 0 and 1: S1's turn and S2's
print(world.score(), world.record())
"""

from __future__ import annotations

from collections.abc import Sequence
from reprlib import repr as shortened

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import constants as c
from arm2d.instructions import Instruction, instruction_of
from arm2d.kernel import exchange
from arm2d.readings import Readings, given_or_default
from arm2d.running import record_of
from arm2d.tasks.task import AnyTask, as_paper, check_asked, own_task
from arm2d.trials import TrialRecord, Trials, TrialScores, draw_trials
from arm2d.worlds.vector_world import VectorWorld

# Without a network of ours, a record shows the states of the paper's three inter-neurons as 0.
_COLUMNS = exchange.RECORD_STATE + c.N_INTER


class World:
    """One trial that takes turns of the joints and gives the 18 inputs, bit by bit the kernel's.

    Args:
        readings: How the paper is understood; the default readings if none are given.
        task: Which instructions there are, how words are said and where colours stand: a condition of the
            paper, its name, or an `arm2d.Task`. If none is given, any instruction is taken, as in the paper.

    Raises:
        ValueError: If there is no such task, or the readings are of another kind.
    """

    def __init__(self, readings: Readings | None = None, task: AnyTask | str | None = None) -> None:
        self.readings = given_or_default(readings)
        self.task = None if task is None else as_paper(task)
        self._vector: VectorWorld | None = None
        self._rows: list[NDArray[np.float64]] = []
        self._inputs: list[NDArray[np.float64]] = []

    def __repr__(self) -> str:
        if self._vector is None:
            return "<World: no trial yet>"
        over = ", over" * self.ended
        return f"<World: {self._vector.trials.instructions[0]}, step {len(self._rows)}{over}>"

    def reset(
        self, instruction: Instruction | str, *, seed: int | None = None, start: Trials | None = None
    ) -> NDArray[np.float64]:
        """Begin a trial.

        Args:
            instruction: Such as "touch green"; what is heard, and scored.
            seed: Draws start angle and objects, in either start area; a fresh one if none is given.
            start: Where arm and objects stand, in place of a seed: a batch of one trial, whose own
                instruction does not matter.

        Returns:
            The inputs [18], named by `INPUT_NAMES`.

        Raises:
            ValueError: If the instruction is none, or not one of the task's, or both or too many starts are
                given.
        """
        words = instruction_of(instruction)
        if self.task is not None:
            check_asked([words], self.task)
        if start is None:
            rng = np.random.default_rng(seed)
            start = draw_trials([words], 1, self.readings, rng, self.task)[int(rng.integers(2))]
        elif seed is not None or not isinstance(start, Trials) or len(start) != 1:
            raise ValueError("give either a seed or a start of exactly one trial")
        asked = np.array([words.action]), np.array([words.object])
        trial = Trials(*asked, start.alpha, start.discs, task=start.task or own_task(self.task))
        self._vector, self._rows, self._inputs = VectorWorld(trial, self.readings), [], []
        return self.inputs

    @property
    def inputs(self) -> NDArray[np.float64]:
        """[18], what is sensed now."""
        return self._current.inputs[0].copy()

    @property
    def ended(self) -> bool:
        """Whether the trial is over."""
        return bool(self._current.ended[0])

    def step(self, turns: Sequence[float] | ArrayLike) -> NDArray[np.float64]:
        """Turn S1 and S2 by -1, 0 or 1 each; the inputs [18] afterwards.

        Raises:
            ValueError: If the turns are anything else, or the trial is over.
        """
        if self.ended:
            raise ValueError("this trial is over; begin another one with reset")
        row, sensed, pair = np.zeros(_COLUMNS), self.inputs, np.asarray(turns)
        if pair.shape != (2,):
            raise ValueError(
                f"turns must be a pair, S1's and S2's, each -1, 0 or 1; this is {shortened(turns)}"
            )
        self._current.step(pair[np.newaxis], row)
        self._rows.append(row)
        self._inputs.append(sensed)
        return self.inputs

    def hear(self, instruction: Instruction | str) -> None:
        """Change the words that are heard from the next step on; scored is what was asked for at first."""
        self._current.hear(instruction)

    def score(self) -> TrialScores:
        """F1, F2, F3, success and steps, each [1, 1]; of a trial that goes on, as if it ended now."""
        return self._current.scores()

    def record(self) -> TrialRecord:
        """All steps so far, as `record_trial` gives them; a controller's own states are unknown, hence 0."""
        rows = np.array(self._rows).reshape(-1, _COLUMNS)
        return record_of(
            self._current.trials,
            self.readings,
            rows,
            np.array(self._inputs).reshape(-1, c.N_INPUTS),
            self.score(),
        )

    @property
    def _current(self) -> VectorWorld:
        if self._vector is None:
            raise ValueError("no trial has begun; call reset with an instruction, such as 'touch green'")
        return self._vector
