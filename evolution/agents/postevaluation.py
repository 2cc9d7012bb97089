"""The paper's first test: the five best of each late generation on all nine instructions (section VII).

Every agent carries out every instruction in 80 trials of its own, 40 from each start area; an elite
that survives is another agent in each generation, as in the paper.

Axes: G generations, 5 ranks, 9 instructions.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import draw_trials, run_trials
from arm2d.records import alike, brief
from evolution.agents.parts import LateTest, best_genotypes
from evolution.runs.folder import AnyRun, RunFolder
from evolution.runs.history import check_array, check_range
from evolution.search.config import RunConfig
from evolution.search.evaluation import TRIALS_PER_AREA
from evolution.search.randomness import Purpose, generator
from evolution.search.settings import N_BEST

N_INSTRUCTIONS: Final = 9
TRIALS: Final = 2 * TRIALS_PER_AREA


@dataclass(frozen=True)
class PostEvaluation:
    """Successful trials, of 80, of the five best of generations in a row.

    Attributes:
        generations: [G].
        successes: [G, 5, 9], in the order of the condition's instructions.
    """

    generations: NDArray[np.int32]
    successes: NDArray[np.int16]

    __repr__ = brief
    __eq__ = alike

    @property
    def agents(self) -> NDArray[np.int16]:
        """The same, agent by agent, [5 G, 9]."""
        return self.successes.reshape(-1, N_INSTRUCTIONS)


def successes_by_area(
    config: RunConfig, generation: int, genotypes: NDArray[np.float64]
) -> NDArray[np.int16]:
    """Successes [5, 9, 2] of a generation's best [5, 84], each agent in trials of its own.

    There are 40 trials of each instruction from the right and 40 from the left area. Tasks that are not the
    paper's are asked for all their instructions, which may be more than nine.
    """
    instructions = config.condition.instructions
    rng = generator(config.seed, Purpose.POST_EVALUATION, generation)
    successes = np.empty((len(genotypes), len(instructions), 2), np.int16)
    for rank, genotype in enumerate(genotypes):
        trials = draw_trials(instructions, TRIALS_PER_AREA, config.readings, rng, config.condition)
        success = run_trials(genotype, trials, config.readings).success
        successes[rank] = success.reshape(len(instructions), 2, TRIALS_PER_AREA).sum(axis=-1)
    return successes


def _test(run: RunFolder, span: range) -> PostEvaluation:
    """The agents of some generations, evaluated."""
    successes = [
        successes_by_area(run.config, generation, genotypes).sum(axis=-1, dtype=np.int16)
        for generation, genotypes in best_genotypes(run, span)
    ]
    return PostEvaluation(np.array(span, np.int32), np.array(successes))


def _check(path: Path, arrays: Mapping[str, NDArray], run: RunFolder, span: range) -> None:
    """Refuse arrays that no post-evaluation gives."""
    check_array(path, arrays, "generations", (len(span),), np.dtype(np.int32))
    check_array(path, arrays, "successes", (len(span), N_BEST, N_INSTRUCTIONS), np.dtype(np.int16))
    check_range(path, arrays, "generations", span.start, span.stop - 1)
    check_range(path, arrays, "successes", 0, TRIALS)


POST_EVALUATION: Final = LateTest("postevaluation", PostEvaluation, _test, _check)


def post_evaluate(run: AnyRun, report: Callable[[int, int], None] | None = None) -> PostEvaluation:
    """Post-evaluate a finished run, or go on where it was left; what is there already is read.

    Args:
        run: The run, or the path of its folder.
        report: Told after every part how many of how many are done.

    Raises:
        ValueError: If there is no such run, it is not finished, or it is of another task than the paper's.
        DamagedFileError: If a part of the run, or of the results, is damaged.
    """
    return POST_EVALUATION.complete(RunFolder.open(run), report)
