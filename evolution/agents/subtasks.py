"""Sub-tasks and categories of Table II, and the classes of agents (section VII; spec section 10)."""

from __future__ import annotations

from enum import StrEnum
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import NON_EXPERIENCED, Condition, Instruction
from arm2d.tasks.task import AnyTask, papers_condition
from evolution.agents.postevaluation import TRIALS

TOUCH_GREEN, MOVE_BLUE = NON_EXPERIENCED
SUBTASKS: Final = ("I", "II", "III", "IV")
N_CATEGORIES: Final = 11
# The classes of agents ask for more than this share of trials.
USUALLY: Final = 0.75
TRIALS_PER_CATEGORY: Final = TRIALS // (N_CATEGORIES - 1)


class AgentClass(StrEnum):
    """How far an agent that obeys all experienced instructions generalises."""

    FULL = "fully compositional"
    PARTIAL = "partially compositional"
    NONE = "non-compositional"


def subtask_instructions(condition: Condition) -> dict[str, tuple[Instruction, ...]]:
    """Which instructions belong to each sub-task: the experienced ones, and which never-met ones besides."""
    known = condition.experienced
    return {
        "I": known,
        "II": (*known, MOVE_BLUE),
        "III": (*known, TOUCH_GREEN),
        "IV": (*known, MOVE_BLUE, TOUCH_GREEN),
    }


def categories(successes: NDArray[np.integer], condition: Condition) -> NDArray[np.int64]:
    """Categories [A, 4] of A agents in the four sub-tasks.

    0 if the least-mastered instruction of the sub-task never succeeded, else n if it succeeded in more
    than 8 (n - 1) and at most 8 n of 80 trials.

    Args:
        successes: [A, 9], of 80 trials each.
        condition: Names the nine instructions.

    Raises:
        ValueError: If these are no counts of 80 trials.
    """
    successes, order = counts_of(successes, condition), condition.instructions
    columns = [
        successes[:, [order.index(word) for word in instructions]].min(axis=1)
        for instructions in subtask_instructions(condition).values()
    ]
    lowest = np.stack(columns, axis=1).astype(np.int64)
    return -(-lowest // TRIALS_PER_CATEGORY)


def counts_of(successes: ArrayLike, condition: AnyTask) -> NDArray[np.integer]:
    """Successes [A, I] as an array, if they are counts of 80 trials of I instructions.

    Raises:
        ValueError: If they are anything else, such as shares or counts by start area.
    """
    found, n_instructions = np.asarray(successes), len(condition.instructions)
    if found.dtype.kind not in "iu" or found.ndim != 2 or found.shape[1] != n_instructions:
        raise ValueError(
            f"successes must be whole numbers [A, {n_instructions}] of {TRIALS} trials, both start areas "
            f"together, but had {found.dtype} {list(found.shape)}"
        )
    if ((found < 0) | (found > TRIALS)).any():
        other = found.min() if (found < 0).any() else found.max()
        raise ValueError(f"successes must be of {TRIALS} trials, so 0 to {TRIALS}, but had {other}")
    return found


def count_table(categories_: NDArray[np.int64]) -> NDArray[np.int64]:
    """Agents by category and sub-task, [11, 4]: Table II."""
    return np.stack([np.bincount(column, minlength=N_CATEGORIES) for column in categories_.T], axis=1)


def usually(successes: NDArray[np.integer]) -> NDArray[np.bool_]:
    """Where successes, of 80 trials each, exceed the classes' 75 %: more than 60 trials."""
    return successes > USUALLY * TRIALS


def obeys_experienced(successes: NDArray[np.integer], condition: AnyTask) -> NDArray[np.bool_]:
    """Which agents [A] exceed 75 % on every experienced instruction, of the paper or of another task."""
    known = [condition.instructions.index(word) for word in condition.experienced]
    return np.all(usually(counts_of(successes, condition)[:, known]), axis=1)


def carries_out(
    successes: NDArray[np.integer], condition: AnyTask, instruction: Instruction
) -> NDArray[np.bool_]:
    """Which agents [A] exceed 75 % on every experienced instruction, and on this one besides."""
    column = counts_of(successes, condition)[:, condition.instructions.index(instruction)]
    return obeys_experienced(successes, condition) & usually(column)


def classify(successes: ArrayLike, condition: AnyTask | str) -> dict[AgentClass, NDArray[np.bool_]]:
    """Which agents [A] belong to each class; those between the classes belong to none.

    Above 75 % means more than 60 of 80 trials, below 10 % fewer than 8.

    Args:
        successes: [A, 9], of 80 trials each, such as `post_evaluate(run).agents` or, of agents evaluated
            with the usual 40 trials from each start area, `evaluate(...).successes.sum(axis=-1)`.
        condition: Names the nine instructions; its name will do.

    Raises:
        ValueError: If these are no counts of 80 trials, or the condition is none of the paper's two, for
            whose two instructions that are never met the classes are made.
    """
    condition = papers_condition(condition, "this classification")
    successes = counts_of(successes, condition)
    never_met = [condition.instructions.index(word) for word in condition.held_out]
    counts = successes[:, never_met].astype(np.int64)
    high, low = usually(counts), 10 * counts < TRIALS
    known = obeys_experienced(successes, condition)
    return {
        AgentClass.FULL: known & high.all(axis=1),
        AgentClass.PARTIAL: known & (high.sum(axis=1) == 1) & (low.sum(axis=1) == 1),
        AgentClass.NONE: known & low.all(axis=1),
    }
