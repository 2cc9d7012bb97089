"""The worlds and algorithms that the study of readings compares: the default with some readings changed.

A reading is compared by its effect on the published figures, never by taste (spec section 12).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from arm2d import Condition, Readings
from evolution.config import RunConfig
from evolution.settings import Settings

Overrides = Mapping[str, Any]
INDICATE: Final = (Condition.WITH_INDICATE,)

# One reading at a time, in the order of the ledger. The sectors at 45, 90 and 135 degrees need narrow ones.
FACTORS: Final[tuple[Overrides, ...]] = (
    {"mutation_probability": 0.04},
    {"mutation_sd": 0.03},
    {"parent_scaling": "cubed"},
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


# The geometry in depth: what Fig. 1b would show, varied together (docs/readings.md says why these).
GEOMETRY: Final[tuple[Overrides, ...]] = ()

# The readings that come nearest to the published figures in the screening.
NEAREST: Final[tuple[Overrides, ...]] = ()


@dataclass(frozen=True)
class Part:
    """A part of the study: variants, and how long and how often each is evolved.

    Attributes:
        name: On the command line.
        purpose: What it asks, in one sentence.
        variants: Readings that differ from the default; the default itself is always among them.
        conditions: In which each is evolved.
        seeds: Runs of each variant and condition, seeds from 1 on.
        generations: Of each run.
    """

    name: str
    purpose: str
    variants: tuple[Overrides, ...]
    conditions: tuple[Condition, ...] = INDICATE
    seeds: int = 8
    generations: int = 3000

    def configs(self, settings: Settings) -> list[RunConfig]:
        """Every run of this part, seed by seed, so that all variants are known early if not well."""
        worlds = [Readings(), *(Readings().with_values(each) for each in self.variants)]
        return [
            RunConfig(condition, seed, settings, world)
            for seed in range(1, self.seeds + 1)
            for world in worlds
            for condition in self.conditions
        ]


PARTS: Final = {
    part.name: part
    for part in (
        Part(
            "screening",
            "Every alternative of the ledger, one at a time, and the geometry in depth.",
            (*FACTORS, *GEOMETRY),
        ),
        Part(
            "finalists",
            "The whole experiment under the readings that come nearest to the paper.",
            NEAREST,
            tuple(Condition),
            seeds=10,
            generations=6000,
        ),
    )
}
