"""Algorithms side by side: how many runs reach 18/7, after how much, and what they make of words never met.

    wordarm experiment docs/examples/algorithms.toml
    python -m benchmarks.algorithms runs/algorithms --output algorithms.csv

Reads the finished runs of an experiment; those that differ by their seeds alone are a row. A run has
reached 18/7 in the first generation whose best fitness is within 0.02 of it. Its CPU time until then is
that of the whole run, files included, in proportion. Whether held-out instructions are understood is asked
of the five best of every tenth late generation, as `wordarm study` asks it; its tests are kept beside the
runs.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Annotated, Final

import numpy as np
import tyro
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import track
from rich.table import Table

from evolution.agents.firsts import NEVER, first_row
from evolution.agents.subtasks import AgentClass, carries_out
from evolution.answers import BAD_INPUT
from evolution.experiments.plan_file import experiment_standings
from evolution.report.columns import PlainTable
from evolution.results.records import ends_at_largest
from evolution.results.statistics import proportion_interval
from evolution.runs.folder import META, RunFolder
from evolution.runs.meta import read_meta
from evolution.runs.recorded import recorded_history
from evolution.runs.storage import write_atomically
from evolution.search.config import RunConfig
from evolution.study.measures import measure

UNKNOWN: Final = float("nan")


@dataclass(frozen=True)
class RunOutcome:
    """What a run came to.

    Attributes:
        config: The run.
        reached: First generation whose best is at 18/7; -1 if none is.
        stays: Whether its last sixth is there too, in the median.
        cpu: CPU time of the run [s]; NaN if a part of it was not noted.
        understood: [2], whether a late agent masters the seven and each held-out instruction besides;
        both: whether one masters all nine.
    """

    config: RunConfig
    reached: int
    stays: bool
    cpu: float
    understood: NDArray[np.bool_]
    both: bool

    @property
    def evaluations(self) -> int:
        """Genotypes scored until 18/7 was reached."""
        return (self.reached + 1) * self.config.settings.population

    @property
    def cpu_until(self) -> float:
        """The CPU time until then [s]."""
        return self.cpu * (self.reached + 1) / self.config.settings.generations


def outcome_of(run: RunFolder) -> RunOutcome:
    """Read and measure a finished run."""
    measures = measure(run)
    condition = run.config.papers_condition
    own = [carries_out(measures.agents, condition, word).any() for word in condition.held_out]
    return RunOutcome(
        config=run.config,
        reached=first_row(ends_at_largest(recorded_history(run).best)),
        stays=measures.at_limit,
        cpu=cpu_of(run),
        understood=np.array(own),
        both=measures.class_shares[AgentClass.FULL] > 0,
    )


def cpu_of(run: RunFolder) -> float:
    """CPU time of all its starts [s]; NaN if one was killed before it could note it."""
    spent = [start["cpu_seconds"] for start in read_meta(run.path / META)["starts"]]
    return sum(spent) if spent and None not in spent else UNKNOWN


@dataclass(frozen=True)
class Group:
    """Runs that differ by their seeds alone.

    Attributes:
        runs: One or more.
    """

    runs: tuple[RunOutcome, ...]

    @property
    def first(self) -> RunConfig:
        """One of them."""
        return self.runs[0].config

    @property
    def arrived(self) -> list[RunOutcome]:
        """Those that reach 18/7."""
        return [run for run in self.runs if run.reached != NEVER]

    def interval(self) -> str:
        """95 % interval of the share of these."""
        low, high = proportion_interval(len(self.arrived), len(self.runs))
        return f"{low:.2f} to {high:.2f}"

    def median(self, name: str) -> str:
        """Of a number of those that arrived; nothing if none did, or it is not known of all of them."""
        values = np.array([getattr(run, name) for run in self.arrived], float)
        return f"{np.median(values):.4g}" if len(values) and np.isfinite(values).all() else ""


def groups_of(runs: Iterable[RunOutcome]) -> list[Group]:
    """Runs of one algorithm under the same conditions, put together."""

    def key(run: RunOutcome) -> tuple[str, ...]:
        config = run.config
        return config.settings.algorithm, str(config.condition), repr(config.settings), repr(config.readings)

    return [Group(tuple(own)) for _, own in groupby(sorted(runs, key=key), key)]


def table_of(groups: Iterable[Group]) -> PlainTable[Group]:
    """A row for every group."""
    groups = list(groups)
    held_out = groups[0].first.papers_condition.held_out
    return PlainTable(
        {
            "algorithm": lambda group: group.first.settings.algorithm,
            "condition": lambda group: group.first.condition,
            "population": lambda group: group.first.settings.population,
            "generations": lambda group: group.first.settings.generations,
            "runs": lambda group: len(group.runs),
            "reach 18/7": lambda group: len(group.arrived),
            "95 % interval": Group.interval,
            "end at 18/7": lambda group: sum(run.stays for run in group.runs),
            "evaluations to get there (median)": lambda group: group.median("evaluations"),
            "CPU to get there (median) [s]": lambda group: group.median("cpu_until"),
            "CPU of a run (mean) [s]": lambda group: f"{np.mean([run.cpu for run in group.runs]):.4g}",
            **{
                f"understand {word}": lambda group, i=i: sum(bool(run.understood[i]) for run in group.runs)
                for i, word in enumerate(held_out)
            },
            "understand both": lambda group: sum(run.both for run in group.runs),
        },
        groups,
    )


def main(folder: Annotated[Path, tyro.conf.Positional], output: Path | None = None) -> int:
    """Print the table, a column for each algorithm.

    Args:
        folder: Of an experiment.
        output: Where it is stored besides, as comma-separated values.
    """
    try:
        standings, unreadable = experiment_standings(folder)
        runs = [RunFolder.open(path) for path, standing in standings.items() if standing.evolved]
        if not runs:
            raise ValueError(
                f"none of the {len(standings)} runs in {folder} is finished; go on with: wordarm experiment"
            )
        found = [
            outcome_of(run) for run in track(runs, "measuring", console=Console(stderr=True), transient=True)
        ]
        table = table_of(groups_of(found))
    except (ValueError, OSError) as error:
        print(error, file=sys.stderr)
        return BAD_INPUT
    for sentence in unreadable:
        print(sentence, file=sys.stderr)
    if len(runs) < len(standings):
        print(f"left out, as they are not finished: {len(standings) - len(runs)}", file=sys.stderr)
    rows = table.rows()
    shown = Table("", *(str(row["algorithm"]) for row in rows))
    for name in list(table.columns)[1:]:
        shown.add_row(name, *(str(row[name]) for row in rows))
    Console().print(shown)
    if output:
        write_atomically(output, table.to_csv().encode())
    return 0


if __name__ == "__main__":
    sys.exit(tyro.cli(main))
