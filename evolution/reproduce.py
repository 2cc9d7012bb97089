"""The whole paper from random genotypes: every run's stages as jobs, then tables, figures and the report.

What is done is known from the files of a run alone, so the same command goes on wherever it was stopped.
"""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from evolution.config import RunConfig
from evolution.folder import CONFIG, RunFolder, refuse_other
from evolution.jobs import Failure, Watcher, run_jobs
from evolution.lock import RunInUseError, locked
from evolution.notable import best_agent
from evolution.results import Results
from evolution.standing import Pace, Standing, pace_of, standing_of
from evolution.workers import Job

LOGS: Final = "logs"
EVOLVING: Final = "evolving"
TESTING: Final = "testing"


@dataclass(frozen=True)
class Plan:
    """Which runs make up an experiment, and where they are kept.

    Attributes:
        folder: Of the experiment.
        configs: The runs.
    """

    folder: Path
    configs: tuple[RunConfig, ...]

    def path(self, config: RunConfig) -> Path:
        """The folder of a run."""
        return self.folder / config.condition / f"seed-{config.seed:04d}"

    def standings(self) -> list[Standing]:
        """How far every run has come."""
        return [standing_of(self.path(config), config) for config in self.configs]

    def pace(self) -> Pace:
        """How fast the runs have been."""
        return pace_of(RunFolder(self.path(config), config) for config in self.configs)

    def check(self) -> None:
        """Refuse folders that hold other runs, before anything is written.

        Raises:
            ValueError: With the difference.
        """
        for config in self.configs:
            refuse_other(self.path(config), config)

    def chains(self) -> list[list[Job]]:
        """The stages that are still to be done, run by run."""
        return [self._stages(each) for each in self.standings() if not each.done]

    def _stages(self, standing: Standing) -> list[Job]:
        """What is still to be done for a run."""
        config = standing.config
        path = self.path(config)
        log = self.folder / LOGS / f"{config.condition}-seed-{config.seed:04d}.log"
        evolve = Job(standing.name, EVOLVING, evolve_arguments(config, path), path, log)
        test = Job(standing.name, TESTING, ("postevaluate", str(path)), path, log)
        return [test] if standing.evolved else [evolve, test]


def evolve_arguments(config: RunConfig, path: Path) -> tuple[str, ...]:
    """The command that starts exactly this run, or goes on with it, without `wordarm`."""
    values = config.to_mapping()
    arguments = ["evolve", f"--condition={config.condition}", f"--seed={config.seed}", f"--output={path}"]
    for name, value in values["settings"].items():
        arguments.append(f"--{_flag(name)}={value}")
    for name, value in values["readings"].items():
        flag = f"--readings.{_flag(name)}"
        arguments += [flag, *map(repr, value)] if isinstance(value, list) else [f"{flag}={value}"]
    return tuple(arguments)


def run_plan(plan: Plan, at_once: int, watcher: Watcher) -> tuple[Failure, ...]:
    """Evolve and test all runs as far as that is not done; the jobs that were given up.

    A run that another process works on is waited for.

    Raises:
        ValueError: If a folder holds another run.
        OSError: If nothing can be written.
    """
    plan.check()
    free = replace(watcher, may_start=lambda job: watcher.may_start(job) and not in_use(job.folder))
    return run_jobs(plan.chains(), at_once, free)


def agent_chains(results: Results, folder: Path) -> list[list[Job]]:
    """What is still to be drawn of the best agent of each condition: its ancestors, and how it does it."""
    chains = []
    for condition, each in results.conditions.items():
        if (agent := best_agent(each)) is None:
            continue
        path, stem = agent.run.path, f"generation-{agent.generation:06d}-rank-{agent.rank}"
        name, log = f"{condition}, its best agent", folder / LOGS / f"{condition}-best-agent.log"
        which = (str(path), f"--generation={agent.generation}", f"--rank={agent.rank}")
        for command, stage, done in (
            ("lineage", "tracing ancestors", path / "lineage" / f"{stem}.npz"),
            ("behaviour", "observing", path / "behaviour" / f"{stem}-behaviour.npz"),
        ):
            if not done.exists():
                chains.append([Job(name, stage, (command, *which), path, log)])
    return chains


def in_use(path: Path) -> bool:
    """Whether another process works on a run, such as one left over when its parent was killed."""
    if not (path / CONFIG).exists():
        return False
    try:
        with locked(path):
            return False
    except RunInUseError:
        return True


def watched_standings(plan: Plan, at_work: Set[str]) -> tuple[Sequence[Standing], Pace]:
    """Standings and pace for the live table; runs named are at work before they are held."""
    standings = [replace(each, at_work=each.at_work or each.name in at_work) for each in plan.standings()]
    return standings, plan.pace()


def _flag(name: str) -> str:
    return name.replace("_", "-")
