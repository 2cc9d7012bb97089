"""The settings of the genetic algorithm (section V; spec section 9)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any, Final

# How many of each generation's genotypes are kept. The paper's post-evaluation takes five.
N_BEST: Final = 5
# The largest fitness of one trial: F1, F2 and F3 are at most 1 each.
LARGEST_TRIAL_FITNESS: Final = 3.0
# The largest fitness of a genotype, a mean over the seven experienced instructions: 3 for four of them, MOVE
# and TOUCH, and 2 for the three of the third action, which has no F3.
LARGEST_FITNESS: Final = 18 / 7


@dataclass(frozen=True)
class Settings:
    """How the genetic algorithm searches. The defaults are the paper's."""

    population: int = 100
    """Genotypes in each generation."""

    elites: int = 3
    """The best so many are copied on unchanged."""

    parents: int = 50
    """Children descend from the best so many, elites included."""

    generations: int = 6000
    """Generations to be scored; the first, of random genotypes, is number 0."""

    trials_per_area: int = 2
    """Trials of each instruction from each of the two start areas."""

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not isinstance(value, int) or isinstance(value, bool):
                raise ValueError(f"setting {field.name} = {value!r} must be a whole number")
        _check_interval("population", self.population, N_BEST, 10_000)
        _check_interval("elites", self.elites, 0, self.population - 1)
        _check_interval("parents", self.parents, 1, self.population)
        _check_interval("generations", self.generations, 1, 1_000_000)
        _check_interval("trials_per_area", self.trials_per_area, 1, 1_000)

    @classmethod
    def from_mapping(cls, values: Mapping[str, Any]) -> Settings:
        """Settings from plain values, as read from a config file.

        Raises:
            ValueError: If a name is unknown or a value is impossible.
        """
        known = [field.name for field in fields(cls)]
        for name in values:
            if name not in known:
                raise ValueError(f"unknown setting {name!r}; there are {', '.join(known)}")
        return cls(**values)

    def to_mapping(self) -> dict[str, int]:
        """Every field as a plain value, ready for a config file."""
        return asdict(self)


def _check_interval(name: str, value: int, low: int, high: int) -> None:
    """Refuse a number outside [low, high]."""
    if not low <= value <= high:
        raise ValueError(f"setting {name} = {value} must lie in [{low}, {high}]")
