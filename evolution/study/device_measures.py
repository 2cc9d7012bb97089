"""The measures of runs whose trials a device carries out; the files are those that the processor writes."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from evolution.agents.postevaluation import N_INSTRUCTIONS
from evolution.experiments.device.late_tests import (
    both_tests_on,
    laboratory_on,
    own_trials,
    solved_trials_on,
)
from evolution.experiments.device.stages import one_by_one
from evolution.runs.folder import RunFolder
from evolution.search.evaluation import TRIALS_PER_AREA
from evolution.search.settings import N_BEST
from evolution.study.late_transitions import passed_transitions
from evolution.study.measures import measure, sampled_best

if TYPE_CHECKING:
    from arm2d.device.groups import Laboratory


def measure_on(device: str, folders: Sequence[str]) -> int:
    """Measure runs, and test their late agents with words that change, in a process of its own.

    Args:
        device: Its name.
        folders: Of the runs.
    """
    laboratory = laboratory_on(device)
    return one_by_one(folders, partial(_measure, laboratory))


def _measure(laboratory: Laboratory, run: RunFolder) -> None:
    solved_trials_on(laboratory, run)
    measures = measure(run, partial(simulated_on, laboratory))
    passed_transitions(run, measures, partial(both_tests_on, laboratory))


def simulated_on(laboratory: Laboratory, run: RunFolder) -> NDArray[np.int16]:
    """As `measures.simulated`; raises DeviceLostError too."""
    groups = [own_trials(run.config, *best) for best in sampled_best(run)]
    success = np.array(laboratory.success(groups))  # [L, 5, 720]
    by_area = success.reshape(len(groups), N_BEST, N_INSTRUCTIONS, 2, TRIALS_PER_AREA)
    return by_area.sum(axis=-1, dtype=np.int16)
