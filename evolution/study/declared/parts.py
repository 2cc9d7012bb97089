"""The parts of the study that were declared before their first run (docs/declaration.md)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Final

from arm2d import Condition, Readings
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from evolution.study.declared.factors import balanced_worlds

# The factorial study. Its seeds are none of those of other parts.
DESIGN_SEED: Final = 13
WORLDS: Final = 300
SHARED_WORLDS: Final = 150
GENERATIONS: Final = 3000
FIRST_SEED: Final = 1001
# Every fifth world is held back: the regression has to predict it.
HELD_BACK: Final = 5


@dataclass(frozen=True)
class DeclaredPart:
    """Runs that were declared before the first of them began.

    Attributes:
        name: On the command line.
        configs: The runs, in the order in which they are started.
        names: Of the worlds.
        whole: Whether all late agents are tested, not a sample of them.
    """

    name: str
    configs: tuple[RunConfig, ...]
    names: Mapping[Readings, str] = field(default_factory=dict)
    whole: bool = False


@cache
def _factorial_worlds() -> tuple[Readings, ...]:
    """The declared draw, which takes a second."""
    return balanced_worlds(WORLDS, DESIGN_SEED)


@cache
def factorial(generations: int = GENERATIONS) -> DeclaredPart:
    """300 worlds With-Indicate; the first 150 of them, with the same seeds, With-Ignore as well.

    World after world, so that the runs done at any time are a study by themselves.
    """
    settings = Settings(generations=generations)
    worlds = _factorial_worlds()
    configs = [
        RunConfig(condition, FIRST_SEED + number, settings, world)
        for number, world in enumerate(worlds)
        for condition in (Condition if number < SHARED_WORLDS else (Condition.WITH_INDICATE,))
    ]
    names = {world: f"world-{number:03d}" for number, world in enumerate(worlds, 1)}
    return DeclaredPart("factorial", tuple(configs), names)


def is_held_back(config: RunConfig) -> bool:
    """Whether a run of the factorial study is kept for the check of the regression."""
    return (config.seed - FIRST_SEED) % HELD_BACK == HELD_BACK - 1
