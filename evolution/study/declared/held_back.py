"""Does the regression predict runs it has not seen? Every fifth world is held back to tell."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d.records import alike, brief
from evolution.results.statistics import BOOTSTRAP_SAMPLES
from evolution.search.randomness import Purpose, generator
from evolution.study.declared.outcomes import Outcome
from evolution.study.declared.parts import is_held_back
from evolution.study.declared.regression import Estimate, Model, fit, level_numbers
from evolution.study.declared.rows import MeasuredRun

THIRDS: Final = 3


@dataclass(frozen=True)
class Check:
    """Predictions of held-back runs.

    Attributes:
        model: Fitted to the others.
        predicted: [H], and
        found: [H], what came out.
        without: What would be predicted of every run without knowing its readings: the mean of the others.
    """

    model: Model
    predicted: NDArray[np.float64]
    found: NDArray[np.float64]
    without: float

    __repr__ = brief
    __eq__ = alike

    @property
    def skill(self) -> Estimate:
        """1 - mean square error / that of predicting the mean; the interval by drawing held-back runs."""
        own, mean = (self.predicted - self.found) ** 2, (self.without - self.found) ** 2
        rng = generator(0, Purpose.STATISTICS)
        drawn = rng.integers(0, len(own), (BOOTSTRAP_SAMPLES, len(own)))
        with np.errstate(invalid="ignore", divide="ignore"):
            value = 1 - own.sum() / mean.sum()
            low, high = np.nanquantile(1 - own[drawn].sum(axis=1) / mean[drawn].sum(axis=1), [0.025, 0.975])
        return Estimate(float(value), float(low), float(high))

    @property
    def thirds(self) -> list[tuple[float, float]]:
        """(mean prediction, mean of what came out) in the lower, middle and upper third of predictions."""
        order = np.argsort(self.predicted, kind="stable")
        parts = np.array_split(order, THIRDS)
        return [(float(self.predicted[part].mean()), float(self.found[part].mean())) for part in parts]


def check(runs: Sequence[MeasuredRun], outcome: Outcome) -> Check:
    """Fit without the held-back runs of a condition, and predict them.

    Raises:
        ValueError: If no run is held back, or too few are left.
    """
    held = [run for run in runs if is_held_back(run.config)]
    others = [run for run in runs if not is_held_back(run.config)]
    if not held:
        raise ValueError("no held-back run is measured yet; evolve more of them")
    model = fit(others, outcome)
    return Check(
        model,
        model.predict(level_numbers(held)),
        outcome.values(held),
        float(outcome.values(others).mean()),
    )
