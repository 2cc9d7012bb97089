"""Which runs make up an experiment, where they are kept, and the jobs that are still to be done for them.

    FOLDER/<condition>/seed-0007               if all runs share readings and settings
    FOLDER/<variant>/<condition>/seed-0007     else; each variant's folder is an experiment of its own

What is done is known from the files of a run alone, so whoever carries out a plan goes on where it was left.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Final

from evolution.child import reference
from evolution.experiments.stages import evolve_run, test_run
from evolution.experiments.standing import Pace, Standing, pace_of, standing_of
from evolution.experiments.variants import Variant, common_settings
from evolution.experiments.workers import Job
from evolution.runs.folder import CONFIG, RunFolder, refuse_other
from evolution.search.config import RunConfig

LOGS: Final = "logs"
EVOLVING: Final = "evolving"
TESTING: Final = "testing"


@dataclass(frozen=True)
class Plan:
    """Which runs make up an experiment, and where they are kept.

    Attributes:
        folder: Of the experiment.
        configs: The runs, in the order in which they are started.
        post_evaluate: Whether the paper's two tests follow evolution.
        names: Names of variants; those that have none are named after what is special about them.
        known: Runs whose results are kept apart from them; they are done, and their folders not looked into.
    """

    folder: Path
    configs: tuple[RunConfig, ...]
    post_evaluate: bool = True
    names: Mapping[Variant, str] = field(default_factory=dict)
    known: Collection[RunConfig] = ()

    @cached_property
    def variants(self) -> dict[Variant, str]:
        """The name of every variant, in the order of the runs."""
        variants = list(dict.fromkeys(Variant.of(config) for config in self.configs))
        if not variants:
            return {}
        common = common_settings(variants)
        return {variant: self.names.get(variant) or variant.name(common) for variant in variants}

    def variant_folder(self, config: RunConfig) -> str:
        """The folder of a run's variant; nothing if there is only one."""
        return self.variants[Variant.of(config)] if len(self.variants) > 1 else ""

    def path(self, config: RunConfig) -> Path:
        """The folder of a run."""
        return self.folder / self.variant_folder(config) / str(config.condition) / f"seed-{config.seed:04d}"

    def run_name(self, config: RunConfig) -> str:
        """A run's name for people: variant, if there are several, condition and seed."""
        return Standing(config, variant=self.variant_folder(config)).name

    def standing(self, config: RunConfig) -> Standing:
        """How far a run has come; one that is known is done."""
        variant = self.variant_folder(config)
        if config in self.known:
            generations = config.settings.generations
            return Standing(config, generations, finished=True, evolved=True, done=True, variant=variant)
        return standing_of(self.path(config), config, variant=variant, to_be_tested=self.post_evaluate)

    def standings(self) -> list[Standing]:
        """How far every run has come."""
        return [self.standing(config) for config in self.configs]

    def pace(self) -> Pace:
        """How fast the runs have been."""
        return pace_of(RunFolder(self.path(config), config) for config in self.configs)

    def check(self) -> None:
        """Refuse folders that hold other runs, before anything is written.

        Raises:
            ValueError: With the difference.
        """
        self._refuse_other_layout()
        for config in self.configs:
            refuse_other(self.path(config), config)

    def chains(self) -> list[list[Job]]:
        """The stages that are still to be done, run by run."""
        return [self._stages(each) for each in self.standings() if not each.done]

    def _stages(self, standing: Standing) -> list[Job]:
        """What is still to be done for a run."""
        config = standing.config
        path = self.path(config)
        log = self.folder / LOGS / f"{'-'.join(path.relative_to(self.folder).parts)}.log"
        run = {"folder": str(path), "config": config.to_mapping()}
        evolve = Job(standing.name, EVOLVING, reference(evolve_run), run, path, log)
        test = Job(standing.name, TESTING, reference(test_run), {"folder": str(path)}, path, log)
        stages = [evolve, test] if self.post_evaluate else [evolve]
        return stages[1:] if standing.evolved else stages

    def _refuse_other_layout(self) -> None:
        """Refuse to mix runs of one variant with folders of several."""
        several = len(self.variants) > 1
        pattern = f"with-*/seed-*/{CONFIG}" if several else f"*/with-*/seed-*/{CONFIG}"
        if found := next(self.folder.glob(pattern), None):
            here, asked = ("one variant", f"{len(self.variants)} variants")
            if not several:
                here, asked = "several variants", "one"
            raise ValueError(
                f"{self.folder} holds runs of {here}, such as {found.parent}, not of {asked}; "
                "choose another output folder"
            )
