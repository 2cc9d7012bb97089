"""How many of its 28 trials each generation's best carried out (Fig. 3 tells fitness only)."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import run_trials
from evolution.agents.postevaluation import POST_EVALUATION
from evolution.runs.folder import RunFolder
from evolution.runs.history import check_array, check_range
from evolution.runs.recorded import recorded_histories
from evolution.runs.storage import make_folder
from evolution.search.config import RunConfig
from evolution.search.scoring import first_genotypes_trials

FILE: Final = "solved.npz"


def solved_trials(folder: RunFolder) -> NDArray[np.int16]:
    """Most trials that one of the five best carried out, [G]; computed once and kept.

    The trials are those the generation was scored in; under the reading that gives each genotype
    starts of its own, they are the first genotype's.

    Raises:
        DamagedFileError: If a file of the run is damaged.
    """
    if file_path(folder).exists():
        return read_solved_trials(folder)
    return write_solved_trials(folder)


def read_solved_trials(folder: RunFolder) -> NDArray[np.int16]:
    """The same of a run for which it was computed.

    Raises:
        DamagedFileError: If the file is damaged.
    """
    path = file_path(folder)
    with folder.repairable(path):
        arrays = folder.read_arrays(path)
        check_array(path, arrays, "solved", (folder.config.settings.generations,), np.dtype(np.int16))
        check_range(path, arrays, "solved", 0, n_trials(folder.config))
    return arrays["solved"]


def write_solved_trials(folder: RunFolder) -> NDArray[np.int16]:
    """Compute it and keep it."""
    solved = np.array(
        [
            _most_carried_out(genotypes, folder.config, int(generation))
            for history in recorded_histories(folder)
            for generation, genotypes in zip(history.generations, history.best_genotypes, strict=True)
        ],
        np.int16,
    )
    keep_solved_trials(folder, solved)
    return solved


def keep_solved_trials(folder: RunFolder, solved: NDArray[np.int16]) -> None:
    """Keep what was computed."""
    make_folder(file_path(folder).parent)
    folder.write_arrays(file_path(folder), {"solved": solved})


def all_solved(folder: RunFolder) -> NDArray[np.bool_]:
    """In which generations one genotype carried out all its trials, [G]; raises as `solved_trials`."""
    return solved_trials(folder) == n_trials(folder.config)


def n_trials(config: RunConfig) -> int:
    """Trials in which every genotype of a generation is scored, 28 in the paper."""
    return len(config.condition.experienced) * 2 * config.settings.trials_per_area


def file_path(folder: RunFolder) -> Path:
    """Where it is kept."""
    return folder.path / POST_EVALUATION.folder / FILE


def _most_carried_out(genotypes: NDArray[np.float64], config: RunConfig, generation: int) -> int:
    trials = first_genotypes_trials(config, generation)
    return int(run_trials(genotypes, trials, config.readings).success.sum(axis=1).max())
