"""What an experiment is to hold: worlds, conditions and seeds, and so its runs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from arm2d import Condition
from evolution.experiments.plan import Plan, World
from evolution.experiments.variants import check_name
from evolution.search.config import RunConfig

MOST_RUNS: Final = 100_000


@dataclass(frozen=True)
class ExperimentSpec:
    """What an experiment file asks for.

    Attributes:
        output: Folder of the experiment.
        conditions: Which third action is met.
        seeds: Of the runs.
        worlds: Readings and settings of every variant, with the names of those that have one.
        post_evaluate: Whether the paper's two tests follow evolution.
        jobs: Processes at a time; None for as many as there are processors.
    """

    output: Path
    conditions: tuple[Condition, ...]
    seeds: tuple[int, ...]
    worlds: Mapping[World, str | None]
    post_evaluate: bool = False
    jobs: int | None = None

    def configs(self) -> tuple[RunConfig, ...]:
        """All runs: for each seed, all variants and conditions, so that all get on together."""
        return tuple(
            RunConfig(condition, seed, settings, readings)
            for seed in self.seeds
            for readings, settings in self.worlds
            for condition in self.conditions
        )

    def plan(self) -> Plan:
        """The same with its folders.

        Raises:
            ValueError: If two variants would have the same folder.
        """
        names = {world: name for world, name in self.worlds.items() if name}
        plan = Plan(self.output, self.configs(), self.post_evaluate, names)
        seen: dict[str, World] = {}
        for world, name in plan.variants.items():
            if name in seen:
                raise ValueError(f"two variants are called {name!r}; give each a name of its own")
            check_name(name)
            seen[name] = world
        return plan

    def with_settings(self, **values: int) -> ExperimentSpec:
        """The same with some settings put in the place of the file's.

        Raises:
            ValueError: If two variants would become the same, or a value is impossible.
        """
        worlds: dict[World, str | None] = {}
        for (readings, settings), name in self.worlds.items():
            world = (readings, replace(settings, **values))
            if world in worlds:
                raise ValueError(
                    f"with {_told(values)} two variants are the same; the file makes a grid of that setting"
                )
            worlds[world] = name
        return replace(self, worlds=worlds)


def check_size(spec: ExperimentSpec) -> None:
    """Refuse an experiment nobody can have meant."""
    n = len(spec.worlds) * len(spec.conditions) * len(spec.seeds)
    if n > MOST_RUNS:
        raise ValueError(f"this makes {n:,} runs; an experiment has at most {MOST_RUNS:,}: split it up")


def _told(values: Mapping[str, int]) -> str:
    return ", ".join(f"{name} = {value}" for name, value in values.items())
