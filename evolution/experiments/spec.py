"""What an experiment is to hold: variants, conditions and seeds, and so its runs."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from arm2d.tasks.task import AnyTask
from evolution.experiments.plan import Plan
from evolution.experiments.variants import Variant, check_name
from evolution.search.config import SEED_LIMIT, RunConfig

MOST_RUNS: Final = 100_000
MOST_SEEDS: Final = 10_000
RANGE: Final = re.compile(r"\s*(\d{1,19})\s*(?:-\s*(\d{1,19})\s*)?")
EXAMPLES: Final = "7, '1-8' or [1, 2, '5-8']"


@dataclass(frozen=True)
class ExperimentSpec:
    """What an experiment file asks for.

    Attributes:
        output: Folder of the experiment.
        conditions: Which third action is met, or tasks of one's own.
        seeds: Of the runs.
        variants: What is compared, with the names of those that have one.
        post_evaluate: Whether the paper's two tests follow evolution.
        jobs: Processes at a time; None for as many as there are processors.
    """

    output: Path
    conditions: tuple[AnyTask, ...]
    seeds: tuple[int, ...]
    variants: Mapping[Variant, str | None]
    post_evaluate: bool = False
    jobs: int | None = None

    def configs(self) -> tuple[RunConfig, ...]:
        """All runs: for each seed, all variants and conditions, so that all get on together."""
        return tuple(
            RunConfig(condition, seed, variant.settings, variant.readings)
            for seed in self.seeds
            for variant in self.variants
            for condition in self.conditions
        )

    def plan(self) -> Plan:
        """The same with its folders.

        Raises:
            ValueError: If two variants would have the same folder.
        """
        names = {variant: name for variant, name in self.variants.items() if name}
        plan = Plan(self.output, self.configs(), self.post_evaluate, names)
        seen: set[str] = set()
        for name in plan.variants.values():
            if name in seen:
                raise ValueError(f"two variants are called {name!r}; give each a name of its own")
            seen.add(check_name(name))
        return plan

    def with_settings(self, **values: int) -> ExperimentSpec:
        """The same with some settings put in the place of the file's.

        Raises:
            ValueError: If two variants would become the same, or a value is impossible.
        """
        variants: dict[Variant, str | None] = {}
        for variant, name in self.variants.items():
            changed = replace(variant, settings=replace(variant.settings, **values))
            if changed in variants:
                raise ValueError(
                    f"with {_told(values)} two variants are the same; the file makes a grid of that setting"
                )
            variants[changed] = name
        return replace(self, variants=variants)


def check_size(spec: ExperimentSpec) -> None:
    """Refuse an experiment nobody can have meant."""
    n = len(spec.variants) * len(spec.conditions) * len(spec.seeds)
    if n > MOST_RUNS:
        raise ValueError(f"this makes {n:,} runs; an experiment has at most {MOST_RUNS:,}: split it up")


def _told(values: Mapping[str, int]) -> str:
    return ", ".join(f"{name} = {value}" for name, value in values.items())


def read_seeds(value: Any) -> tuple[int, ...]:
    """The seeds that are meant, in their order.

    Raises:
        ValueError: If there are none, too many, one of them twice, or anything else than numbers and ranges.
    """
    given = value if isinstance(value, list) else [value]
    if not given:
        raise ValueError(f"seeds = [] names none; give {EXAMPLES}")
    seeds: list[int] = []
    for text in given:
        seeds += _range_of(text, value)
        if len(seeds) > MOST_SEEDS:
            raise _too_many(value)
    twice = [seed for seed, times in Counter(seeds).items() if times > 1]
    if twice:
        raise ValueError(f"seeds has {twice[0]} twice; leave one out")
    return tuple(seeds)


def _range_of(each: Any, whole: Any) -> range:
    """The numbers of one entry."""
    if isinstance(each, int) and not isinstance(each, bool):
        first = last = each
    elif isinstance(each, str) and (found := RANGE.fullmatch(each)):
        first, last = int(found[1]), int(found[2] or found[1])
    else:
        raise ValueError(f"seeds = {whole!r} is not understood; give {EXAMPLES}")
    if not 0 <= first <= last < SEED_LIMIT:
        raise ValueError(f"seeds = {whole!r}: {each!r} must rise within 0 to 2**63 - 1; give {EXAMPLES}")
    if last - first >= MOST_SEEDS:
        raise _too_many(whole)
    return range(first, last + 1)


def _too_many(value: Any) -> ValueError:
    return ValueError(f"seeds = {value!r} are too many; an experiment has at most {MOST_SEEDS:,}")
