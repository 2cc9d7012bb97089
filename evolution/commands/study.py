"""`wordarm study`: hundreds of runs that ask one question."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal

from tyro.conf import Positional, arg

from evolution.answers import BAD_INPUT, INTERRUPTED

if TYPE_CHECKING:
    from arm2d import Readings
    from evolution.experiments.device.jobs import DeviceShares
    from evolution.experiments.jobs import Failure
    from evolution.experiments.plan import Plan
    from evolution.runs.interrupt import StopRequest
    from evolution.search.config import RunConfig
    from evolution.study.beyond.study import BeyondStudy
    from evolution.study.declared.parts import DeclaredPart
    from evolution.study.declared.plan import RowFile
    from evolution.study.declared.study import DeclaredStudy
    from evolution.study.variants import Part

# Where what a part's variants stand on was evolved for as long, with the same seeds.
BEFORE: Final = {"confirmation": "finalists"}


# Of `evolution.study.declared.study`, which is loaded late.
DECLARED_PARTS: Final = ("factorial", "fresh", "decision", "less-one", "hundred")


@dataclass(frozen=True)
class StudyCommand:
    """Evolve under many readings of the paper and compare what each does; or evolve what lies beyond it.

    Repeat the command to go on; what is done is not done again. Ctrl-C loses nothing.
    """

    study: Annotated[Positional[Literal["readings", "beyond"]], arg(metavar="STUDY")]
    """The study: readings, what the paper leaves open (docs/readings.md); or beyond, what it asks in the end:
    other tasks, larger networks, more and less held out (docs/beyond.md)."""

    part: Literal[
        "screening",
        "finalists",
        "around",
        "confirmation",
        "factorial",
        "fresh",
        "decision",
        "less-one",
        "hundred",
    ] = "screening"
    """Of the study readings. Parts of the first: screening (3000 generations, one reading at a time and the
    geometry in depth), finalists (the whole experiment under the default and the three that came nearest to
    the paper), around (as the screening, on top of the favoured size of mutations) and confirmation (the
    whole experiment under the two that came nearest around it, and both together, with fresh seeds). Of the
    declared one (docs/declaration.md): factorial (all readings mixed), fresh (the worlds it puts nearest to
    the paper and others, with fresh seeds), decision (the nearest of these against the printed readings, with
    seeds of its own), less-one (the nearest with one departure taken back at a time) and hundred (a hundred
    runs of either condition under the default)."""

    output: Path | None = None
    """Folder of the study, by default runs/readings or runs/beyond. Each part has a folder in it."""

    seeds: int | None = None
    """Runs of each variant and condition, by default what the part asks for."""

    generations: int | None = None
    """Generations of each run, by default what the part asks for."""

    jobs: int | None = None
    """Processes at a time. By default as many as there are processors."""

    device: str = "cpu"
    """What runs the trials: cpu, or cuda for a graphics card by NVIDIA, one of several as cuda:1 (extra gpu).
    The results are the same, to the bit."""

    now: bool = False
    """Evolve nothing: tables and pictures of the runs that are measured by now."""

    results: Path | None = None
    """Folder for tables and pictures, by default results in the part's folder."""

    rows: Path | None = None
    """File of measured rows to begin with, such as docs/results/readings/factorial.csv: its runs are not
    evolved again. A declared part keeps the rows of all its runs in rows.csv in its folder, and so does
    beyond."""

    early: bool = False
    """Choose and compare with as many runs of the declared parts before as are measured by now."""

    def run(self) -> int:
        """Study; the exit code is 130 if it was stopped, 2 if a run was given up or nothing is measured."""
        from evolution.experiments.device.jobs import device_shares
        from evolution.experiments.jobs import tell_failures
        from evolution.experiments.plan_runner import processes
        from evolution.runs.interrupt import StopRequest
        from evolution.runs.lock import locked
        from evolution.runs.storage import make_folder

        if self.study == "beyond":
            return self._run_beyond()
        if self.part in DECLARED_PARTS:
            return self._run_declared()
        if self.rows is not None or self.early:
            raise ValueError(f"--rows and --early are for declared parts, which {self.part} is not")
        part, at_once = self._part(), processes(self.jobs)
        shares = None if self.now else device_shares(self.device, self.jobs)
        plan = _plan(part, self._folder)
        failures = ()
        if not self.now:
            plan.check()
            make_folder(plan.folder)
            with locked(plan.folder), StopRequest() as stop:
                failures = _evolve_and_measure(plan, at_once, stop, shares)
                tell_failures(failures)
                if stop.requested:
                    print("stopped; go on with the same command")
                    return INTERRUPTED
        _write(plan, part, self.results or plan.folder / "results")
        return BAD_INPUT if failures else 0

    @property
    def _folder(self) -> Path:
        """Of the study."""
        return self.output or Path("runs") / self.study

    def _run_declared(self) -> int:
        """A declared part of the study of readings."""
        from evolution.study.declared.study import DeclaredStudy

        self._check_declared(f"the part {self.part}")
        study = DeclaredStudy(self._folder, generations=self.generations, early=self.early)
        return self._carry_out(study, study.part(self.part))

    def _run_beyond(self) -> int:
        """The study of what lies beyond the paper."""
        from evolution.study.beyond.study import BeyondStudy

        if self.part != StudyCommand.part or self.early:
            raise ValueError("--part and --early are for the study readings; leave them away")
        self._check_declared("the study beyond")
        study = BeyondStudy(self._folder, self.generations)
        return self._carry_out(study, study.part)

    def _check_declared(self, what: str) -> None:
        """Refuse to change what was declared."""
        from evolution.study.measures import check_generations

        if self.seeds is not None:
            raise ValueError(f"every run of {what} has its seed; leave --seeds away")
        if self.generations is not None:
            check_generations(self.generations)

    def _carry_out(self, study: DeclaredStudy | BeyondStudy, part: DeclaredPart) -> int:
        """Evolve and measure what has no row yet, and write what all rows say."""
        from evolution.experiments.device.jobs import check_device, device_shares
        from evolution.experiments.jobs import tell_failures
        from evolution.experiments.plan_runner import processes
        from evolution.runs.interrupt import StopRequest
        from evolution.study.declared.plan import carry_out

        rows: RowFile[Any] = study.rows(part)
        known, failures = self._known(rows), ()
        if not self.now:
            check_device(self.device, part.configs)
            shares = device_shares(self.device, self.jobs)
            with StopRequest() as stop:
                at_once, folder = processes(self.jobs), rows.path.parent
                failures = carry_out(rows, folder, at_once, stop, known.values(), shares)
            tell_failures(failures)
            if stop.requested:
                print("stopped; go on with the same command")
                return INTERRUPTED
        found = known | rows.read()
        runs: list[Any] = [found[config] for config in part.configs if config in found]
        paths, notes = study.write(part, runs, self.results or rows.path.parent / "results")
        print(*paths, *notes, f"{len(runs)} of {len(part.configs)} runs are measured so far", sep="\n")
        return BAD_INPUT if failures else 0

    def _known(self, rows: RowFile[Any]) -> dict[RunConfig, Any]:
        """The runs of the file of rows to begin with, if there is one."""
        if self.rows is None:
            return {}
        if not self.rows.is_file():
            raise ValueError(f"there is no file {self.rows}; give one that a study of the same part wrote")
        return replace(rows, path=self.rows).read()

    def _part(self) -> Part:
        """The part that is asked for, with the numbers of seeds and generations that are."""
        from evolution.study.measures import check_generations
        from evolution.study.variants import around, confirmation, finalists, screening

        if self.part == "finalists":
            part = finalists(self._nearest("screening"))
        elif self.part == "confirmation":
            part = confirmation(self._nearest("around"))
        else:
            part = {"screening": screening, "around": around}[self.part]()
        seeds = part.seeds if self.seeds is None else self.seeds
        if seeds < 1:
            raise ValueError(f"asked for {seeds} seeds; there must be at least 1")
        generations = part.generations if self.generations is None else self.generations
        check_generations(generations)
        return replace(part, seeds=seeds, generations=generations)

    def _nearest(self, among: Literal["screening", "around"]) -> list[Readings]:
        """The readings that came nearest to the paper in a part that stands in the same folder."""
        from evolution.experiments.plan_file import read_plan
        from evolution.study.results import measured_variants
        from evolution.study.table import nearest

        folder = self._folder / among
        plan = read_plan(folder)
        if plan is None or not (variants := measured_variants(plan)):
            command = f"wordarm study readings --part {among}"
            raise ValueError(f"no run is measured in {folder}; begin with: {command}")
        return [each.runs[0].config.readings for each in nearest(variants)]


def _plan(part: Part, folder: Path) -> Plan:
    from evolution.experiments.plan import Plan

    return Plan(folder / part.name, tuple(part.configs()), post_evaluate=False, names=part.names)


def _evolve_and_measure(
    plan: Plan, at_once: int, stop: StopRequest, shares: DeviceShares | None
) -> tuple[Failure, ...]:
    """Run what is not done yet; the jobs that were given up."""
    from evolution.experiments.plan_runner import run_plan_shown
    from evolution.study.results import measure_runs

    failures = run_plan_shown(plan, at_once, stop, shares=shares)
    return failures if stop.requested else failures + measure_runs(plan, at_once, stop)


def _write(plan: Plan, part: Part, folder: Path) -> None:
    from evolution.experiments.plan_file import read_plan
    from evolution.study.results import measured_variants, write_study

    variants = measured_variants(plan)
    if not variants:
        raise ValueError(f"no run in {plan.folder} is measured yet; leave --now away to evolve them")
    before = read_plan(plan.folder.parent / BEFORE[part.name]) if part.name in BEFORE else None
    for path in write_study(variants, part, folder, measured_variants(before) if before else ()):
        print(path)
    n = sum(len(each.runs) for each in variants)
    if n < len(plan.configs):
        print(f"{n} of {len(plan.configs)} runs are measured so far")
