"""The agents a run is remembered by.

Fitness within a generation rests on 28 trials, so the best of a generation is often just the
luckiest. A run's champions are therefore chosen anew, among the distinct genotypes that were one of
the five best in one of its last 100 generations: each carries out every *experienced* instruction
80 times, and they are ordered by

    1. the number of successes of the instruction they are worst at,
    2. the number of successes altogether,
    3. mean fitness,
    4. the later generation, then the better rank in it.

The instructions never met take no part in the choice. What champions make of all nine is measured
afterwards, in other trials, so that the choice does not flatter the numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import TrialScores, run_trials
from arm2d.records import alike, brief
from evolution.runs.folder import CHAMPIONS, RunFolder
from evolution.runs.history import History
from evolution.search.algorithm import mean_in_order
from evolution.search.config import RunConfig
from evolution.search.evaluation import TRIALS_PER_AREA, evaluate
from evolution.search.randomness import Purpose, generator
from evolution.search.scoring import draw_evolution_trials
from evolution.search.settings import N_BEST

LAST_GENERATIONS: Final = 100
N_CHAMPIONS: Final = 5


@dataclass(frozen=True)
class Candidates:
    """C distinct genotypes and where each was seen last.

    Attributes:
        genotypes: [C, G].
        generations: [C].
        ranks: [C], 0 for the best of the generation.
    """

    genotypes: NDArray[np.float64]
    generations: NDArray[np.int64]
    ranks: NDArray[np.int64]

    __repr__ = brief
    __eq__ = alike

    def __getitem__(self, index: NDArray[np.int64]) -> Candidates:
        return Candidates(self.genotypes[index], self.generations[index], self.ranks[index])


def find_candidates(history: History) -> Candidates:
    """The distinct best genotypes of a history, the latest first."""
    genotypes = history.best_genotypes[::-1].reshape(-1, history.best_genotypes.shape[-1])
    generations = np.repeat(history.generations[::-1].astype(np.int64), N_BEST)
    ranks = np.tile(np.arange(N_BEST), len(history))
    _, first = np.unique(genotypes, axis=0, return_index=True)
    return Candidates(genotypes, generations, ranks)[np.sort(first)]


def choose_champions(
    candidates: Candidates, config: RunConfig, run: Callable[..., TrialScores] = run_trials
) -> tuple[Candidates, NDArray[np.int64]]:
    """The best candidates in fresh trials of the experienced instructions, and their successes [C, 7].

    Trials are run by `arm2d.run_trials` or its like.
    """
    condition, readings = config.condition, config.readings
    rng = generator(config.seed, Purpose.CHAMPION, config.settings.generations)
    trials = draw_evolution_trials(condition.experienced, condition, TRIALS_PER_AREA, readings, rng)
    scores = run(candidates.genotypes, trials, readings)
    successes = scores.success.reshape(len(scores.success), len(condition.experienced), -1).sum(axis=-1)
    fitness = mean_in_order(scores.fitness)
    # The last key counts most; lexsort is stable, so equals stay in the order of `find_candidates`.
    order = np.lexsort((-fitness, -successes.sum(axis=1), -successes.min(axis=1)))[:N_CHAMPIONS]
    return candidates[order], successes[order]


def keep_champions(folder: RunFolder, run: Callable[..., TrialScores] = run_trials) -> None:
    """Choose the champions of a finished run and write champions.npz."""
    history = History.join(folder.read_part(span) for span in folder.spans[-2:])
    folder.write_arrays(folder.path / CHAMPIONS, champion_arrays(history, folder.config, run))


def champion_arrays(
    history: History, config: RunConfig, run: Callable[..., TrialScores] = run_trials
) -> dict[str, NDArray]:
    """The arrays of champions.npz, from at least the last 100 generations of a run, or from all it has."""
    champions, successes = choose_champions(find_candidates(history[-LAST_GENERATIONS:]), config, run)
    result = evaluate(champions.genotypes, config.condition, config.readings)
    return {
        "genotypes": champions.genotypes,
        "generations": champions.generations,
        "ranks": champions.ranks,
        "chosen_by_successes": successes,
        "instructions": np.array([str(each) for each in config.condition.instructions]),
        "trials_per_instruction": np.array(result.trials),
        "successes": result.successes.sum(axis=-1),
        "fitness": result.fitness,
        "config": np.array(config.to_toml()),
    }
