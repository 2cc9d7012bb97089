"""Many trials side by side, moved step by step by controllers of one's own.

world = VectorWorld(draw_trials(instructions, 100, readings, rng), readings)
while not world.ended.all():
    turns = policy(world.inputs)        # [N, 18] -> [N, 2], each -1, 0 or 1
    world.step(turns)
world.scores().success                  # [1, N]
"""

from __future__ import annotations

from collections.abc import Iterable
from reprlib import repr as shortened
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import constants as c
from arm2d.instructions import Instruction, instructions_of
from arm2d.kernel import stepping
from arm2d.kernel.controller import OBJECT_WORD_INPUTS
from arm2d.kernel.lanes import N_INTEGER_FIELDS, N_LANES, N_WORLD_FIELDS
from arm2d.kernel.world import tables_of, world_of
from arm2d.readings import Readings, given_or_default
from arm2d.running import arrays_of, codes_of, empty_outcomes
from arm2d.tasks.hearing import phase_after, word_bits
from arm2d.trials import Trials, TrialScores

_COLOURS: Final = ("blue", "green", "red")
# What the 18 inputs of a controller are, I1 to I18, with their ranges.
INPUT_NAMES: Final = (
    "touch right [0 or 1]",
    "touch left [0 or 1]",
    *(f"camera {side} {colour} [0 or 1]" for side in ("right", "middle", "left") for colour in _COLOURS),
    "bend [beta / 90 degrees]",
    *(f"object word {bit} [0 or 1]" for bit in (1, 2, 3)),
    *(f"action word {bit} [0 or 1]" for bit in (1, 2, 3)),
)
"""What I1 to I18 of spec section 4 are, with their units."""

_NOTHING: Final = np.empty(0)


class VectorWorld:
    """N trials that take turns of the joints and give inputs; a trial that has ended stays as it is.

    Every step of the world is the kernel's, bit by bit.

    Args:
        trials: The starts and instructions. Words that change by themselves (`changes`) are refused:
            here the caller changes them, see `hear`. Words that their task has come one after the other do.
        readings: The world; the default readings if none are given.

    Attributes:
        inputs: [N, 18], what is sensed now, named by `INPUT_NAMES`. The array is written anew by
            every step; copy what you keep.
        readings: The world.

    Raises:
        ValueError: If the trials have label changes, or there are none, or the readings are of another kind.
    """

    def __init__(self, trials: Trials, readings: Readings | None = None) -> None:
        if trials.changes is not None:
            raise ValueError(
                "these trials change their words by themselves; leave the changes out and use hear"
            )
        if len(trials) == 0:
            raise ValueError("a world of no trials cannot be stepped; draw at least one")
        self.readings = given_or_default(readings)
        self._world, self._sines = world_of(self.readings), tables_of(self.readings).beta_sines
        blocks = (len(trials) + N_LANES - 1) // N_LANES
        self._blocks = stepping.Blocks(
            np.zeros((blocks, N_WORLD_FIELDS * N_LANES)),
            np.zeros((blocks, N_INTEGER_FIELDS * N_LANES), np.int64),
            np.zeros((len(trials), c.N_INPUTS)),
        )
        self._outcomes, self._task = empty_outcomes(1, len(trials)), trials.task
        self._codes = codes_of(trials)
        self._arrays, self._discs = arrays_of(trials), trials.discs.copy()
        # Ours to write on when trials are begun anew.
        self._arrays = self._arrays._make(np.array(array) for array in self._arrays)
        self._start(np.arange(len(trials)))

    def __len__(self) -> int:
        return len(self.inputs)

    def __repr__(self) -> str:
        return f"<VectorWorld: {len(self)} trial{'s' * (len(self) != 1)}, {self.ended.sum()} over>"

    @property
    def trials(self) -> Trials:
        """The starts and instructions of the trials as they are now under way."""
        arrays = self._arrays
        return Trials(arrays.action, arrays.object, arrays.alpha, self._discs, task=self._task)

    @property
    def inputs(self) -> NDArray[np.float64]:
        """[N, 18], what is sensed now."""
        return self._blocks.inputs

    @property
    def ended(self) -> NDArray[np.bool_]:
        """[N], which trials are over: succeeded, collided, or 250 steps old."""
        return self._lane_field(stepping.at.DONE) != 0

    def step(self, turns: ArrayLike, row: NDArray[np.float64] = _NOTHING) -> NDArray[np.float64]:
        """Turn both joints of every trial once, and let the world follow.

        Args:
            turns: [N, 2], -1, 0 or 1 for S1 (positive is anticlockwise) and S2 (positive bends).
            row: For `World`: where the kernel writes the first trial down.

        Returns:
            `inputs`.

        Raises:
            ValueError: If the turns are anything else.
        """
        stepping.step(
            self._blocks,
            checked_turns(turns, len(self)),
            self._arrays,
            self._world,
            self._sines,
            self._outcomes,
            row,
        )
        if self._task is not None and self._task.in_sequence:
            self._say(np.arange(len(self)))
        return self.inputs

    def hear(self, instructions: Iterable[Instruction | str] | Instruction | str) -> None:
        """Change the words heard from the next step on, of all trials or one for each; scored is the old one.

        Raises:
            ValueError: If there are neither one nor N instructions, one is not understood, or words come
                one after the other.
        """
        if self._task is not None and self._task.in_sequence:
            raise ValueError(
                f"in the task {self._task} words come one after the other; they cannot be changed"
            )
        heard = instructions_of(instructions)
        if isinstance(instructions, Instruction | str):
            heard = heard * len(self)
        if len(heard) != len(self):
            raise ValueError(f"{len(self)} trials hear one instruction or one each, not {len(heard)}")
        actions = np.array([instruction.action for instruction in heard])
        objects = np.array([instruction.object for instruction in heard])
        self.inputs[:, OBJECT_WORD_INPUTS:] = word_bits(actions, objects, self._codes)

    def restart(self, which: ArrayLike, trials: Trials) -> None:
        """Begin some trials anew.

        Args:
            which: [k], their numbers.
            trials: A batch of k, their new starts and instructions.

        Raises:
            ValueError: If there are not as many starts as numbers, no such trials, or no whole numbers.
        """
        numbers = np.asarray(which)
        if numbers.size and numbers.dtype.kind not in "iu":
            raise ValueError(
                f"a restart takes whole numbers of trials, such as [0, 2], not {shortened(which)}"
            )
        chosen = numbers.astype(np.int64).reshape(-1)
        if trials.task != self._task:
            raise ValueError("trials of one task cannot be begun anew as trials of another")
        if len(chosen) != len(trials) or (chosen < 0).any() or (chosen >= len(self)).any():
            raise ValueError(
                f"a restart takes numbers of trials from 0 to {len(self) - 1} and a start for each, "
                f"not {len(chosen)} numbers and {len(trials)} starts"
            )
        for kept, new in zip(self._arrays, arrays_of(trials), strict=True):
            kept[chosen] = new
        self._discs[chosen] = trials.discs
        self._start(chosen)

    def scores(self) -> TrialScores:
        """F1 to F3 and success of every trial, [1, N]; of one that goes on, as if it ended now."""
        stepping.score_now(self._blocks, self._arrays, self._world, self._outcomes)
        kept = self._outcomes
        return TrialScores(
            kept.f1.copy(), kept.f2.copy(), kept.f3.copy(), kept.success.copy(), kept.steps.copy()
        )

    def positions(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
        """Where everything is: alpha and beta [N, 2] in [deg], discs [N, 3, 2] in [cm], contacts [N, 3].

        A contact is 0 nowhere, 1 on S2's right side, 2 on its left.
        """
        arm, polar = np.empty((len(self), 2)), np.empty((len(self), c.N_OBJECTS, 2))
        sides = np.empty((len(self), c.N_OBJECTS), np.int64)
        stepping.positions(self._blocks, arm, polar, sides)
        angles = np.radians(polar[..., 0])
        discs = polar[..., 1, np.newaxis] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        return arm, discs, sides

    def _start(self, which: NDArray[np.int64]) -> None:
        stepping.start(self._blocks, which, self._arrays, self._world)
        self._say(which)

    def _say(self, which: NDArray[np.int64]) -> None:
        """Let trials hear what they should at their step."""
        heard = self._arrays.heard[which]  # [k, 2 or 3, 2]
        phase = np.zeros(len(which), np.int64)
        if self._task is not None:
            phase = phase_after(self._lane_field(stepping.at.STEP)[which], self._task)
        action, object_ = heard[np.arange(len(which)), phase].T
        self.inputs[which, OBJECT_WORD_INPUTS:] = word_bits(action, object_, self._codes)

    def _lane_field(self, field: int) -> NDArray[np.int64]:
        """[N], a whole-number field of the trials' lanes."""
        return self._blocks.n[:, field : field + N_LANES].reshape(-1)[: len(self)]


def checked_turns(turns: ArrayLike, n: int) -> NDArray[np.int64]:
    """Turns [N, 2] as whole numbers.

    Raises:
        ValueError: If they are not N pairs of -1, 0 or 1.
    """
    array = np.asarray(turns)
    if array.shape != (n, 2) or array.dtype.kind not in "iuf":
        raise ValueError(
            f"turns must be {n} pair{'s' * (n != 1)}, S1's and S2's, each -1, 0 or 1; "
            f"this is {array.dtype} {array.shape}"
        )
    possible = (array >= -1) & (array <= 1) & (array == np.rint(array))
    if not possible.all():
        wrong = array[~possible][0]
        raise ValueError(f"a turn of {wrong:g} was asked for; each joint turns by -1, 0 or 1 in a step")
    return array.astype(np.int64)
