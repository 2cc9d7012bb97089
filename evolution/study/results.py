"""The study's results as files: rows per run and per variant, pictures per condition."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Final

from arm2d import Condition
from evolution.child import reference
from evolution.experiments.jobs import Failure, Overseer, run_jobs
from evolution.experiments.plan import LOGS, Plan
from evolution.experiments.standing import Standing
from evolution.experiments.variants import Variant
from evolution.experiments.warm_workers import WarmStart
from evolution.experiments.workers import Ended, Job
from evolution.figures.page import save_figure
from evolution.runs.folder import RunFolder
from evolution.runs.interrupt import StopRequest
from evolution.runs.lock import locked
from evolution.runs.storage import make_folder, write_atomically
from evolution.study.drawn import Drawn, base_among, drawn
from evolution.study.effects import effect_table
from evolution.study.figure import effects_figure, failures_figure
from evolution.study.measures import is_measured, measure
from evolution.study.table import VariantMeasures, group, run_table, variant_table
from evolution.study.variants import Part

MEASURING: Final = "measuring"
COUNT_INTERVAL: Final = 15.0  # [s]


def measure_runs(plan: Plan, at_once: int, stop: StopRequest) -> tuple[Failure, ...]:
    """Measure the runs that are evolved but not measured yet; the jobs that were given up."""
    chains = [[_job(plan, each)] for each in plan.standings() if _lacks_measures(plan, each)]
    if not chains:
        return ()
    print(f"measuring {len(chains)} runs", flush=True)
    overseer = Overseer(
        on_end=_counting(len(chains)),
        on_note=lambda note: print(note, flush=True),
        wants_stop=lambda: stop.requested,
    )
    with WarmStart(plan.folder / LOGS / "workers.log") as warm:
        return run_jobs(chains, at_once, overseer, warm)


def _counting(total: int) -> Callable[[Ended], None]:
    """Print how many runs are measured, now and then and at the end."""
    done, told_at = 0, time.monotonic()

    def count(ended: Ended) -> None:
        nonlocal done, told_at
        done += ended.exit_code == 0
        if done == total or time.monotonic() - told_at >= COUNT_INTERVAL:
            told_at = time.monotonic()
            print(f"{done} of {total} runs measured", flush=True)

    return count


def _lacks_measures(plan: Plan, standing: Standing) -> bool:
    return standing.evolved and not is_measured(plan.path(standing.config))


def _job(plan: Plan, standing: Standing) -> Job:
    path = plan.path(standing.config)
    log = plan.folder / LOGS / "measures.log"
    return Job(standing.name, MEASURING, reference(measure_run), {"folder": str(path)}, path, log)


def measure_run(folder: str) -> int:
    """Measure a run, in a process of its own; what was simulated is kept beside it."""
    run = RunFolder.open(Path(folder))
    with locked(run.path):
        measure(run)
    return 0


def measured_variants(plan: Plan) -> list[VariantMeasures]:
    """All runs that are measured, by variant.

    Raises:
        DamagedFileError: If a file of one of them is damaged.
    """
    ready = [each for each in plan.configs if is_measured(plan.path(each))]
    return group(
        (plan.variants[Variant.of(each)], measure(RunFolder.open(plan.path(each)))) for each in ready
    )


def write_study(
    variants: Sequence[VariantMeasures], part: Part, folder: Path, others: Sequence[VariantMeasures] = ()
) -> Iterable[Path]:
    """Write tables, and both pictures for each condition; their paths.

    Args:
        variants: Of the part.
        part: Names the files.
        folder: For them; made if need be.
        others: Of an earlier part: among them is what variants stand on that is not one of them.
    """
    make_folder(folder)
    tables = {
        "variants": variant_table(variants),
        "readings": effect_table(variants),
        "runs": run_table(variants),
    }
    for name, table in tables.items():
        path = folder / f"{part.name}-{name}.csv"
        write_atomically(path, table.to_csv().encode())
        yield path
    yield from write_pictures([drawn(each) for each in variants], part.name, folder, map(drawn, others))


def write_pictures(
    variants: Sequence[Drawn], part: str, folder: Path, others: Iterable[Drawn] = ()
) -> Iterable[Path]:
    """Both pictures for each condition; their paths. Arguments as those of `write_study`."""
    others = list(others)
    for condition in Condition:
        own = [each for each in variants if each.condition is condition]
        if not own:
            continue
        known = {each.name for each in own}
        base = base_among([each for each in others if each.name not in known], own)
        yield from save_figure(effects_figure(own, base), folder / f"{part}-{condition}-effects")
        yield from save_figure(failures_figure(own, base), folder / f"{part}-{condition}-failures")
