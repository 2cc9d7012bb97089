"""The paper's second test: the instruction changes in mid-trial (section VII, Fig. 4; spec section 10).

Action transition (a1 -> a2, object o): scores follow a2 on o. Object transition (o1 -> o2, action a):
scores follow a on o1. Transitions whose scored instruction was never met are left out. An agent passes
a test if every transition of it succeeds in more than 60 of 80 trials.

Those of a run's late agents that belong to a class are tested, and the results kept beside the run. Axes:
A agents, X transitions of a test.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import permutations
from pathlib import Path
from typing import Final, NamedTuple

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
from arm2d.records import alike, brief
from evolution.agents.parts import LateTest, best_genotypes, joined
from evolution.agents.postevaluation import POST_EVALUATION, TRIALS
from evolution.agents.subtasks import AgentClass, classify, usually
from evolution.runs.folder import AnyRun, RunFolder
from evolution.runs.history import check_array, check_range
from evolution.search.config import RunConfig
from evolution.search.evaluation import TRIALS_PER_AREA
from evolution.search.randomness import Purpose, generator
from evolution.search.settings import N_BEST

# The change comes at one of so many steps, from the first after which the target is in view.
CHANGE_STEPS: Final = 10
CLASSES: Final = tuple(AgentClass)


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


@dataclass(frozen=True)
class TransitionTest:
    """Successful trials, of 80, in every transition.

    Attributes:
        generations: [A] and
        ranks: [A], which agents.
        classes: [A], index into `CLASSES`.
        action: [A, X], in the order of `action_transitions`.
        object: [A, X], in the order of `object_transitions`.
    """

    generations: NDArray[np.int32]
    ranks: NDArray[np.int8]
    classes: NDArray[np.int8]
    action: NDArray[np.int16]
    object: NDArray[np.int16]

    __repr__ = brief
    __eq__ = alike


def action_transitions(condition: Condition) -> tuple[Transition, ...]:
    """All changes of the action word whose scored instruction was met, object by object."""
    actions = sorted({word.action for word in condition.instructions})
    changes = [
        Transition(Instruction(first, object_), Instruction(later, object_), Instruction(later, object_))
        for object_ in ObjectWord
        for first, later in permutations(actions, 2)
    ]
    return tuple(change for change in changes if change.scored not in NON_EXPERIENCED)


def object_transitions(condition: Condition) -> tuple[Transition, ...]:
    """All changes of the object word whose scored instruction was met, action by action."""
    actions = sorted({word.action for word in condition.instructions})
    changes = [
        Transition(Instruction(action, first), Instruction(action, later), Instruction(action, first))
        for action in actions
        for first, later in permutations(ObjectWord, 2)
    ]
    return tuple(change for change in changes if change.scored not in NON_EXPERIENCED)


def draw_transition_trials(
    transitions: tuple[Transition, ...], readings: Readings, rng: np.random.Generator
) -> Trials:
    """80 trials of each transition, 40 from each start area, transition after transition."""
    drawn = draw_trials([transition.scored for transition in transitions], TRIALS_PER_AREA, readings, rng)

    def words(instructions: list[Instruction]) -> tuple[NDArray, NDArray]:
        actions, objects = [word.action for word in instructions], [word.object for word in instructions]
        return np.repeat(actions, TRIALS), np.repeat(objects, TRIALS)

    first = words([transition.before for transition in transitions])
    later = words([transition.after for transition in transitions])
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
    return np.all(usually(successes), axis=1)


class Candidates(NamedTuple):
    """Those of a generation's five best that are to be tested.

    Attributes:
        generation: Its number.
        best: The five, [5, 84].
        ranks: Whom of them, [A].
    """

    generation: int
    best: NDArray[np.float64]
    ranks: NDArray[np.int64]


# Successes in the action and in the object transitions, [A, X] each.
Successes = tuple[NDArray[np.int64], NDArray[np.int64]]
# Carries out both tests for the candidates of some generations.
BothTests = Callable[[RunConfig, Sequence[Candidates]], list[Successes]]


def both_tests(config: RunConfig, candidates: Sequence[Candidates]) -> list[Successes]:
    """Both tests of each generation's candidates, who meet the same trials."""
    actions, objects = both_transitions(config.papers_condition)
    found = []
    for generation, best, ranks in candidates:
        rng = generator(config.seed, Purpose.TRANSITIONS, generation)
        action = transition_successes(best[ranks], actions, config.readings, rng)
        found.append((action, transition_successes(best[ranks], objects, config.readings, rng)))
    return found


def both_transitions(condition: Condition) -> tuple[tuple[Transition, ...], tuple[Transition, ...]]:
    """Those of the action word, and those of the object word."""
    return action_transitions(condition), object_transitions(condition)


def transition_results(run: RunFolder, span: range, tests: BothTests = both_tests) -> TransitionTest:
    """The classed agents of some generations, tested."""
    evaluated = POST_EVALUATION.read_part(run, span).successes
    candidates, classes = [], []
    for (generation, best), successes in zip(best_genotypes(run, span), evaluated, strict=True):
        own = np.full(len(best), -1, np.int8)
        for index, members in enumerate(classify(successes, run.config.papers_condition).values()):
            own[members] = index
        candidates.append(Candidates(generation, best, np.flatnonzero(own >= 0)))
        classes.append(own)
    results = [
        TransitionTest(
            generations=np.full(len(ranks), generation, np.int32),
            ranks=ranks.astype(np.int8),
            classes=own[ranks],
            action=action.astype(np.int16),
            object=object_.astype(np.int16),
        )
        for (generation, _, ranks), own, (action, object_) in zip(
            candidates, classes, tests(run.config, candidates), strict=True
        )
    ]
    return joined(TransitionTest, results)


def _check(path: Path, arrays: Mapping[str, NDArray], run: RunFolder, span: range) -> None:
    """Refuse arrays that no transition test gives."""
    condition = run.config.papers_condition
    n = np.size(arrays.get("generations", ()))
    shapes = {
        "generations": ((n,), np.int32),
        "ranks": ((n,), np.int8),
        "classes": ((n,), np.int8),
        "action": ((n, len(action_transitions(condition))), np.int16),
        "object": ((n, len(object_transitions(condition))), np.int16),
    }
    for name, (shape, dtype) in shapes.items():
        check_array(path, arrays, name, shape, np.dtype(dtype))
    check_range(path, arrays, "generations", span.start, span.stop - 1)
    check_range(path, arrays, "ranks", 0, N_BEST - 1)
    check_range(path, arrays, "classes", 0, len(CLASSES) - 1)
    for name in ("action", "object"):
        check_range(path, arrays, name, 0, TRIALS)


TRANSITION_TEST: Final = LateTest("transitions", TransitionTest, transition_results, _check)


def run_transition_test(run: AnyRun, report: Callable[[int, int], None] | None = None) -> TransitionTest:
    """Test a post-evaluated run, or go on where it was left; what is there already is read.

    Args:
        run: The run, or the path of its folder.
        report: Told after every part how many of how many are done.

    Raises:
        ValueError: If there is no such run, or it is not post-evaluated.
        DamagedFileError: If a file is damaged.
    """
    return TRANSITION_TEST.complete(RunFolder.open(run), report)
