"""Who wins the confirmation, whether it beats the printed readings, and which of its departures it needs.

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
from evolution.results.statistics import compare, mean_interval, sign_flip_test
from evolution.search.randomness import Purpose, generator
from evolution.study.declared.confirmation import CANDIDATES, PRINTED, RunsOfWorlds
from evolution.study.declared.nearest import distance
from evolution.study.declared.outcomes import FIGURES, OUTCOMES, PLATEAU, TOP_SHARES, Outcome
from evolution.study.declared.regression import Estimate
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
        return f"the winner, {self.winner}, does not beat the printed readings: the default stays"


def decide(runs: RunsOfWorlds, spreads: Spreads) -> Verdict:
    """The winner and who beats the printed readings.

    Raises:
        ValueError: If a world has fewer than two runs of a condition.
    """
    for name, own in runs.items():
        for condition, found in own.items():
            if len(found) < 2:
                raise ValueError(
                    f"{len(found)} runs of {name} {condition} are measured; the verdict needs two"
                )
    distances = {name: _distance(own, spreads) for name, own in runs.items()}
    candidates = [name for name in CANDIDATES if name in runs]
    duels = _duels(runs, candidates)
    beats = [
        name
        for name in candidates
        if distances[name] < distances[PRINTED]
        and all(each.corrected < STRICT and each.difference.value > 0 for each in duels if each.world == name)
    ]
    return Verdict(distances, min(candidates, key=distances.__getitem__), tuple(duels), tuple(beats))


def world_rows(
    runs: RunsOfWorlds, worlds: Mapping[str, Readings], verdict: Verdict
) -> Iterable[Sequence[object]]:
    """One row per world and condition: its figures with 95 % bootstrap intervals over runs."""
    numbers = [f"{outcome.name}{end}" for outcome in OUTCOMES for end in ("", " low", " high")]
    yield (
        "world", "readings", "condition", "runs", "at 18/7", "category 5 of I",
        "runs with fully compositional agents", *numbers, "distance", "beats printed",
    )  # fmt: skip
    for name, own in runs.items():
        for condition, found in own.items():
            means = [_mean(outcome.values(found)) for outcome in OUTCOMES]
            yield (
                name, variant_name(worlds[name]), str(condition), len(found),
                sum(run.at_limit for run in found),
                f"{np.mean([run.share('category 5 of I') for run in found]):.4f}",
                sum(run.counts["fully compositional"] > 0 for run in found),
                *(f"{v:.4f}" for each in means for v in (each.value, each.low, each.high)),
                f"{verdict.distances[name]:.4f}", "yes" if name in verdict.beats else "no",
            )  # fmt: skip


def duel_rows(verdict: Verdict) -> Iterable[Sequence[object]]:
    """One row per duel."""
    yield "world", "condition", "outcome", "difference", "low", "high", "p", "after Holm"
    for each in verdict.duels:
        d = each.difference
        yield (
            each.world, str(each.condition), each.outcome.name,
            *(f"{v:.4f}" for v in (d.value, d.low, d.high)), f"{each.p:.2g}", f"{each.corrected:.2g}",
        )  # fmt: skip


def less_one_rows(
    winner: Sequence[MeasuredRun], without: Mapping[str, Sequence[MeasuredRun]]
) -> Iterable[Sequence[object]]:
    """One row per departure and figure: what going back to the default costs, by seed.

    Args:
        winner: Its With-Indicate runs.
        without: The runs of the winner less one, by the factor that went back; a seed of the winner's each.
    """
    yield "factor", "outcome", "seeds", "difference", "low", "high", "p", "after Holm"
    pairs = [(factor, outcome) for factor in without for outcome in JUDGED]
    differences = [_paired(without[factor], winner, outcome) for factor, outcome in pairs]
    p = np.array([sign_flip_test(each) for each in differences])
    for (factor, outcome), each, own, corrected in zip(pairs, differences, p, holm(p), strict=True):
        mean = _mean(each)
        yield (
            factor, outcome.name, len(each), *(f"{v:.4f}" for v in (mean.value, mean.low, mean.high)),
            f"{own:.2g}", f"{corrected:.2g}",
        )  # fmt: skip


def _distance(own: Mapping[Condition, Sequence[MeasuredRun]], spreads: Spreads) -> float:
    """Of measured means."""
    means = {c: np.array([[f.values(runs).mean() for f in FIGURES]]) for c, runs in own.items()}
    return float(distance(means, spreads)[0])


def _duels(runs: RunsOfWorlds, candidates: Sequence[str]) -> list[Duel]:
    """Every candidate against the printed readings."""
    what = [
        (name, condition, outcome) for name in candidates for condition in Condition for outcome in JUDGED
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


def _paired(
    ours: Sequence[MeasuredRun], theirs: Sequence[MeasuredRun], outcome: Outcome
) -> NDArray[np.float64]:
    """Ours less theirs, for every seed that both have."""
    other = {run.config.seed: outcome.of_run(run) for run in theirs}
    return np.array(
        [outcome.of_run(run) - other[run.config.seed] for run in ours if run.config.seed in other]
    )


def _mean(values: NDArray[np.float64]) -> Estimate:
    return Estimate(float(values.mean()), *mean_interval(values, generator(0, Purpose.STATISTICS)))
