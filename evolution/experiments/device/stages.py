"""The stages of many runs on a device, as processes of an experiment carry them out.

Whoever takes the place of a process that lost its device goes on at the checkpoints it left.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from arm2d.device.errors import DeviceLostError
from evolution.answers import DEVICE_LOST, INTERRUPTED
from evolution.experiments.device.batch import BatchResult, evolve_together
from evolution.experiments.device.late_tests import laboratory_on, tests_on
from evolution.experiments.device.scoring import DeviceScoring
from evolution.runs.champion import keep_champions
from evolution.runs.folder import RunFolder
from evolution.runs.interrupt import StopRequest
from evolution.runs.lock import locked
from evolution.runs.run import Watcher
from evolution.search.config import RunConfig


def evolve_batch(device: str, runs: Sequence[tuple[str, Mapping[str, Any]]]) -> int:
    """Start runs, or go on with them, together; what they say goes to the log.

    Args:
        device: Its name.
        runs: Folder and `RunConfig.to_mapping` of each.

    Returns:
        130 if told to stop before all last generations, DEVICE_LOST if the device was lost on the way.

    Raises:
        ValueError: If there is no such device or it has too little memory, or at the end with what kept
            single runs from going on.
    """
    configs = {Path(folder): RunConfig.from_mapping(config) for folder, config in runs}
    scoring = DeviceScoring(laboratory_on(device))
    print(f"runs together on {device} ({scoring.laboratory.device.model}): {len(configs)}", flush=True)
    with StopRequest() as stop:
        watcher = Watcher(
            on_note=lambda note: print(note, file=sys.stderr),
            wants_stop=lambda: stop.requested or scoring.failure is not None,
            choose_champions=lambda folder: keep_champions(folder, scoring.run_trials),
        )
        result = evolve_together(configs, scoring.fitness, watcher)
    return _exit_code(result, configs, scoring, stop)


def _exit_code(
    result: BatchResult, configs: Mapping[Path, RunConfig], scoring: DeviceScoring, stop: StopRequest
) -> int:
    """What is to be answered; raises ValueError with what is wrong with single runs."""
    ended = [n == configs[path].settings.generations for path, n in result.generations.items()]
    print(f"{sum(ended)} of {len(configs)} runs have come to their end", flush=True)
    if result.troubles:
        raise ValueError("; ".join(result.troubles.values()))
    if isinstance(scoring.failure, DeviceLostError) and not stop.requested:
        print(scoring.failure, file=sys.stderr)
        return DEVICE_LOST
    if scoring.failure is not None:
        raise scoring.failure
    return 0 if all(ended) else INTERRUPTED


def test_runs_on(device: str, folders: Sequence[str]) -> int:
    """Carry out the paper's two tests of finished runs on a device, or what is left of them.

    Args:
        device: Its name.
        folders: Of the runs.
    """
    tests = tests_on(device)

    def test(run: RunFolder) -> None:
        """All that follows evolution."""
        tests.instructions(run)
        tests.transitions(run)
        tests.solved(run)

    return one_by_one(folders, test)


def one_by_one(folders: Sequence[str], work: Callable[[RunFolder], None]) -> int:
    """Do some work on a device for run after run; one that it cannot be done for does not hold up the others.

    Args:
        folders: Of the runs.
        work: For one of them.

    Returns:
        DEVICE_LOST if the device was lost on the way.

    Raises:
        ValueError: At the end, with what kept it from being done for single runs.
    """
    troubles = []
    for folder in folders:
        try:
            run = RunFolder.open(Path(folder))
            with locked(run.path):
                work(run)
        except DeviceLostError as error:
            print(error, file=sys.stderr)
            return DEVICE_LOST
        except (ValueError, OSError) as error:
            troubles.append(str(error))
    if troubles:
        raise ValueError("; ".join(troubles))
    return 0
