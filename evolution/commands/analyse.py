"""`wordarm postevaluate`, `analyse` and `report`: the paper's tests, its tables and figures, and a page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from tyro.conf import Positional, arg

if TYPE_CHECKING:
    from evolution.results.records import Results


@dataclass(frozen=True)
class PostEvaluate:
    """Test the five best of each late generation on all nine instructions, and on changes in mid-trial.

    Repeat the command to go on where it was stopped.
    """

    path: Annotated[Positional[Path], arg(metavar="FOLDER")]
    """Run folder, or experiment folder with its runs below it."""

    device: str = "cpu"
    """What runs the trials: cpu, or cuda for a graphics card by NVIDIA, one of several as cuda:1 (extra gpu).
    The results are the same, to the bit."""

    def run(self) -> int:
        """Post-evaluate every finished run."""
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

        from evolution.agents.parts import late_spans
        from evolution.experiments.device.late_tests import tests_on
        from evolution.experiments.experiment import open_experiment
        from evolution.experiments.standing import standing_of
        from evolution.runs.lock import locked

        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
        tests = tests_on(self.device)
        experiment, damaged = open_experiment(self.path), []
        with Progress(*columns) as bars:
            for run in experiment.all_runs:
                standing = standing_of(run.path, run.config)
                name = standing.name
                if standing.damage or not standing.finished:
                    bars.console.print(f"{name}: left out, {standing.damage or 'not finished'}")
                    continue
                parts = len(late_spans(run))
                first = bars.add_task(f"{name}, instructions", total=parts)
                second = bars.add_task(f"{name}, transitions", total=parts)
                try:
                    with locked(run.path):
                        tests.instructions(run, lambda done, _, bar=first: bars.update(bar, completed=done))
                        tests.transitions(run, lambda done, _, bar=second: bars.update(bar, completed=done))
                        tests.solved(run)
                except (ValueError, OSError) as error:
                    damaged.append(str(error))
        if damaged or experiment.unreadable:
            raise ValueError("; ".join([*experiment.unreadable, *damaged]))
        return 0


@dataclass(frozen=True)
class Analyse:
    """Write the paper's tables and figures from post-evaluated runs, published numbers beside ours.

    Several experiments, such as two readings, are put side by side instead: plateaus, sub-tasks,
    generalisers, transitions. They are named after their folders.
    """

    experiments: Annotated[
        Positional[tuple[Path, ...]], arg(metavar="EXPERIMENT...", help_behavior_hint="(required)")
    ]
    """Folders of experiments, <condition>/seed-<seed> below them."""

    output: Path | None = None
    """Folder for the files. By default `results` in the experiment's folder, and `comparison` for several."""

    ship: Path | None = None
    """Of one experiment, also write best generaliser, best specialist and best With-Ignore agent to files of
    their own in this folder; those in evolution/champions are known by their names."""

    archive: Path | None = None
    """Of one experiment, also pack all of this, the configs of its runs, checksums, licence and a README into
    one file, such as results.tar.gz. `wordarm verify` checks and unpacks it."""

    def run(self) -> int:
        """Analyse, write and print."""
        from evolution.experiments.experiment import open_experiment
        from evolution.results.analysis import analyse

        if not self.experiments:
            raise ValueError("no experiment is named; give its folder, such as runs/default")
        if len(self.experiments) > 1 and self.ship is not None:
            raise ValueError("--ship takes the agents of one experiment; name one")
        if self.ship is not None and self.ship.exists() and not self.ship.is_dir():
            raise ValueError(f"{self.ship} is a file; give a folder for the agents")
        if self.archive is not None:
            self._check_archive(self.archive)
        found = {name: open_experiment(path) for name, path in _named(self.experiments).items()}
        results = {name: analyse(experiment) for name, experiment in found.items()}
        if len(results) > 1:
            _compare(results, self.output or Path("comparison"))
        else:
            (only,) = results.values()
            _write(only, self.output or only.experiment.path / "results", self.ship)
            if self.archive is not None:
                _pack(only, self.archive)
        return 0

    def _check_archive(self, path: Path) -> None:
        """Refuse what cannot be packed before an hour of analysis."""
        from evolution.trust.archive import NAME, SUFFIX

        if len(self.experiments) > 1:
            raise ValueError("--archive takes the results of one experiment; name one")
        folder = path.name.removesuffix(SUFFIX)
        if not path.name.endswith(SUFFIX) or not NAME.fullmatch(folder):
            raise ValueError(f"--archive {path} is no name for an archive; give such as results{SUFFIX}")


def _write(results: Results, output: Path, shipped: Path | None) -> None:
    """Write tables, figures and, if they are asked for, notable agents."""
    from evolution.report.files import summary, write_results
    from evolution.results.notable import described, notable_agents, ship

    for path in write_results(results, output):
        print(path)
    if shipped is not None:
        agents = notable_agents(results)
        for path in ship(agents, shipped):
            print(f"{path}: {described(agents[path.stem])}")
    print(summary(results))


def _pack(results: Results, path: Path) -> None:
    """Pack everything into one file."""
    from evolution.report.bundle import bundle
    from evolution.runs.storage import make_folder, write_atomically
    from evolution.trust.archive import SUFFIX, pack

    make_folder(path.parent)
    write_atomically(path, pack(path.name.removesuffix(SUFFIX), bundle(results)))
    print(f"{path}\ncheck it with: wordarm verify {path}")


def _compare(results: Mapping[str, Results], output: Path) -> None:
    """Write and print the key numbers of several experiments."""
    from rich.console import Console

    from evolution.figures.compare import compare_figure
    from evolution.figures.page import save_figure
    from evolution.report.comparison import comparison_table, key_number_table
    from evolution.results.key_numbers import departures
    from evolution.runs.storage import make_folder, write_atomically

    console = Console(soft_wrap=True, highlight=False)
    make_folder(output)
    write_atomically(output / "comparison.csv", key_number_table(results).to_csv().encode())
    print(output / "comparison.csv")
    for path in save_figure(compare_figure(results), output / "comparison"):
        print(path)
    console.print(comparison_table(results))
    for name, result in results.items():
        console.print(f"{name}: {departures(result.experiment.readings)}")
        for sentence in result.missing:
            console.print(f"{name}: {sentence}")


def _named(paths: tuple[Path, ...]) -> dict[str, Path]:
    """Each experiment by the shortest end of its path that tells it from the others."""
    whole = [path.resolve() for path in paths]
    if len(set(whole)) < len(whole):
        twice = next(path for path, full in zip(paths, whole, strict=True) if whole.count(full) > 1)
        raise ValueError(f"{twice} is given twice; give different experiments")
    for length in range(1, max(len(path.parts) for path in whole) + 1):
        names = ["/".join(path.parts[-length:]) for path in whole]
        if len(set(names)) == len(names):
            break
    return dict(zip(names, paths, strict=True))


@dataclass(frozen=True)
class Report:
    """Write one self-contained HTML page: result, best agents alive, published numbers and ours, figures."""

    experiment: Annotated[Positional[Path], arg(metavar="EXPERIMENT")]
    """Folder of an experiment, or of one run; what is missing is named on the page."""

    output: Path | None = None
    """The page. By default `report.html` in the experiment's folder."""

    def run(self) -> int:
        """Analyse, write and print the path."""
        from evolution.experiments.experiment import open_experiment
        from evolution.report.page import write_report
        from evolution.results.analysis import analyse

        output = self.output or self.experiment / "report.html"
        if output.suffix.lower() not in (".html", ".htm"):
            raise ValueError(f"{output} is no name for a page; give such as report.html")
        print(write_report(analyse(open_experiment(self.experiment)), output))
        return 0
