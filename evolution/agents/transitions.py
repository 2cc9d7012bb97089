"""The paper's second test: the instruction changes in mid-trial (section VII, Fig. 4; spec section 10).

Action transition (a1 -> a2, object o): scores follow a2 on o. Object transition (o1 -> o2, action a):
scores follow a on o1. Transitions whose scored instruction was never met are left out. An agent passes
a test if every transition of it succeeds in more than 60 of 80 trials.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import (
    NON_EXPERIENCED,
    Condition,
    Instruction,
    LabelChanges,
    ObjectWord,
    Readings,
    Trials,
    draw_trials,
    run_trials,
)
from evolution.agents.postevaluation import TRIALS
from evolution.search.evaluation import TRIALS_PER_AREA

# The change comes at one of so many steps, from the first after which the target is in view.
CHANGE_STEPS: Final = 10


@dataclass(frozen=True)
class Transition:
    """A change of words in mid-trial.

    Attributes:
        before: The instruction heard first.
        after: The instruction heard later.
        scored: What the trial is scored as.
    """

    before: Instruction
    after: Instruction
    scored: Instruction

    def __str__(self) -> str:
        return f"{self.before} → {self.after}"


def action_transitions(condition: Condition) -> tuple[Transition, ...]:
    """All changes of the action word whose scored instruction was met, object by object."""
    actions = sorted({each.action for each in condition.instructions})
    changes = [
        Transition(Instruction(first, object_), Instruction(later, object_), Instruction(later, object_))
        for object_ in ObjectWord
        for first, later in permutations(actions, 2)
    ]
    return tuple(each for each in changes if each.scored not in NON_EXPERIENCED)


def object_transitions(condition: Condition) -> tuple[Transition, ...]:
    """All changes of the object word whose scored instruction was met, action by action."""
    actions = sorted({each.action for each in condition.instructions})
    changes = [
        Transition(Instruction(action, first), Instruction(action, later), Instruction(action, first))
        for action in actions
        for first, later in permutations(ObjectWord, 2)
    ]
    return tuple(each for each in changes if each.scored not in NON_EXPERIENCED)


def draw_transition_trials(
    transitions: tuple[Transition, ...], readings: Readings, rng: np.random.Generator
) -> Trials:
    """80 trials of each transition, 40 from each start area, transition after transition."""
    drawn = draw_trials([each.scored for each in transitions], TRIALS_PER_AREA, readings, rng)

    def words(instructions: list[Instruction]) -> tuple[NDArray, NDArray]:
        actions, objects = [each.action for each in instructions], [each.object for each in instructions]
        return np.repeat(actions, TRIALS), np.repeat(objects, TRIALS)

    first = words([each.before for each in transitions])
    later = words([each.after for each in transitions])
    delays = rng.integers(0, CHANGE_STEPS, len(drawn))
    return Trials(
        drawn.actions, drawn.objects, drawn.alpha, drawn.discs, LabelChanges(*first, *later, delays)
    )


def transition_successes(
    genotypes: NDArray[np.float64],
    transitions: tuple[Transition, ...],
    readings: Readings,
    rng: np.random.Generator,
) -> NDArray[np.int64]:
    """Successful trials of 80 of A genotypes in X transitions, [A, X]; all genotypes meet the same trials."""
    if not len(genotypes):
        return np.zeros((0, len(transitions)), np.int64)
    trials = draw_transition_trials(transitions, readings, rng)
    success = run_trials(genotypes, trials, readings).success
    return success.reshape(len(genotypes), len(transitions), TRIALS).sum(axis=2)


def passes(successes: NDArray[np.integer]) -> NDArray[np.bool_]:
    """Which agents [A] pass a test: more than 75 % in every transition of it."""
    return np.all(4 * successes > 3 * TRIALS, axis=1)
