"""The settings of the search: the paper's genetic algorithm (section V; spec section 9), or another."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from numbers import Integral, Real
from typing import Any, Final

from arm2d.constants import MOST_INTER, N_INTER
from arm2d.network.genes import genes_of

# How many of each generation's genotypes are kept. The paper's post-evaluation takes five.
N_BEST: Final = 5
# The largest fitness of one trial: F1, F2 and F3 are at most 1 each.
LARGEST_TRIAL_FITNESS: Final = 3.0
# The largest fitness of a genotype, a mean over the seven experienced instructions: 3 for four of them, MOVE
# and TOUCH, and 2 for the three of the third action, which has no F3.
LARGEST_FITNESS: Final = 18 / 7
GENETIC: Final = "genetic"
CMA_ES: Final = "cma-es"
# Whose settings these are.
OF_GENETIC: Final = ("elites", "parents")
OF_CMA_ES: Final = ("cma_sigma", "cma_patience")
# Files name these only where they are not the default: those written before there were other algorithms, and
# other networks, keep their bytes.
ADDED: Final = ("algorithm", *OF_CMA_ES, "inter_neurons")
NAME: Final = re.compile(r"[a-z][a-z0-9-]{0,39}")


@dataclass(frozen=True)
class Settings:
    """How genotypes are searched for. The defaults are the paper's: a genetic algorithm."""

    population: int = 100
    """Genotypes in each generation."""

    elites: int = 3
    """Genetic algorithm: the best so many are copied on unchanged."""

    parents: int = 50
    """Genetic algorithm: children descend from the best so many, elites included."""

    generations: int = 6000
    """Generations to be scored; the first, of random genotypes, is number 0."""

    trials_per_area: int = 2
    """Trials of each instruction from each of the two start areas."""

    algorithm: str = GENETIC
    """genetic, the paper's; cma-es; or one of your own (docs/how-to/algorithm.md)."""

    cma_sigma: float = 0.25
    """CMA-ES: standard deviation of the first genotypes around their mean, in genes of 0 to 1."""

    cma_patience: int = 100
    """CMA-ES: begins anew, with twice as many candidates, when so many iterations brought nothing better."""

    inter_neurons: int = N_INTER
    """Inter-neurons of each network, 1 to 16; the paper's has three (docs/how-to/size.md)."""

    def __post_init__(self) -> None:
        for field in fields(self):
            plain = _of_kind(field.name, getattr(self, field.name), field.default)
            object.__setattr__(self, field.name, plain)  # 1 and 1.0, or one of NumPy's, are written alike
        _check_interval("population", self.population, N_BEST, 10_000)
        _check_interval("generations", self.generations, 1, 1_000_000)
        _check_interval("trials_per_area", self.trials_per_area, 1, 1_000)
        _check_interval("inter_neurons", self.inter_neurons, 1, MOST_INTER)
        if not NAME.fullmatch(self.algorithm):
            raise ValueError(
                f"setting algorithm = {self.algorithm!r} is no name; give genetic, cma-es, or small letters, "
                "digits and dashes"
            )
        if self.algorithm == GENETIC:
            _check_interval("elites", self.elites, 0, self.population - 1)
            _check_interval("parents", self.parents, 1, self.population)
        else:
            self._refuse_foreign(OF_GENETIC, GENETIC)
        if self.algorithm == CMA_ES:
            _check_interval("cma_sigma", self.cma_sigma, 0.001, 1.0)
            _check_interval("cma_patience", self.cma_patience, 1, 1_000_000)
        else:
            self._refuse_foreign(OF_CMA_ES, CMA_ES)

    @property
    def n_genes(self) -> int:
        """Genes of each genotype: 84 for three inter-neurons."""
        return genes_of(self.inter_neurons).count

    def _refuse_foreign(self, names: tuple[str, ...], owner: str) -> None:
        """Refuse settings of an algorithm that is not the one that searches."""
        for name in names:
            if getattr(self, name) != getattr(Settings, name):
                raise ValueError(
                    f"setting {name} belongs to the algorithm {owner}, not to {self.algorithm}; leave it out"
                )

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

    def to_mapping(self) -> dict[str, Any]:
        """The fields as plain values, ready for a config file: the paper's, and what is not as usual."""
        return {name: value for name, value in asdict(self).items() if name not in self._unsaid()}

    def _unsaid(self) -> set[str]:
        """The fields that a config file leaves out."""
        as_usual = {name for name in ADDED if getattr(self, name) == getattr(Settings, name)}
        return as_usual if self.algorithm == GENETIC else as_usual | set(OF_GENETIC)


def _of_kind(name: str, value: Any, default: Any) -> Any:
    """A value as one of the kind of its default, if it is one; a whole number is a number."""
    if isinstance(default, str):
        if not isinstance(value, str):
            raise ValueError(f"setting {name} = {value!r} must be text, such as {default!r}")
    elif isinstance(value, bool) or not isinstance(value, Integral if isinstance(default, int) else Real):
        kind = "a whole number" if isinstance(default, int) else "a number"
        raise ValueError(f"setting {name} = {value!r} must be {kind}")
    plain: Any = type(default)
    return plain(value)


def _check_interval(name: str, value: float, low: float, high: float) -> None:
    """Refuse a number outside [low, high], NaN included."""
    if not low <= value <= high:
        raise ValueError(f"setting {name} = {value} must lie in [{low}, {high}]")
