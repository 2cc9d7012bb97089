"""The worlds and algorithms that the study of readings compares: the plain readings with some changed.

A reading is compared by its effect on the published figures, never by taste (spec section 12).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

from arm2d import Condition, Readings
from arm2d.readings import PLAIN
from evolution.experiments.variants import DEFAULT_NAME, Variant, value_names
from evolution.search.config import RunConfig
from evolution.search.settings import Settings

Overrides = Mapping[str, Any]

# One reading at a time, in the order of the ledger. The sectors at 45, 90 and 135 degrees need narrow ones.
FACTORS: Final[tuple[Overrides, ...]] = (
    {"mutation_probability": 0.04},
    {"mutation_sd": 0.03},
    {"parent_scaling": "cubed"},
    {"ties": "children"},
    {"bias_ranges": "negative"},
    {"tau_exponent_max": 1.0},
    {"tau_exponent_max": 0.0},
    {"object_radius": 3.0},
    {"object_radius": 8.0},
    {"object_radius": 10.0},
    {"sector_half_width": 5.0},
    {"sector_half_width": 8.0},
    {"start_areas": "bounds"},
    {"start_half_width": 0.0},
    {"start_half_width": 8.0},
    {"sector_centres": (45.0, 90.0, 135.0), "sector_half_width": 3.0},
    {"bound_vision": "near"},
    {"object_vision": "any_part"},
    {"turn": "radians"},
    {"success": "f1_f2_f3"},
    {"run_counting": "cumulative"},
    {"indicate_angle": "wide"},
    {"f3_time": "best"},
    {"starts_shared": "genotype"},
    {"collision_penalty": "whole"},
)


# The geometry in depth, most of it with the smaller mutation: narrow sectors, the other centres, blind starts
# at the bounds that see white early, wide start areas where narrow sectors leave room for them, small objects
# in narrow sectors, large objects that are seen by any part.
GEOMETRY: Final[tuple[Overrides, ...]] = (
    {"sector_half_width": 3.0},
    {"sector_half_width": 3.0, "mutation_sd": 0.03},
    {"sector_half_width": 5.0, "mutation_sd": 0.03},
    {"sector_half_width": 8.0, "mutation_sd": 0.03},
    {"sector_centres": (45.0, 90.0, 135.0), "sector_half_width": 3.0, "mutation_sd": 0.03},
    {"sector_centres": (45.0, 90.0, 135.0), "sector_half_width": 3.0, "start_areas": "bounds"},
    {"start_areas": "bounds", "mutation_sd": 0.03},
    {"start_areas": "bounds", "bound_vision": "near"},
    {"start_half_width": 8.0, "sector_half_width": 5.0},
    {"object_radius": 3.0, "sector_half_width": 5.0},
    {"object_radius": 10.0, "object_vision": "any_part"},
)

# What the screening and the finalists favour, and other sizes of it.
FAVOURITE: Final[Overrides] = {"mutation_sd": 0.03}
SIZES: Final = (0.07, 0.05, 0.03, 0.02, 0.01)
# `success` is no part of the fitness.
NO_FACTORS_AROUND: Final = ("mutation_sd", "success")


@dataclass(frozen=True)
class Part:
    """A part of the study: worlds, and how long and how often each is evolved.

    Attributes:
        name: On the command line.
        worlds: That are compared; the plain readings are among them, except in the confirmation.
        conditions: In which each is evolved.
        seeds: Runs of each variant and condition.
        generations: Of each run.
        first_seed: Of these runs.
    """

    name: str
    worlds: tuple[Readings, ...]
    conditions: tuple[Condition, ...] = (Condition.WITH_INDICATE,)
    seeds: int = 8
    generations: int = 3000
    first_seed: int = 1

    @property
    def names(self) -> dict[Variant, str]:
        """Of the variants, as they were when these parts were run and the plain readings were the default."""
        settings = Settings(generations=self.generations)
        return {
            Variant(world, settings): "+".join(value_names(world, PLAIN)) or DEFAULT_NAME
            for world in self.worlds
        }

    def configs(self) -> list[RunConfig]:
        """Every run of this part, seed by seed, so that all variants are known early if not well."""
        settings = Settings(generations=self.generations)
        return [
            RunConfig(condition, seed, settings, world)
            for seed in range(self.first_seed, self.first_seed + self.seeds)
            for world in self.worlds
            for condition in self.conditions
        ]


def screening() -> Part:
    """Every alternative of the ledger, one at a time, and the geometry in depth."""
    changed = [PLAIN.with_values(each) for each in (*FACTORS, *GEOMETRY)]
    return Part("screening", (PLAIN, *changed))


def finalists(nearest: Sequence[Readings]) -> Part:
    """The whole experiment under the plain readings and under those that came nearest to the paper."""
    others = [world for world in nearest if world != PLAIN]
    return Part("finalists", (PLAIN, *others), tuple(Condition), seeds=10, generations=6000)


def around() -> Part:
    """Other sizes of mutations, and every alternative of the ledger by itself on top of the favourite."""
    favourite = PLAIN.with_values(FAVOURITE)
    sizes = [replace(PLAIN, mutation_sd=size) for size in SIZES]
    changed = [favourite.with_values(each) for each in FACTORS if not set(each) & set(NO_FACTORS_AROUND)]
    return Part("around", (PLAIN, *sizes, *changed))


def confirmation(nearest: Sequence[Readings]) -> Part:
    """The whole experiment under the two that came nearest around the favourite, and under both together.

    Its seeds had no say in the choice.

    Raises:
        ValueError: If there are not two.
    """
    if len(nearest) < 2:
        raise ValueError(
            "the confirmation needs two variants to choose from, and one is measured around the favourite; "
            "go on with: wordarm study readings --part around"
        )
    (first, second), plain = nearest[:2], PLAIN.to_mapping()
    special = {name: value for name, value in second.to_mapping().items() if value != plain[name]}
    worlds = dict.fromkeys([first, second, first.with_values(special)])
    return Part("confirmation", tuple(worlds), tuple(Condition), seeds=10, generations=6000, first_seed=11)
