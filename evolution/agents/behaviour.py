"""What an agent does in trials of all nine instructions, step by step.

Axes: T trials, K + 1 = 251 rows of a trial (row 0 the start, row k the state after step k), N neurons.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import Condition, Instruction, Readings, TrialRecord, Trials, decode, draw_trials, record_trial
from arm2d.arithmetic import sigmoid
from arm2d.constants import MAX_STEPS
from arm2d.geometry import in_view
from arm2d.instructions import instruction_of
from arm2d.records import alike, brief
from arm2d.tasks.task import AnyTask, check_asked, papers_condition
from evolution.agents.firsts import first_row
from evolution.search.randomness import Purpose, generator

TRIALS_PER_AREA: Final = 20
# What the seeded draws are for; this stands in the place of a generation.
RECORDED: Final = 2


@dataclass(frozen=True)
class Behaviour:
    """T recorded trials of one agent; rows after a trial's end are NaN.

    Attributes:
        condition: Names the instructions.
        instructions: [T], index into `condition.instructions`.
        areas: [T], 0 for a start in the right area, 1 for the left.
        success: [T].
        steps: [T], steps made.
        alpha: [T, 251], angle of S1 in [deg].
        beta: [T, 251], angle of S2 in [deg].
        activity: [T, 251, N], outputs sigma(y + beta_j) of the inter-neurons.
        first_sight: [T], first row in which the target is in view, or -1. Its row is the state that
            brought it there: what is seen acts on the neurons from the next row on.
        first_touch: [T], first row in which S2 touches the target, or -1; likewise.
    """

    condition: Condition
    instructions: NDArray[np.int64]
    areas: NDArray[np.int64]
    success: NDArray[np.bool_]
    steps: NDArray[np.int64]
    alpha: NDArray[np.float64]
    beta: NDArray[np.float64]
    activity: NDArray[np.float64]
    first_sight: NDArray[np.int64]
    first_touch: NDArray[np.int64]

    __repr__ = brief
    __eq__ = alike

    def __len__(self) -> int:
        return len(self.instructions)

    @property
    def actions(self) -> NDArray[np.int64]:
        """[T], index of the action word: 0 MOVE, 1 TOUCH, 2 the third."""
        return self.instructions // 3

    @property
    def objects(self) -> NDArray[np.int64]:
        """[T], code of the object word."""
        return self.instructions % 3

    def of(self, instruction: Instruction | str) -> NDArray[np.int64]:
        """The trials of one instruction; text such as "touch green" will do.

        Raises:
            ValueError: If the condition has no such instruction.
        """
        asked = instruction_of(instruction)
        check_asked([asked], self.condition)
        return np.flatnonzero(self.instructions == self.condition.instructions.index(asked))

    def arrays(self) -> dict[str, NDArray]:
        """Its arrays by name, ready for an .npz."""
        names = [field.name for field in fields(self) if field.name != "condition"]
        return {"condition": np.array(str(self.condition)), **{name: getattr(self, name) for name in names}}


def record_behaviour(
    genotype: ArrayLike,
    condition: AnyTask | str,
    readings: Readings,
    *,
    per_area: int = TRIALS_PER_AREA,
    trial_seed: int = 0,
) -> Behaviour:
    """Record fresh trials of all nine instructions.

    Args:
        genotype: [G], or of a network of another size.
        condition: Which nine instructions; its name will do.
        readings: The world, which should be the one the agent evolved in.
        per_area: Trials of each instruction from each start area.
        trial_seed: Draws the trials.

    Raises:
        ValueError: If the genotype is unsound, or there are no trials.
    """
    condition = papers_condition(condition, "this analysis")
    trials = draw_behaviour_trials(condition, readings, per_area, trial_seed)
    records = [record_trial(genotype, trials[i], readings) for i in range(len(trials))]
    biases = decode(genotype, readings).inter_biases[0]
    outputs = [np.vectorize(sigmoid)(np.vstack([np.zeros(len(biases)), r.states]) + biases) for r in records]
    events = [_events(record) for record in records]
    return Behaviour(
        condition=condition,
        instructions=np.repeat(np.arange(len(condition.instructions)), 2 * per_area),
        areas=np.tile(np.repeat([0, 1], per_area), len(condition.instructions)),
        success=np.array([record.success for record in records]),
        steps=np.array([record.steps for record in records]),
        alpha=_padded([record.alpha for record in records]),
        beta=_padded([record.beta for record in records]),
        activity=_padded(outputs),
        first_sight=np.array([sight for sight, _ in events]),
        first_touch=np.array([touch for _, touch in events]),
    )


def draw_behaviour_trials(condition: Condition, readings: Readings, per_area: int, seed: int) -> Trials:
    """The trials in which behaviour is watched, instruction by instruction; right starts first."""
    rng = generator(seed, Purpose.BEHAVIOUR, RECORDED)
    return draw_trials(condition.instructions, per_area, readings, rng)


def _events(record: TrialRecord) -> tuple[int, int]:
    """Rows of first sight and first touch of the target, or -1."""
    target = record.instruction.object
    seen = in_view(record.alpha, record.discs[:, target], record.readings)
    return first_row(seen), first_row(record.contact[:, target] != 0)


def _padded(rows: list[NDArray[np.float64]]) -> NDArray[np.float64]:
    """Arrays of different lengths in one, [T, 251, ...], NaN after their ends."""
    padded = np.full((len(rows), MAX_STEPS + 1, *rows[0].shape[1:]), np.nan)
    for trial, row in enumerate(rows):
        padded[trial, : len(row)] = row
    return padded
