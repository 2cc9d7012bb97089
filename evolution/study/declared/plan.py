"""The runs of a declared part, each measured as soon as it is evolved, its row kept in one file.

Runs whose row is there already are not evolved again, on whatever machine they were.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final, Generic

from evolution.child import reference
from evolution.experiments.device.jobs import DeviceShares
from evolution.experiments.jobs import Failure
from evolution.experiments.plan import LOGS, TESTING, Plan
from evolution.experiments.plan_runner import run_plan_shown
from evolution.experiments.standing import Standing
from evolution.experiments.variants import Variant
from evolution.experiments.workers import Ended, Job
from evolution.runs.folder import RunFolder
from evolution.runs.interrupt import StopRequest
from evolution.runs.lock import locked
from evolution.runs.storage import make_folder
from evolution.search.config import RunConfig
from evolution.study.declared.parts import DeclaredPart
from evolution.study.declared.rows import measured_run, post_evaluated_run, read_rows, write_rows
from evolution.study.device_measures import measure_on
from evolution.study.late_transitions import are_tested, passed_transitions
from evolution.study.measures import is_measured, measure
from evolution.study.row_files import R

MEASURING: Final = "measuring"
# On a device: enough to keep it busy, few enough that rows come every few minutes.
RUNS_AT_ONCE: Final = 256


def measure_with_transitions(folder: str) -> int:
    """Measure a run and test its late agents with words that change, in a process of its own."""
    run = RunFolder.open(Path(folder))
    with locked(run.path):
        passed_transitions(run, measure(run))
    return 0


def has_measures(path: Path) -> bool:
    """Whether everything that has to be simulated for a run's row is there."""
    return is_measured(path) and are_tested(path)


@dataclass(frozen=True)
class Measurement(Generic[R]):
    """What is measured of every run of a study, and how it is kept as a row.

    Attributes:
        job: Simulates what the row needs in a process of its own, told the run's folder; an exit code.
        done: Whether what it simulates is there, in a run's folder.
        row: The row of a run for which it is.
        read: The rows of a file,
        write: and writes them.
        on_device: Does the same as `job` for several runs on a device, if that can be done.
    """

    job: Callable[[str], int]
    done: Callable[[Path], bool]
    row: Callable[[RunFolder], R]
    read: Callable[[Path], list[R]]
    write: Callable[[Iterable[R], Path], None]
    on_device: Callable[..., int] | None = None


SAMPLED: Final = Measurement(
    measure_with_transitions, has_measures, measured_run, read_rows, write_rows, measure_on
)
WHOLE: Final = replace(SAMPLED, row=post_evaluated_run)


@dataclass(frozen=True)
class MeasuredPlan(Plan, Generic[R]):
    """A plan that measures every run as soon as it is evolved, or, with `post_evaluate`, tests it whole.

    Attributes:
        known: The measured rows of runs that have one, wherever they were evolved.
        measurement: What is measured.
    """

    known: Mapping[RunConfig, R] = field(default_factory=dict)
    measurement: Measurement[R] = SAMPLED  # type: ignore[assignment] - what most studies measure

    @property
    def last_stage(self) -> str:
        """What ends a run."""
        return TESTING if self.post_evaluate else MEASURING

    def standing(self, config: RunConfig) -> Standing:
        """How far a run has come; it is done when it is measured."""
        standing = super().standing(config)
        if row := self.known.get(config):
            return replace(standing, best=row.plateau)
        measured = self.post_evaluate or self.measurement.done(self.path(config))
        return replace(standing, done=standing.done and measured)

    def row(self, path: Path) -> R:
        """The row of a run that is done; raises ValueError if it is not."""
        return self.measurement.row(RunFolder.open(path))

    def _stages(self, standing: Standing) -> list[Job]:
        if self.post_evaluate:
            return super()._stages(standing)
        path = self.path(standing.config)
        log = self.folder / LOGS / "measures.log"
        function, there = reference(self.measurement.job), self.measurement.on_device
        on_device = reference(there) if there else ""
        measuring = Job(
            standing.name, MEASURING, function, {"folder": str(path)}, path, log, on_device=on_device
        )
        return [measuring] if standing.evolved else [*super()._stages(standing), measuring]


@dataclass(frozen=True)
class RowFile(Generic[R]):
    """The file of a part's measured rows, which is both what is known and what is found.

    Attributes:
        path: Its place.
        part: Whose runs they are.
        measurement: What is measured of them; of a part whose late agents are all tested, `WHOLE`.
    """

    path: Path
    part: DeclaredPart
    measurement: Measurement[R] = SAMPLED  # type: ignore[assignment] - what most studies measure

    def read(self) -> dict[RunConfig, R]:
        """Its runs, in the order of the part.

        Raises:
            ValueError: If it cannot be understood, or has a run of another study.
        """
        found = {run.config: run for run in self.measurement.read(self.path)}
        declared = set(self.part.configs)
        if strange := next((each for each in found if each not in declared), None):
            raise ValueError(
                f"{self.path} has a row of {strange.condition}, seed {strange.seed}, that is no run of the "
                f"part {self.part.name} with these readings and generations; give another file of rows"
            )
        return {config: found[config] for config in self.part.configs if config in found}

    def add(self, runs: Iterable[R]) -> None:
        """Add runs; raises OSError if it cannot be written."""
        found = self.read() | {run.config: run for run in runs}
        self.measurement.write([found[each] for each in self.part.configs if each in found], self.path)

    def plan(self, folder: Path) -> MeasuredPlan[R]:
        """The runs of the part, with those known that have a row."""
        settings = {config.settings for config in self.part.configs}
        names = {Variant(world, own): name for world, name in self.part.names.items() for own in settings}
        measurement: Measurement[Any] = WHOLE if self.part.whole else self.measurement
        return MeasuredPlan(folder, self.part.configs, self.part.whole, names, self.read(), measurement)

    def collect(self, plan: MeasuredPlan[R]) -> None:
        """Add the rows of all runs of a plan that are measured by now."""
        unknown = (config for config in plan.configs if config not in plan.known)
        self.add(plan.row(plan.path(config)) for config in unknown if plan.standing(config).done)


def carry_out(
    rows: RowFile[R],
    folder: Path,
    at_once: int,
    stop: StopRequest,
    known: Iterable[R] = (),
    shares: DeviceShares | None = None,
) -> tuple[Failure, ...]:
    """Evolve and measure all runs that have no row yet; the jobs that were given up.

    Args:
        rows: Gets a row for every run, as soon as it is measured.
        folder: For the runs.
        at_once: Processes at a time.
        stop: An open one; what is at work is then left in good order.
        known: Runs measured elsewhere, which get their rows first.
        shares: How a device is shared, if one is to run the trials.

    Raises:
        ValueError: If the file of rows cannot be understood, or a folder holds another run.
        OSError: If nothing can be written.
    """
    make_folder(folder)
    with locked(folder):
        rows.add(known)
        plan = rows.plan(folder)
        rows.collect(plan)

        def keep(ended: Ended) -> None:
            if ended.exit_code == 0 and ended.job.stage == plan.last_stage:
                folders = ended.job.arguments.get("folders", [ended.job.folder])
                rows.add(plan.row(Path(folder)) for folder in folders)

        waves = shares and replace(shares, runs_at_once=RUNS_AT_ONCE)
        return run_plan_shown(plan, at_once, stop, on_end=keep, shares=waves)
