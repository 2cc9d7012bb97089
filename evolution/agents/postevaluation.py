"""The paper's first test: the five best of each late generation on all nine instructions (section VII).

Every agent carries out every instruction in 80 trials of its own, 40 from each start area; an elite
that survives is another agent in each generation, as in the paper. The results stand beside the run,
`postevaluation/gen-004000-004099.npz`, part by part, written once.

Axes: G generations, 5 ranks, 9 instructions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import draw_trials, run_trials
from arm2d.records import brief
from evolution.runs.folder import RunFolder
from evolution.runs.history import History, check_array, check_range
from evolution.runs.storage import make_folder
from evolution.search.config import RunConfig
from evolution.search.evaluation import TRIALS_PER_AREA
from evolution.search.randomness import Purpose, generator
from evolution.search.settings import N_BEST

FOLDER: Final = "postevaluation"
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

    @property
    def agents(self) -> NDArray[np.int16]:
        """The same, agent by agent, [5 G, 9]."""
        return self.successes.reshape(-1, N_INSTRUCTIONS)


def late_spans(folder: RunFolder) -> list[range]:
    """The parts whose generations are post-evaluated: the last third of a run, 4000 to 5999 in the paper."""
    first = folder.config.settings.generations * 2 // 3
    return [range(max(span.start, first), span.stop) for span in folder.spans if span.stop > first]


def post_evaluate(folder: RunFolder, report: Callable[[int, int], None] | None = None) -> PostEvaluation:
    """Post-evaluate a finished run, or go on where it was left; what is there already is read.

    Args:
        folder: The run.
        report: Told after every part how many of how many are done.

    Raises:
        ValueError: If the run is not finished.
        DamagedFileError: If a part of the run, or of the results, is damaged.
    """
    spans = late_spans(folder)
    if len(folder.finished_spans()) < len(folder.spans):
        raise ValueError(f"{folder.path} is not finished; go on with: wordarm evolve")
    make_folder(folder.path / FOLDER)
    for done, span in enumerate(spans, 1):
        if not part_path(folder, span).exists():
            write_part(folder, span)
        if report:
            report(done, len(spans))
    return read_post_evaluation(folder)


def read_post_evaluation(folder: RunFolder) -> PostEvaluation:
    """The results of a run that was post-evaluated.

    Raises:
        ValueError: If it was not, or not to the end.
        DamagedFileError: If a part of the results is damaged.
    """
    parts = [read_part(folder, span) for span in late_spans(folder)]
    return PostEvaluation(
        generations=np.concatenate([each.generations for each in parts]),
        successes=np.concatenate([each.successes for each in parts]),
    )


def late_history(folder: RunFolder) -> History:
    """What is recorded of the generations that are post-evaluated.

    Raises:
        DamagedFileError: If a part of the run is damaged.
    """
    first = late_spans(folder)[0].start
    wanted = [span for span in folder.spans if span.stop > first]
    return History.join(folder.read_part(span)[max(first - span.start, 0) :] for span in wanted)


def progress(folder: RunFolder) -> tuple[int, int]:
    """How many parts of how many are there."""
    spans = late_spans(folder)
    return sum(part_path(folder, span).exists() for span in spans), len(spans)


def part_path(folder: RunFolder, span: range) -> Path:
    """Where the results of some generations are kept."""
    return folder.path / FOLDER / f"gen-{span.start:06d}-{span.stop - 1:06d}.npz"


def evaluate_agents(config: RunConfig, generation: int, genotypes: NDArray[np.float64]) -> NDArray[np.int16]:
    """Successes [5, 9] of a generation's best [5, 84], each agent in trials of its own."""
    rng = generator(config.seed, Purpose.POST_EVALUATION, generation)
    successes = np.empty((len(genotypes), N_INSTRUCTIONS), np.int16)
    for rank, genotype in enumerate(genotypes):
        trials = draw_trials(config.condition.instructions, TRIALS_PER_AREA, config.readings, rng)
        success = run_trials(genotype, trials, config.readings).success
        successes[rank] = success.reshape(N_INSTRUCTIONS, TRIALS).sum(axis=1)
    return successes


def write_part(folder: RunFolder, span: range) -> None:
    """Evaluate the agents of some generations and keep the results."""
    successes = [
        evaluate_agents(folder.config, generation, genotypes)
        for generation, genotypes in best_genotypes(folder, span)
    ]
    arrays = {"generations": np.array(span, np.int32), "successes": np.array(successes)}
    folder.write_arrays(part_path(folder, span), arrays)


def best_genotypes(folder: RunFolder, span: range) -> Iterator[tuple[int, NDArray[np.float64]]]:
    """(generation, its five best [5, 84]) of a span within one part of the run."""
    whole = next(each for each in folder.spans if span.start in each)
    history: History = folder.read_part(whole)
    for row in range(span.start - whole.start, span.stop - whole.start):
        yield int(history.generations[row]), history.best_genotypes[row]


def read_part(folder: RunFolder, span: range) -> PostEvaluation:
    """The results of some generations; raises as `read_post_evaluation`."""
    path = part_path(folder, span)
    if not path.exists():
        raise ValueError(f"{path} is missing; go on with: wordarm postevaluate {folder.path}")
    with folder.repairable(path):
        arrays = folder.read_arrays(path)
        check_array(path, arrays, "generations", (len(span),), np.dtype(np.int32))
        check_array(path, arrays, "successes", (len(span), N_BEST, N_INSTRUCTIONS), np.dtype(np.int16))
        check_range(path, arrays, "generations", span.start, span.stop - 1)
        check_range(path, arrays, "successes", 0, TRIALS)
    return PostEvaluation(arrays["generations"], arrays["successes"])
