"""The tests of a run's late agents on a device; files as of `evolution.agents`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from arm2d import draw_trials
from arm2d.device.opening import PROCESSOR, check_name, open_device
from evolution.agents.parts import best_genotypes
from evolution.agents.postevaluation import (
    N_INSTRUCTIONS,
    POST_EVALUATION,
    TRIALS,
    PostEvaluation,
    post_evaluate,
)
from evolution.agents.solving import (
    file_path,
    keep_solved_trials,
    read_solved_trials,
    solved_trials,
)
from evolution.agents.transitions import (
    TRANSITION_TEST,
    Candidates,
    Successes,
    TransitionTest,
    both_transitions,
    draw_transition_trials,
    run_transition_test,
    transition_results,
)
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_histories
from evolution.search.config import RunConfig
from evolution.search.evaluation import TRIALS_PER_AREA
from evolution.search.randomness import Purpose, generator
from evolution.search.scoring import trials_of
from evolution.search.settings import N_BEST

if TYPE_CHECKING:
    from arm2d.device.groups import Group, Laboratory

Report = Callable[[int, int], None]


@dataclass(frozen=True)
class LateTests:
    """The paper's tests of a run, and what else is counted of its trials, wherever they are run.

    Attributes:
        instructions: As `post_evaluate`,
        transitions: as `run_transition_test`,
        solved: as `solved_trials`.
    """

    instructions: Callable[..., object]
    transitions: Callable[..., object]
    solved: Callable[..., object]


def tests_on(device: str) -> LateTests:
    """The tests on a device of this name, which may be the processor.

    Raises:
        ValueError: If there is no such device.
    """
    if check_name(device) == PROCESSOR:
        return LateTests(post_evaluate, run_transition_test, solved_trials)
    laboratory = laboratory_on(device)
    return LateTests(
        partial(post_evaluate_on, laboratory),
        partial(transition_test_on, laboratory),
        partial(solved_trials_on, laboratory),
    )


def laboratory_on(device: str) -> Laboratory:
    """A device of this process; raises ValueError if there is none."""
    opened = open_device(device)
    from arm2d.device.groups import Laboratory

    return Laboratory(opened)


def post_evaluate_on(laboratory: Laboratory, run: RunFolder, report: Report | None = None) -> PostEvaluation:
    """As `post_evaluate`; raises DeviceLostError too, what was written being whole."""
    return replace(POST_EVALUATION, test=lambda run, span: _post_evaluated(laboratory, run, span)).complete(
        run, report
    )


def transition_test_on(
    laboratory: Laboratory, run: RunFolder, report: Report | None = None
) -> TransitionTest:
    """As `run_transition_test`; raises DeviceLostError too, what was written being whole."""
    tests = partial(both_tests_on, laboratory)
    return replace(TRANSITION_TEST, test=lambda run, span: transition_results(run, span, tests)).complete(
        run, report
    )


def both_tests_on(
    laboratory: Laboratory, config: RunConfig, candidates: Sequence[Candidates]
) -> list[Successes]:
    """As `both_tests`, all generations in one batch for each test; raises DeviceLostError too."""
    from arm2d.device.groups import Group

    tested = [each for each in candidates if len(each.ranks)]
    draws = [generator(config.seed, Purpose.TRANSITIONS, each.generation) for each in tested]
    successes = []  # [tested, 5, X] of each test
    for changes in both_transitions(config.papers_condition):
        groups = [
            Group(each.best, draw_transition_trials(changes, config.readings, rng), config.readings)
            for each, rng in zip(tested, draws, strict=True)
        ]
        success = np.array(laboratory.success(groups))
        successes.append(success.reshape(len(groups), N_BEST, len(changes), TRIALS).sum(axis=-1))
    action, object_ = successes
    place = {each.generation: number for number, each in enumerate(tested)}

    def of(candidate: Candidates) -> Successes:
        """What was found of a generation's candidates, if it had any."""
        number = place.get(candidate.generation)
        if number is None:
            return action[:0, 0], object_[:0, 0]
        return action[number, candidate.ranks], object_[number, candidate.ranks]

    return [of(each) for each in candidates]


def solved_trials_on(laboratory: Laboratory, run: RunFolder) -> NDArray[np.int16]:
    """As `solved_trials`; raises DeviceLostError too."""
    from arm2d.device.groups import Group

    if file_path(run).exists():
        return read_solved_trials(run)
    solved = []
    for history in recorded_histories(run):
        groups = [
            Group(genotypes, trials_of(run.config, int(generation))[0], run.config.readings)
            for generation, genotypes in zip(history.generations, history.best_genotypes, strict=True)
        ]
        success = np.array(laboratory.success(groups))  # [generations, 5, trials]
        solved.append(success.sum(axis=-1, dtype=np.int16).max(axis=-1))
    keep_solved_trials(run, np.concatenate(solved))
    return read_solved_trials(run)


def _post_evaluated(laboratory: Laboratory, run: RunFolder, span: range) -> PostEvaluation:
    """The agents of some generations in one batch, each in trials of its own."""
    groups = [own_trials(run.config, *best) for best in best_genotypes(run, span)]
    success = np.array(laboratory.success(groups)).reshape(len(span), N_BEST, N_INSTRUCTIONS, TRIALS)
    return PostEvaluation(np.array(span, np.int32), success.sum(axis=-1, dtype=np.int16))


def own_trials(config: RunConfig, generation: int, genotypes: NDArray[np.float64]) -> Group:
    """The best of a generation with the trials that `successes_by_area` gives each of them."""
    from arm2d.device.groups import Group

    rng = generator(config.seed, Purpose.POST_EVALUATION, generation)
    # Drawn at once, which gives the numbers that drawing for one agent after the other gives.
    instructions = config.condition.instructions * len(genotypes)
    trials = draw_trials(instructions, TRIALS_PER_AREA, config.readings, rng, config.condition)
    return Group(genotypes, trials, config.readings, each_own=True)
