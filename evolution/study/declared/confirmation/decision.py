"""Whether the winner of the confirmation becomes the default: once more, with seeds nobody has run.

As declared in section 5 of docs/declaration.md, which says why the confirmation's own rule does not do.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from arm2d import Condition, Readings
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from evolution.study.declared.confirmation.verdict import (
    STRICT,
    Duel,
    Spreads,
    check_two_runs,
    distance_of,
    duels,
)
from evolution.study.declared.confirmation.worlds import (
    PRINTED,
    PRINTED_WORLD,
    WHOLE_LENGTH,
    RunsOfWorlds,
    runs_of_worlds,
)
from evolution.study.declared.outcomes import PLATEAU, TOP_SHARES
from evolution.study.declared.parts import DeclaredPart
from evolution.study.declared.rows import MeasuredRun

DECISION_SEEDS: Final = range(131, 161)
WINNER: Final = "winner"
# So much lower may a figure be With-Ignore, and it is told as no worse: what counts as the same plateau
# (docs/success.md), and one late agent in twenty.
MARGINS: Final = {PLATEAU: 0.02, TOP_SHARES[0]: 0.05}


@dataclass(frozen=True)
class Decision:
    """What these runs say.

    Attributes:
        distances: Of the winner and of the printed readings from the paper, by name.
        duels: Winner less printed: With-Indicate, whose p are corrected together, then With-Ignore.
    """

    distances: Mapping[str, float]
    duels: tuple[Duel, ...]

    @property
    def better(self) -> bool:
        """Whether the winner is better With-Indicate, in both figures."""
        own = [duel for duel in self.duels if duel.condition is Condition.WITH_INDICATE]
        return all(duel.difference.value > 0 and duel.corrected < STRICT for duel in own)

    @property
    def no_worse(self) -> bool:
        """Whether it is not worse With-Ignore, by more than the margins."""
        own = [duel for duel in self.duels if duel.condition is Condition.WITH_IGNORE]
        return all(duel.difference.low > -MARGINS[duel.outcome] for duel in own)

    @property
    def nearer(self) -> bool:
        """Whether it is nearer to the paper."""
        return self.distances[WINNER] < self.distances[PRINTED]

    @property
    def is_default(self) -> bool:
        """Whether the winner becomes the default."""
        return self.better and self.no_worse and self.nearer

    @property
    def sentence(self) -> str:
        """The decision in words."""
        asked = {
            "better With-Indicate": self.better,
            "no worse With-Ignore": self.no_worse,
            "nearer to the paper": self.nearer,
        }
        if self.is_default:
            return f"the winner is {', '.join(asked)} than the printed readings: it is to be the default"
        missed = " or ".join(what for what, holds in asked.items() if not holds)
        return f"the winner is not shown to be {missed} than the printed readings: the default stays"


def decision(winner: Readings, generations: int = WHOLE_LENGTH) -> DeclaredPart:
    """The winner of the confirmation and the printed readings in both conditions, seed by seed."""
    worlds = {WINNER: winner, PRINTED: PRINTED_WORLD}
    configs = [
        RunConfig(condition, seed, Settings(generations=generations), world)
        for seed in DECISION_SEEDS
        for world in worlds.values()
        for condition in Condition
    ]
    return DeclaredPart("decision", tuple(configs), {world: name for name, world in worlds.items()})


def judged(runs: Sequence[MeasuredRun], winner: Readings, spreads: Spreads) -> tuple[RunsOfWorlds, Decision]:
    """The runs by world and condition, and what they say.

    Args:
        runs: Of the part `decision`.
        winner: The readings that won the confirmation.
        spreads: Of the figures, by condition, over the factorial study.

    Raises:
        ValueError: If a world has fewer than two runs of a condition.
    """
    own = runs_of_worlds(runs, {WINNER: winner, PRINTED: PRINTED_WORLD})
    check_two_runs(own)
    distances = {name: distance_of(found, spreads) for name, found in own.items()}
    found = [duel for condition in Condition for duel in duels(own, [WINNER], [condition])]
    return own, Decision(distances, tuple(found))
