"""Trials, their scores and their recordings; and how trials are drawn (spec sections 2 and 8).

Axes: P genotypes, T trials, K steps, O = 3 objects (blue, green, red).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property, lru_cache
from numbers import Integral
from reprlib import repr as shortened
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import constants as c
from arm2d.arithmetic import sin_cos
from arm2d.instructions import ActionWord, Instruction, ObjectWord, instructions_of
from arm2d.readings import Readings, checked_readings
from arm2d.records import alike, brief
from arm2d.tasks.task import AnyTask, Task, as_paper, check_asked, own_task

MOST_PER_AREA = 100_000
StartArea = Literal["right", "left"]
START_AREAS: Final[tuple[StartArea, ...]] = ("right", "left")


@dataclass(frozen=True)
class LabelChanges:
    """Instructions that change once in mid-trial (spec section 10, transition tests).

    Attributes:
        first_actions: [T] and
        first_objects: [T], the words heard from the start.
        later_actions: [T] and
        later_objects: [T], the words heard after the change.
        delays: [T], steps from the first step after which the target is in view to the change; 0 to 250.
            The transition tests draw 0 to 9.

    Raises:
        ValueError: If a row does not hold whole numbers in these bounds, or they are not equally long.
    """

    first_actions: NDArray[np.int64]
    first_objects: NDArray[np.int64]
    later_actions: NDArray[np.int64]
    later_objects: NDArray[np.int64]
    delays: NDArray[np.int64]

    __repr__ = brief
    __eq__ = alike

    def __post_init__(self) -> None:
        for name, low, high in (
            ("first_actions", 0, 3),
            ("first_objects", 0, 2),
            ("later_actions", 0, 3),
            ("later_objects", 0, 2),
            ("delays", 0, c.MAX_STEPS),
        ):
            _store(self, name, _whole_numbers(name, getattr(self, name), low, high))
        lengths = [len(getattr(self, each.name)) for each in fields(self)]
        if len(set(lengths)) > 1:
            raise ValueError(
                f"the rows of label changes have the lengths {', '.join(map(str, lengths))}; "
                "they must be equally long, one entry for each trial"
            )

    def __getitem__(self, index: slice | NDArray[np.int64]) -> LabelChanges:
        return LabelChanges(*(getattr(self, each.name)[index] for each in fields(self)))


@dataclass(frozen=True)
class Trials:
    """T trials: what is asked and how the world stands at the start. Beta starts at 90 degrees.

    Attributes:
        actions: [T] codes of `ActionWord`.
        objects: [T] codes of `ObjectWord`: the targets.
        alpha: [T], angle of S1 in [deg].
        discs: [T, 3, 2], centres of the blue, green and red disc in [cm].
        changes: The words heard, where they are not those that are scored throughout.
        task: How the words are said, if not as in the paper; see `arm2d.Task`. A condition of the paper, or
            its name, is taken too and kept as None.

    Raises:
        ValueError: If the arrays do not fit together, a start leaves the world, or there is no such task.
    """

    actions: NDArray[np.int64]
    objects: NDArray[np.int64]
    alpha: NDArray[np.float64]
    discs: NDArray[np.float64]
    changes: LabelChanges | None = None
    task: Task | None = None

    __eq__ = alike

    def __post_init__(self) -> None:
        _store(self, "actions", _whole_numbers("actions", self.actions, 0, len(ActionWord) - 1))
        _store(self, "objects", _whole_numbers("objects", self.objects, 0, len(ObjectWord) - 1))
        _store(self, "alpha", np.array(self.alpha, dtype=np.float64))
        _store(self, "discs", np.array(self.discs, dtype=np.float64))
        object.__setattr__(self, "task", own_task(self.task))
        _check_starts(self)
        if self.changes is not None and self.task is not None and self.task.in_sequence:
            raise ValueError("words that come one after the other cannot change in mid-trial; leave one out")

    def __repr__(self) -> str:
        asked = len(set(zip(self.actions.tolist(), self.objects.tolist(), strict=True)))
        changing = "" if self.changes is None else ", words change"
        return f"<Trials: {len(self)} of {asked} instruction{'s' * (asked != 1)}{changing}>"

    def __len__(self) -> int:
        return len(self.actions)

    def __getitem__(self, index: int | slice | NDArray[np.int64]) -> Trials:
        """Some of these trials; with a whole number, a batch of that one."""
        if isinstance(index, (int, np.integer)):
            if not -len(self) <= index < len(self):
                raise IndexError(f"trial {index} does not exist; there are {len(self)}")
            index = np.array([index])
        changes = None if self.changes is None else self.changes[index]
        starts = self.alpha[index], self.discs[index]
        return Trials(self.actions[index], self.objects[index], *starts, changes, self.task)

    @property
    def instructions(self) -> list[Instruction]:
        """The scored instruction of every trial."""
        return [
            Instruction(ActionWord(a), ObjectWord(o)) for a, o in zip(self.actions, self.objects, strict=True)
        ]


@dataclass(frozen=True)
class TrialScores:
    """What P genotypes made of T trials (section VI); every array is [P, T].

    Attributes:
        f1: Reaching the target, or losing sight of it.
        f2: Carrying out the action.
        f3: Stretching S2 for TOUCH and MOVE.
        fitness: f1 + f2 + f3.
        success: Whether the instruction was carried out.
        steps: Steps made until the trial ended.
    """

    f1: NDArray[np.float64]
    f2: NDArray[np.float64]
    f3: NDArray[np.float64]
    success: NDArray[np.bool_]
    steps: NDArray[np.int64]

    __eq__ = alike

    def __repr__(self) -> str:
        n_genotypes, n_trials = self.success.shape
        share = f", {100 * self.success.mean():.0f} % carried out" if self.success.size else ""
        return f"<TrialScores: {n_genotypes} x {n_trials} trials{share}>"

    @cached_property
    def fitness(self) -> NDArray[np.float64]:
        """f1 + f2 + f3, [P, T]."""
        return self.f1 + self.f2 + self.f3


@dataclass(frozen=True)
class TrialRecord:
    """One trial, step by step. Row 0 of a state is the start, row k the state after step k.

    Attributes:
        instruction: The instruction that is scored.
        readings: The world it took place in.
        alpha: [K + 1], angle of S1 in [deg].
        beta: [K + 1], angle of S2 in [deg].
        discs: [K + 1, 3, 2], centres in [cm].
        contact: [K + 1, 3], where each disc touches S2: 0 nowhere, 1 its right side, 2 its left.
        inputs: [K, 18], what was sensed in each step, I1 to I18.
        states: [K, N], the inter-neurons' states y after each step.
        turns: [K, 2], turns of S1 and S2 in each step after clipping [deg].
        scores: F1, F2, F3, success and steps, each [1, 1].
        task: How the words were said, if not as in the paper.
    """

    instruction: Instruction
    readings: Readings
    alpha: NDArray[np.float64]
    beta: NDArray[np.float64]
    discs: NDArray[np.float64]
    contact: NDArray[np.int8]
    inputs: NDArray[np.float64]
    states: NDArray[np.float64]
    turns: NDArray[np.float64]
    scores: TrialScores
    task: Task | None = None

    __eq__ = alike

    def __repr__(self) -> str:
        outcome = "" if self.success else "not "
        return f"<TrialRecord: {self.instruction}, {outcome}carried out in {self.steps * c.DT:.1f} s>"

    @property
    def steps(self) -> int:
        """K, the number of steps made."""
        return len(self.turns)

    @property
    def success(self) -> bool:
        """Whether the instruction was carried out."""
        return bool(self.scores.success[0, 0])

    @property
    def fitness(self) -> float:
        """F1 + F2 + F3."""
        return float(self.scores.fitness[0, 0])


def area_index(area: str) -> int:
    """Which of the two start areas a name means: the place of its trial when one is drawn from each.

    Raises:
        ValueError: If there is no such area.
    """
    if area not in START_AREAS:
        raise ValueError(f"unknown start area {area!r}; there are {' and '.join(START_AREAS)}")
    return START_AREAS.index(area)


def draw_trials(
    instructions: Sequence[Instruction | str] | Instruction | str,
    per_area: int,
    readings: Readings,
    rng: np.random.Generator,
    task: AnyTask | str | None = None,
) -> Trials:
    """Trials of each instruction from fresh starts: `per_area` in the right area, then as many in the left.

    Start angles are uniform in the areas; each disc is uniform on its sector's chord (spec section 2).
    Instruction follows instruction, T = len(instructions) * 2 * per_area.

    Args:
        instructions: Records or text, such as "touch green"; one, or several.
        per_area: Trials of each instruction from each start area.
        readings: The world.
        rng: Every draw comes from it.
        task: Which instructions there are, how their words are said and where the colours stand: a condition
            of the paper, its name, or a `Task`. If none is given, any instruction is taken, as in the paper.

    Raises:
        ValueError: If there are no trials to draw, too many, an instruction is not understood or not one of
            the task's, or an argument is of another kind.
    """
    instructions = instructions_of(instructions)
    _check_draw(per_area, len(instructions), readings, rng)
    if task is not None:
        task = as_paper(task)
        check_asked(instructions, task)
    n = len(instructions)
    low, high = np.array(readings.start_intervals).T  # [2 areas]
    draws = rng.random((n, 2, per_area, 1 + c.N_OBJECTS))
    alpha = low[:, np.newaxis] + (high - low)[:, np.newaxis] * draws[..., 0]  # [n, 2, per_area]
    own = own_task(task)
    ends = _chord_ends(readings)
    if own is not None and own.places == "dealt":
        sectors = rng.random((n, 2, per_area, c.N_OBJECTS)).argsort(axis=-1)
        ends = ends[:, sectors]  # [2 ends, n, 2, per_area, 3, 2]
    discs = ends[0] + (ends[1] - ends[0]) * draws[..., 1:, np.newaxis]
    repeats = 2 * per_area
    return Trials(
        actions=np.fromiter((each.action for each in instructions), np.int64, n).repeat(repeats),
        objects=np.fromiter((each.object for each in instructions), np.int64, n).repeat(repeats),
        alpha=alpha.reshape(-1),
        discs=discs.reshape(-1, c.N_OBJECTS, 2),
        task=own,
    )


def _check_draw(per_area: int, n: int, readings: Readings, rng: np.random.Generator) -> None:
    """Refuse to draw trials of n instructions from what trials cannot be drawn from."""
    if not isinstance(per_area, Integral):
        raise ValueError(f"per_area = {shortened(per_area)} must be a whole number of trials, such as 40")
    if per_area < 1 or not n:
        raise ValueError(f"asked for {per_area} trials per area of {n} instructions; both must be at least 1")
    if per_area > MOST_PER_AREA:
        raise ValueError(f"asked for {per_area} trials per area; at most {MOST_PER_AREA} fit into the memory")
    checked_readings(readings)
    if not isinstance(rng, np.random.Generator):
        raise ValueError(f"rng = {shortened(rng)} must be a generator, such as numpy.random.default_rng(1)")


@lru_cache(maxsize=64)
def _chord_ends(readings: Readings) -> NDArray[np.float64]:
    """Both ends of each sector's chord, [2, 3, 2] in [cm]."""
    ends = np.empty((2, c.N_OBJECTS, 2))
    for disc, centre in enumerate(readings.sector_centres):
        for end, side in enumerate((-1.0, 1.0)):
            sine, cosine = sin_cos(centre + side * readings.sector_half_width)
            ends[end, disc] = c.CHORD_END_DISTANCE * cosine, c.CHORD_END_DISTANCE * sine
    ends.flags.writeable = False
    return ends


def _store(record: object, name: str, array: NDArray) -> None:
    """Keep an array in a frozen record, read-only."""
    array.flags.writeable = False
    object.__setattr__(record, name, array)


def _whole_numbers(name: str, values: ArrayLike, low: int, high: int) -> NDArray[np.int64]:
    """The values as [T] whole numbers, all within [low, high]."""
    array = np.array(values)
    if array.ndim != 1 or not np.issubdtype(array.dtype, np.integer):
        raise ValueError(f"{name} must be a row of whole numbers [T], not {array.dtype} {array.shape}")
    if array.size and not low <= array.min() <= array.max() <= high:
        numbers = "numbers of steps" if name == "delays" else "codes"
        raise ValueError(f"{name} holds {array.min()} to {array.max()}; the {numbers} are {low} to {high}")
    return array.astype(np.int64)


def _check_starts(trials: Trials) -> None:
    """Refuse starts that do not fit together or leave the world."""
    n = len(trials.actions)
    if (
        trials.objects.shape != (n,)
        or trials.alpha.shape != (n,)
        or trials.discs.shape != (n, c.N_OBJECTS, 2)
    ):
        raise ValueError(
            f"{n} actions need objects [{n}], alpha [{n}] and discs [{n}, 3, 2]; "
            f"these are {trials.objects.shape}, {trials.alpha.shape} and {trials.discs.shape}"
        )
    if trials.changes is not None and trials.changes.delays.shape != (n,):
        raise ValueError(f"{n} trials need as many label changes, not {len(trials.changes.delays)}")
    if not np.all((trials.alpha >= c.ALPHA_MIN) & (trials.alpha <= c.ALPHA_MAX)):
        raise ValueError(f"alpha must lie in [{c.ALPHA_MIN:g}, {c.ALPHA_MAX:g}] degrees")
    if not np.all(np.isfinite(trials.discs)):
        raise ValueError("a disc's centre is not a number")
    if np.any(np.hypot(trials.discs[..., 0], trials.discs[..., 1]) < c.S1_LENGTH):
        raise ValueError(f"a disc's centre lies within {c.S1_LENGTH:g} cm of J1, where S2 never is")
