"""The jobs of an experiment whose trials a device runs: batches of runs, each in a process of its own.

A process breeds and writes the runs of its batch, one after the other, and has the device score a generation
of all of them at once. Several such processes share a device: while one breeds, the others' trials run.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from arm2d import Condition
from arm2d.constants import N_INTER
from arm2d.device.errors import DeviceSizeError, DeviceTaskError
from arm2d.device.opening import CUDA, PROCESSOR, check_name, cuda_names, open_device
from evolution.child import reference
from evolution.experiments.device.stages import evolve_batch, test_runs_on
from evolution.experiments.plan import EVOLVING, LOGS, TESTING
from evolution.experiments.workers import Job
from evolution.search.config import RunConfig

# Chosen, not measured: each holds some 0.5 GB of the device for itself, and breeds on one core.
PROCESSES_PER_DEVICE: Final = 8
# What a process is told must fit into one message, and into a word of a command line (Linux: 128 KiB).
MOST_RUNS: Final = 128
LONGEST_WORD: Final = 100_000  # [bytes]
# Whoever is lost in the middle leaves so many to be tested again at most; starting takes a second.
MOST_RUNS_TESTED: Final = 8


def device_shares(name: str, asked: int | None, threads_there: int | None = None) -> DeviceShares | None:
    """How runs share the device that a command is given; None if that is the processor.

    Args:
        name: What `--device` says.
        asked: Processes that are to share it, if the user says how many.
        threads_there: On a cluster, how many jobs it does at once; each worker has devices of its own.

    Raises:
        ValueError: In one sentence, if there is no such device.
    """
    if check_name(name) == PROCESSOR:
        return None
    if threads_there is not None:
        return DeviceShares((name,), threads_there)
    open_device(name)
    names = tuple(cuda_names()) if name == CUDA else (name,)
    most = min(len(os.sched_getaffinity(0)), PROCESSES_PER_DEVICE * len(names))
    return DeviceShares(names, asked or most)


def check_device(name: str, configs: Iterable[RunConfig]) -> None:
    """Refuse a device that has no such name, and runs that it cannot do, before anything is begun or written.

    Raises:
        ValueError: If the name is none, or a device does not know the task or network of a run.
    """
    if check_name(name) == PROCESSOR:
        return
    for config in configs:
        if not isinstance(config.condition, Condition):
            raise DeviceTaskError(config.condition)
        if config.settings.inter_neurons != N_INTER:
            raise DeviceSizeError(config.settings.inter_neurons)


@dataclass(frozen=True)
class DeviceShares:
    """How runs share one device, or several.

    Attributes:
        devices: Their names; the batches take them in turn.
        processes: That share them, all together.
        runs_at_once: So many are evolved and tested before others are begun; by default all at once, which is
            fastest.
    """

    devices: tuple[str, ...]
    processes: int
    runs_at_once: int | None = None

    def waves(self, chains: Sequence[Sequence[Job]]) -> list[Sequence[Sequence[Job]]]:
        """The stages of as many runs as are done at once, and then of others."""
        size = self.runs_at_once or max(len(chains), 1)
        return [chains[first : first + size] for first in range(0, len(chains), size)]

    def batches(self, chains: Sequence[Sequence[Job]], folder: Path) -> list[list[Job]]:
        """Jobs that evolve what is not evolved yet, runs that follow each other in one batch.

        Args:
            chains: The stages of runs, as `Plan.chains` gives them.
            folder: Of the experiment.
        """
        evolving = [chain[0] for chain in chains if chain[0].stage == EVOLVING]
        longest = max((len(json.dumps(job.arguments).encode()) for job in evolving), default=1)
        most = max(1, min(MOST_RUNS, LONGEST_WORD // longest))
        n = max(min(self.processes, len(evolving)), -(-len(evolving) // most))
        return [[self._batch(evolving, number, n, folder)] for number in range(n)]

    def later(self, chains: Sequence[Sequence[Job]], folder: Path) -> list[list[Job]]:
        """What follows evolution: on the device, some runs to a process, what it can do.

        Args:
            chains: As those of `batches`.
            folder: Of the experiment.
        """
        jobs = [job for chain in chains if chain[0].stage != EVOLVING for job in chain]
        tests = reference(test_runs_on)
        by_function: dict[str, list[Job]] = {}
        for job in jobs:
            function = job.on_device or (tests if job.stage == TESTING else "")
            by_function.setdefault(function, []).append(job)
        there = by_function.pop("", [])
        return [
            *([job] for job in there),
            *([each] for it, alike in by_function.items() for each in self._together(it, alike, folder)),
        ]

    def _together(self, function: str, jobs: Sequence[Job], folder: Path) -> list[Job]:
        """Jobs that one function does, some runs to a process."""
        n = max(min(self.processes, len(jobs)), -(-len(jobs) // MOST_RUNS_TESTED))
        shared_out = [jobs[len(jobs) * i // n : len(jobs) * (i + 1) // n] for i in range(n)]
        return [
            replace(
                own[0],
                name=_name_of(own),
                function=function,
                arguments={
                    "device": self._device(number),
                    "folders": [job.arguments["folder"] for job in own],
                },
                folder=folder,
                runs=tuple(job.name for job in own),
            )
            for number, own in enumerate(shared_out)
        ]

    def _batch(self, evolving: Sequence[Job], number: int, n: int, folder: Path) -> Job:
        """Job `number` of n."""
        first, last = (len(evolving) * each // n for each in (number, number + 1))
        jobs = evolving[first:last]
        arguments = {
            "device": self._device(number),
            "runs": [(job.arguments["folder"], job.arguments["config"]) for job in jobs],
        }
        log = folder / LOGS / f"batch-{number + 1:03d}-of-{n:03d}.log"
        names = tuple(job.name for job in jobs)
        return Job(_name_of(jobs), EVOLVING, reference(evolve_batch), arguments, folder, log, names)

    def _device(self, number: int) -> str:
        return self.devices[number % len(self.devices)]


def _name_of(jobs: Sequence[Job]) -> str:
    """What a process for some runs is called."""
    return jobs[0].name + (f" and {len(jobs) - 1} more" if len(jobs) > 1 else "")
