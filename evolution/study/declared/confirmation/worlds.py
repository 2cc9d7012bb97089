"""The confirmation: chosen worlds, pilots' worlds and the printed readings, with seeds nobody has run.

Worlds and seeds as declared in docs/declaration.md; who wins is decided in `verdict`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

from arm2d import Condition, Readings
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from evolution.study.declared.factors import DECLARED_DEFAULT, FACTORS, levels_of, world_of
from evolution.study.declared.parts import DeclaredPart
from evolution.study.declared.rows import MeasuredRun

WHOLE_LENGTH: Final = 6000  # generations, as in the paper
FRESH_SEEDS: Final = range(101, 131)
LESS_ONE_SEEDS: Final = range(101, 121)
HUNDRED_SEEDS: Final = range(1, 101)
PRINTED_SEEDS: Final = range(1, 21)

FIRST: Final = "first"
SECOND: Final = "second"
DEFAULT: Final = "default"
PRINTED: Final = "printed"
CANDIDATES: Final = (FIRST, SECOND, "a", "b", "smallest-departure")

# Found by pilots, with other seeds and, A, with an approximation of the camera.
WORLD_A: Final = replace(
    DECLARED_DEFAULT,
    parent_scaling="excess",
    ties="children",
    tau_exponent_max=1.0,
    mutation_sd=0.03,
    camera_origin="end",
)
WORLD_B: Final = replace(WORLD_A, camera_origin="J1")
SMALLEST_DEPARTURE: Final = replace(DECLARED_DEFAULT, parent_scaling="excess", ties="children")
# Differs from the declared default With-Ignore only: With-Indicate no instruction is IGNORE.
PRINTED_WORLD: Final = replace(DECLARED_DEFAULT, ignore_stops="never")

RunsOfWorlds = Mapping[str, Mapping[Condition, Sequence[MeasuredRun]]]


def fresh_worlds(chosen: Sequence[Readings]) -> dict[str, Readings]:
    """The worlds of the confirmation by name.

    Args:
        chosen: By the rule, from the factorial study; one or two.
    """
    return {
        **dict(zip((FIRST, SECOND), chosen, strict=False)),
        "a": WORLD_A,
        "b": WORLD_B,
        "smallest-departure": SMALLEST_DEPARTURE,
        DEFAULT: DECLARED_DEFAULT,
        PRINTED: PRINTED_WORLD,
    }


def fresh(chosen: Sequence[Readings], generations: int = WHOLE_LENGTH) -> DeclaredPart:
    """Seed by seed, all worlds in both conditions; a world that has two names is run once."""
    worlds = fresh_worlds(chosen)
    settings = Settings(generations=generations)
    configs = [
        RunConfig(condition, seed, settings, world)
        for seed in FRESH_SEEDS
        for name, world in worlds.items()
        for condition in Condition
        if name != PRINTED or condition is Condition.WITH_IGNORE
    ]
    names: dict[Readings, str] = {}
    for name, world in worlds.items():
        names.setdefault(world, name)
    return DeclaredPart("fresh", tuple(dict.fromkeys(configs)), names)


def runs_of_worlds(runs: Sequence[MeasuredRun], worlds: Mapping[str, Readings]) -> RunsOfWorlds:
    """The runs of every world and condition, by seed; the printed world's With-Indicate are the default's."""
    found = {name: {c: _of(runs, world, c) for c in Condition} for name, world in worlds.items()}
    if PRINTED in found and DEFAULT in found:
        found[PRINTED][Condition.WITH_INDICATE] = found[DEFAULT][Condition.WITH_INDICATE]
    return found


def departures(world: Readings) -> dict[str, Readings]:
    """The world less one departure from the declared default at a time, by the factor that goes back."""
    levels, default = levels_of(world), levels_of(DECLARED_DEFAULT)
    return {
        factor.name: world_of([*levels[:place], default[place], *levels[place + 1 :]])
        for place, factor in enumerate(FACTORS)
        if levels[place] != default[place]
    }


def less_one(winner: Readings, generations: int = WHOLE_LENGTH) -> DeclaredPart:
    """The winner less one departure at a time, With-Indicate; its own runs are those of the confirmation."""
    settings, worlds = Settings(generations=generations), departures(winner)
    configs = [
        RunConfig(Condition.WITH_INDICATE, seed, settings, world)
        for seed in LESS_ONE_SEEDS
        for world in worlds.values()
    ]
    names = {world: f"without-{factor.replace('_', '-')}" for factor, world in worlds.items()}
    return DeclaredPart("less-one", tuple(configs), names)


def hundred(default: Readings, generations: int = WHOLE_LENGTH) -> DeclaredPart:
    """A hundred runs of each condition under the default of then, and twenty under the printed readings."""
    settings = Settings(generations=generations)
    worlds = {DEFAULT: (default, HUNDRED_SEEDS), PRINTED: (PRINTED_WORLD, PRINTED_SEEDS)}
    configs = [
        RunConfig(condition, seed, settings, world)
        for seed in HUNDRED_SEEDS
        for world, seeds in worlds.values()
        for condition in Condition
        if seed in seeds
    ]
    names = {world: name for name, (world, _) in worlds.items()}
    return DeclaredPart("hundred", tuple(configs), names, whole=True)


def _of(runs: Sequence[MeasuredRun], world: Readings, condition: Condition) -> list[MeasuredRun]:
    own = [run for run in runs if (run.config.readings, run.config.condition) == (world, condition)]
    return sorted(own, key=lambda run: run.config.seed)
