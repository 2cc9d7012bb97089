"""The stages of `benchmarks.device`; every row says what was done and what was found."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition, Readings, draw_trials, run_trials
from arm2d.device.opening import Device
from benchmarks.device_facts import facts_of, kernel_seconds
from benchmarks.device_work import (
    AGENTS_OF_A_PART,
    agents_on_a_core,
    agents_on_a_device,
    generations_on_a_core,
    rate_of_all,
)
from evolution.experiments.device.jobs import DeviceShares
from evolution.experiments.device.late_tests import laboratory_on
from evolution.experiments.plan import Plan
from evolution.experiments.plan_runner import run_plan
from evolution.runs.folder import RunFolder
from evolution.runs.meta import machine
from evolution.search.config import RunConfig
from evolution.search.settings import Settings

if TYPE_CHECKING:
    from arm2d.device.groups import Group

Row = tuple[str, str, str]
WORLDS = (
    {},
    {"camera_origin": "end", "object_vision": "any_part"},
    {"turn": "radians", "run_counting": "cumulative", "f3_time": "best", "success": "f1_f2_f3"},
    {"object_radius": 10.0, "bound_vision": "near", "start_areas": "bounds", "object_vision": "any_part"},
)


@dataclass(frozen=True)
class Experiment:
    """Runs of which a slice is measured.

    Attributes:
        runs: How many.
        measured: Generations of the slice, at least two parts.
        asked: Generations that are extrapolated to.
        processes: That share the device.
    """

    runs: int
    measured: int
    asked: int
    processes: int


@dataclass(frozen=True)
class Sizes:
    """How much is measured.

    Attributes:
        evolved: Generations of the evolved population.
        batches: Runs in a batch, one launch a generation.
        experiments: Whole runs, and
        other_shares: more of them, for as long as there is time.
        registers: Other limits of the kernel's registers.
        settings: Of the runs.
        seconds: Of each stage that is measured by time.
        agents: Of a part in post-evaluation.
    """

    evolved: int = 1500
    batches: tuple[int, ...] = (1, 10, 100, 1000)
    experiments: tuple[Experiment, ...] = (Experiment(100, 400, 6000, 8), Experiment(1000, 200, 3000, 16))
    other_shares: tuple[Experiment, ...] = (Experiment(100, 300, 6000, 4), Experiment(100, 300, 6000, 16))
    registers: tuple[int, ...] = (255, 128)
    settings: Settings = Settings()  # noqa: RUF009 - frozen
    seconds: float = 10.0
    agents: int = AGENTS_OF_A_PART


@dataclass(frozen=True)
class Bench:
    """What the stages share: the device, and two populations [100, 84]."""

    device: Device
    sizes: Sizes
    random: NDArray[np.float64]
    evolved: NDArray[np.float64]


def facts(bench: Bench) -> Iterator[Row]:
    """Of the machine and of the compiled kernel."""
    about = machine()
    yield "machine", "processor", f"{about['processor']}, {len(os.sched_getaffinity(0))} cores for us"
    yield "machine", "device", f"{bench.device.name}: {bench.device.model}"
    yield from (("kernel", *fact) for fact in facts_of(bench.device))


def same_bits(bench: Bench) -> Iterator[Row]:
    """Trials of some worlds on the device and on the processor."""
    laboratory, rng = laboratory_on(bench.device.name), np.random.default_rng(5)
    genotypes = np.concatenate([bench.random[:6], bench.evolved[:6]])
    for world in WORLDS:
        readings, n, alike = Readings().with_values(world), 0, 0
        for condition in Condition:
            trials = draw_trials(condition.instructions, 3, readings, rng)
            here = run_trials(genotypes, trials, readings)
            there = laboratory.run_trials(genotypes, trials, readings)
            equal = [getattr(here, name) == getattr(there, name) for name in vars(here)]
            n, alike = n + here.f1.size, alike + int(np.all(equal, axis=0).sum())
        name = ", ".join(f"{key} {value}" for key, value in world.items()) or "default world"
        yield "same bits", name, f"{alike} of {n} trials"


def batches(bench: Bench) -> Iterator[Row]:
    """A generation of many runs in one process, without breeding, beside the processor's kernel."""
    cores = len(os.sched_getaffinity(0))
    rate = rate_of_all(cores, generations_on_a_core, bench.sizes.seconds, bench.evolved)
    yield "a generation", f"processor, evolved, all {cores} cores", f"{1e3 / rate:.3f} ms a run"
    laboratory = laboratory_on(bench.device.name)
    for name, genotypes in (("random", bench.random), ("evolved", bench.evolved)):
        for n in bench.sizes.batches:
            groups = _groups(genotypes, n)
            laboratory.fitness(groups)
            whole, alone = kernel_seconds(bench.device, lambda groups=groups: laboratory.fitness(groups))
            text = f"{1e3 * whole / n:.3f} ms a run, {1e3 * whole:.1f} ms in all, {alone}"
            yield "a generation", f"device, {name}, {n} runs at once", text
            if name == "evolved":
                yield "a generation", f"{n} runs at once: times all cores", f"{n / whole / rate:.2f}"


def _groups(genotypes: NDArray[np.float64], n: int) -> list[Group]:
    """A generation of n runs with the same genotypes and trials of their own."""
    from arm2d.device.groups import Group

    readings, rng = Readings(), np.random.default_rng(n)
    instructions = Condition.WITH_INDICATE.experienced
    return [Group(genotypes, draw_trials(instructions, 2, readings, rng), readings) for _ in range(n)]


def limited_registers(bench: Bench) -> Iterator[Row]:
    """The kernel with fewer registers, so that more threads fit on a multiprocessor."""
    import warp

    from arm2d.device import loop

    laboratory, usual = laboratory_on(bench.device.name), loop.run_trials
    groups = _groups(bench.evolved, bench.sizes.batches[-2])
    expected = laboratory.fitness(groups)
    for limit in bench.sizes.registers:
        options = {"enable_backward": False, "fuse_fp": False, "fast_math": False}
        loop.run_trials = warp.kernel(
            usual.func, module="unique", cuda_max_registers=limit, module_options=options
        )
        try:
            same = np.array_equal(laboratory.fitness(groups), expected)
            whole, alone = kernel_seconds(bench.device, lambda: laboratory.fitness(groups))
        finally:
            loop.run_trials = usual
        text = f"{1e3 * whole:.1f} ms in all, {alone}, {'the same' if same else 'OTHER'} bits"
        yield "registers", f"at most {limit}, {len(groups)} runs at once", text


def post_evaluation(bench: Bench) -> Iterator[Row]:
    """Agents that carry out 720 trials each."""
    cores, sizes = len(os.sched_getaffinity(0)), bench.sizes
    rate = rate_of_all(cores, agents_on_a_core, sizes.seconds, bench.evolved)
    yield "post-evaluation", f"processor, all {cores} cores", _agents(rate)
    for n in (1, min(8, cores)):
        arguments = (sizes.seconds, bench.evolved, bench.device.name, sizes.agents)
        rate = rate_of_all(n, agents_on_a_device, *arguments)
        yield "post-evaluation", f"device, {n} processes", _agents(rate)


def _agents(rate: float) -> str:
    return f"{rate:.0f} agents a second; 200,000 in {200_000 / rate:.0f} s, extrapolated"


def experiments(bench: Bench) -> Iterator[Row]:
    """Whole runs with breeding and writing."""
    for each in bench.sizes.experiments:
        yield from _experiment(bench, each)


def other_shares(bench: Bench) -> Iterator[Row]:
    """The same with other numbers of processes that share the device."""
    for each in bench.sizes.other_shares:
        yield from _experiment(bench, each)


def _experiment(bench: Bench, which: Experiment) -> Iterator[Row]:
    settings = replace(bench.sizes.settings, generations=which.measured)
    configs = tuple(RunConfig(seed=seed, settings=settings) for seed in range(1, which.runs + 1))
    shares = DeviceShares((bench.device.name,), which.processes)
    with tempfile.TemporaryDirectory() as folder:
        plan, began = Plan(Path(folder), configs, post_evaluate=False), time.time()
        failures = run_plan(plan, which.processes, shares=shares)
        whole = time.time() - began
        what = f"{which.runs} runs, {which.processes} processes"
        if failures:
            yield "experiment", what, failures[0].sentence
            return
        paces, starts = _paces(plan, began)
    pace = median(paces)
    text = f"{which.measured} generations in {whole:.0f} s, {1e3 * pace:.1f} ms a generation of all"
    yield "experiment", what, text
    total = median(starts) + which.asked * pace
    yield "experiment", f"{what}, {which.asked} generations", f"{total / 60:.1f} min, extrapolated"
    yield "experiment", f"{what}, runs an hour", f"{3600 * which.runs / total:.0f}, extrapolated"


def _paces(plan: Plan, began: float) -> tuple[Sequence[float], Sequence[float]]:
    """Of every run: seconds a generation between first and last part, and until its first generation."""
    paces, starts = [], []
    for config in plan.configs:
        run = RunFolder(plan.path(config), config)
        first, last = run.spans[0], run.spans[-1]
        written = [run.part_path(span).stat().st_mtime for span in (first, last)]
        paces.append((written[1] - written[0]) / (last.stop - first.stop))
        starts.append(written[0] - began - paces[-1] * first.stop)
    return paces, starts
