"""The tests of a run's late agents on a device; files as of `evolution.agents`."""

from __future__ import annotations

from collections.abc import Callable
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
    trials_of,
)
from evolution.agents.transitions import (
    TRANSITION_TEST,
    TransitionTest,
    run_transition_test,
    transition_results,
)
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_histories
from evolution.search.evaluation import TRIALS_PER_AREA
from evolution.search.randomness import Purpose, generator
from evolution.search.settings import N_BEST

if TYPE_CHECKING:
    from arm2d.device.groups import Laboratory

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
    return replace(
        TRANSITION_TEST, test=lambda run, span: transition_results(run, span, laboratory.run_trials)
    ).complete(run, report)


def solved_trials_on(laboratory: Laboratory, run: RunFolder) -> NDArray[np.int16]:
    """As `solved_trials`; raises DeviceLostError too."""
    from arm2d.device.groups import Group

    if file_path(run).exists():
        return read_solved_trials(run)
    solved = []
    for history in recorded_histories(run):
        groups = [
            Group(genotypes, trials_of(run.config, int(generation)), run.config.readings)
            for generation, genotypes in zip(history.generations, history.best_genotypes, strict=True)
        ]
        solved.append(laboratory.success(groups).sum(axis=-1, dtype=np.int16).max(axis=-1))
    keep_solved_trials(run, np.concatenate(solved))
    return read_solved_trials(run)


def _post_evaluated(laboratory: Laboratory, run: RunFolder, span: range) -> PostEvaluation:
    """The agents of some generations in one batch, each in trials of its own."""
    from arm2d.device.groups import Group

    config, groups = run.config, []
    for generation, genotypes in best_genotypes(run, span):
        rng = generator(config.seed, Purpose.POST_EVALUATION, generation)
        for genotype in genotypes:
            trials = draw_trials(config.condition.instructions, TRIALS_PER_AREA, config.readings, rng)
            groups.append(Group(genotype[np.newaxis], trials, config.readings))
    success = laboratory.success(groups).reshape(len(span), N_BEST, N_INSTRUCTIONS, TRIALS)
    return PostEvaluation(np.array(span, np.int32), success.sum(axis=-1, dtype=np.int16))
