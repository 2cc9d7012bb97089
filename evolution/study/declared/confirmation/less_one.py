"""Which of its departures the winner needs: what going back with one of them costs, seed by seed.

As declared in docs/declaration.md, section 2.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm2d.records import alike, brief
from evolution.report.columns import PlainTable
from evolution.results.statistics import mean_interval, sign_flip_test
from evolution.search.randomness import Purpose, generator
from evolution.study.declared.confirmation.verdict import JUDGED
from evolution.study.declared.outcomes import Outcome
from evolution.study.declared.regression import Estimate, estimate_columns
from evolution.study.declared.rows import MeasuredRun
from evolution.study.effects import holm


@dataclass(frozen=True)
class Cost:
    """What going back with one factor costs in one figure.

    Attributes:
        factor: That went back to the default of the declaration.
        outcome: The figure.
        differences: [seeds], the winner less this departure, less the winner with the same seed.
        difference: Their mean, with a 95 % bootstrap interval over seeds.
        p: By `sign_flip_test`, which beyond 16 seeds is Student's t,
        corrected: and after Holm's correction over all departures and figures.
        at_limit: Runs without the departure that end at the largest fitness,
        winners_at_limit: and the winner's runs with the same seeds that do.
    """

    factor: str
    outcome: Outcome
    differences: NDArray[np.float64]
    difference: Estimate
    p: float
    corrected: float
    at_limit: int
    winners_at_limit: int

    __repr__ = brief
    __eq__ = alike


def costs(winner: Sequence[MeasuredRun], without: Mapping[str, Sequence[MeasuredRun]]) -> list[Cost]:
    """A cost for every departure and figure, departure by departure.

    Args:
        winner: Its With-Indicate runs.
        without: The runs of the winner less one departure, by the factor that went back, some with seeds of
            the winner's.
    """
    theirs = {run.config.seed: run for run in winner}
    pairs = {factor: _pairs(runs, theirs) for factor, runs in without.items()}
    told = [(factor, outcome) for factor in pairs for outcome in JUDGED]
    differences = [_differences(pairs[factor], outcome) for factor, outcome in told]
    p = np.array([sign_flip_test(each) for each in differences])
    return [
        Cost(
            factor,
            outcome,
            own,
            Estimate(float(own.mean()), *mean_interval(own, generator(0, Purpose.STATISTICS))),
            float(of_one),
            float(corrected),
            *(sum(run.at_limit for run in side) for side in zip(*pairs[factor], strict=True)),
        )
        for (factor, outcome), own, of_one, corrected in zip(told, differences, p, holm(p), strict=True)
    ]


def cost_table(found: Sequence[Cost]) -> PlainTable[Cost]:
    """One row per departure and figure."""
    return PlainTable(
        {
            "factor": lambda cost: cost.factor,
            "outcome": lambda cost: cost.outcome.name,
            "seeds": lambda cost: len(cost.differences),
            "at 18/7": lambda cost: cost.at_limit,
            "winner at 18/7": lambda cost: cost.winners_at_limit,
            **estimate_columns("difference", "low", "high", of=lambda cost: cost.difference),
            "p": lambda cost: f"{cost.p:.2g}",
            "after Holm": lambda cost: f"{cost.corrected:.2g}",
        },
        found,
    )


def _pairs(
    runs: Sequence[MeasuredRun], theirs: Mapping[int, MeasuredRun]
) -> list[tuple[MeasuredRun, MeasuredRun]]:
    """Each run beside the winner's with its seed."""
    return [(run, theirs[run.config.seed]) for run in runs if run.config.seed in theirs]


def _differences(pairs: Sequence[tuple[MeasuredRun, MeasuredRun]], outcome: Outcome) -> NDArray[np.float64]:
    return np.array([outcome.of_run(run) - outcome.of_run(winner) for run, winner in pairs])
