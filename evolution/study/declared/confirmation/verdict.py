"""Who wins the confirmation, and whether it beats the printed readings.

Rules as declared in docs/declaration.md. Axes: R runs.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition, Readings
from evolution.experiments.variants import variant_name
from evolution.report.columns import PlainTable
from evolution.results.statistics import compare, mean_interval
from evolution.search.randomness import Purpose, generator
from evolution.study.declared.confirmation.worlds import CANDIDATES, PRINTED, RunsOfWorlds
from evolution.study.declared.nearest import distance
from evolution.study.declared.outcomes import FIGURES, OUTCOMES, PLATEAU, TOP_SHARES, Outcome
from evolution.study.declared.regression import Estimate, estimate_columns
from evolution.study.declared.rows import MeasuredRun
from evolution.study.effects import holm

STRICT: Final = 0.01
# A world beats another by these.
JUDGED: Final = (PLATEAU, TOP_SHARES[0])

Spreads = Mapping[Condition, NDArray[np.float64]]


@dataclass(frozen=True)
class Duel:
    """A world against the printed readings, by one figure in one condition.

    Attributes:
        world: Its name.
        condition: Of the runs.
        outcome: The figure.
        difference: World less printed, with a bootstrap interval over runs.
        p: By permutation of runs,
        corrected: and after Holm's correction over all duels.
    """

    world: str
    condition: Condition
    outcome: Outcome
    difference: Estimate
    p: float
    corrected: float


@dataclass(frozen=True)
class Verdict:
    """What the confirmation says.

    Attributes:
        distances: Of every world from the paper, by name.
        winner: The nearest of those that may become the default.
        duels: All of them.
        beats: Names of the worlds that beat the printed readings.
    """

    distances: Mapping[str, float]
    winner: str
    duels: tuple[Duel, ...]
    beats: tuple[str, ...]

    @property
    def sentence(self) -> str:
        """The verdict in words."""
        if self.winner in self.beats:
            return f"the winner, {self.winner}, beats the printed readings: it is to be the default"
        missed = "does not beat the printed readings in all that is asked: by this rule the default stays"
        return f"the winner, {self.winner}, {missed}"


def decide(runs: RunsOfWorlds, spreads: Spreads) -> Verdict:
    """The winner and who beats the printed readings.

    Raises:
        ValueError: If a world has fewer than two runs of a condition.
    """
    check_two_runs(runs)
    distances = {name: distance_of(own, spreads) for name, own in runs.items()}
    candidates = [name for name in CANDIDATES if name in runs]
    fought = duels(runs, candidates)
    beats = [
        name
        for name in candidates
        if distances[name] < distances[PRINTED]
        and all(
            each.corrected < STRICT and each.difference.value > 0 for each in fought if each.world == name
        )
    ]
    return Verdict(distances, min(candidates, key=distances.__getitem__), tuple(fought), tuple(beats))


def check_two_runs(runs: RunsOfWorlds) -> None:
    """Refuse a world with fewer than two runs of a condition."""
    for name, own in runs.items():
        for condition, found in own.items():
            if len(found) < 2:
                raise ValueError(
                    f"{len(found)} runs of {name} {condition} are measured; the verdict needs two"
                )


def world_table(
    runs: RunsOfWorlds, worlds: Mapping[str, Readings], distances: Mapping[str, float], beats: Sequence[str]
) -> PlainTable[_RunsOfWorld]:
    """One row per world and condition: its figures with 95 % bootstrap intervals over runs."""
    figures = (
        estimate_columns(
            outcome.name,
            f"{outcome.name} low",
            f"{outcome.name} high",
            of=lambda row, outcome=outcome: _mean(outcome.values(row.runs)),
        )
        for outcome in OUTCOMES
    )
    return PlainTable(
        {
            "world": lambda row: row.world,
            "readings": lambda row: variant_name(worlds[row.world]),
            "condition": lambda row: str(row.condition),
            "runs": lambda row: len(row.runs),
            "at 18/7": lambda row: sum(run.at_limit for run in row.runs),
            "category 5 of I": lambda row: (
                f"{np.mean([run.share('category 5 of I') for run in row.runs]):.4f}"
            ),
            "runs with fully compositional agents": lambda row: sum(
                run.counts["fully compositional"] > 0 for run in row.runs
            ),
            **{name: column for columns in figures for name, column in columns.items()},
            "distance": lambda row: f"{distances[row.world]:.4f}",
            "beats printed": lambda row: "yes" if row.world in beats else "no",
        },
        [
            _RunsOfWorld(name, condition, found)
            for name, own in runs.items()
            for condition, found in own.items()
        ],
    )


def duel_table(fought: Sequence[Duel]) -> PlainTable[Duel]:
    """One row per duel."""
    return PlainTable(
        {
            "world": lambda duel: duel.world,
            "condition": lambda duel: str(duel.condition),
            "outcome": lambda duel: duel.outcome.name,
            **estimate_columns("difference", "low", "high", of=lambda duel: duel.difference),
            "p": lambda duel: f"{duel.p:.2g}",
            "after Holm": lambda duel: f"{duel.corrected:.2g}",
        },
        fought,
    )


@dataclass(frozen=True)
class _RunsOfWorld:
    """A row of the table of worlds."""

    world: str
    condition: Condition
    runs: Sequence[MeasuredRun]


def distance_of(own: Mapping[Condition, Sequence[MeasuredRun]], spreads: Spreads) -> float:
    """The distance of measured means from the published ones."""
    means = {c: np.array([[f.values(runs).mean() for f in FIGURES]]) for c, runs in own.items()}
    return float(distance(means, spreads)[0])


def duels(
    runs: RunsOfWorlds, candidates: Sequence[str], conditions: Iterable[Condition] = Condition
) -> list[Duel]:
    """Every candidate against the printed readings, in these conditions; p are corrected over all of them."""
    what = [
        (name, condition, outcome) for name in candidates for condition in conditions for outcome in JUDGED
    ]
    found = [
        compare(o.values(runs[name][c]), o.values(runs[PRINTED][c]), generator(0, Purpose.STATISTICS))
        for name, c, o in what
    ]
    corrected = holm(np.array([each.permutation_p for each in found]))
    return [
        Duel(*which, Estimate(each.difference, *each.interval), each.permutation_p, float(p))
        for which, each, p in zip(what, found, corrected, strict=True)
    ]


def _mean(values: NDArray[np.float64]) -> Estimate:
    return Estimate(float(values.mean()), *mean_interval(values, generator(0, Purpose.STATISTICS)))
