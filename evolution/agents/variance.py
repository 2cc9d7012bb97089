"""Which word the neurons' activity follows, and when: aligned averages and shares of variance.

Axes: T trials, B time bins of one control step relative to an event, N neurons.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d.constants import DT
from arm2d.records import alike, brief
from evolution.agents.behaviour import Behaviour
from evolution.agents.firsts import NEVER

# Bins from so many steps before an event to so many after it.
BEFORE, AFTER = 30, 60
# A bin counts while every instruction still has so many trials in it. Chosen.
LEAST_TRIALS: Final = 5
# Below this total variance (outputs lie in [0, 1]) shares would be those of rounding errors.
LEAST_VARIANCE: Final = 1e-9

# The events of a trial at which neurons are looked at.
START: Final = "trial start"
SIGHT: Final = "first sight of the target"
TOUCH: Final = "first touch of the target"

# Stretches that are summed up in one number: an event and two times from it [s]. Chosen: the last second
# of the search; the time from sight to touch, in which S2 is stretched; the first second of contact.
WINDOWS: Final = {
    "the second before first sight": (SIGHT, -1.0, 0.0),
    "0.5 to 3 s after first sight": (SIGHT, 0.5, 3.0),
    "the second after first touch": (TOUCH, 0.1, 1.0),
}


@dataclass(frozen=True)
class VarianceShares:
    """Shares of the variance of the neurons' outputs, eta squared, in each time bin; each [B].

    NaN where an instruction has too few trials left. The four shares add up to 1.

    Attributes:
        time: In [s] relative to the event; at 0 the event is in the world, from the next bin on in the
            neurons.
        object: Explained by the object word,
        action: by the action word,
        crossed: by what the two words do together beyond their sum,
        rest: by start, object positions and history.
        actions: Indices of the action words that took part, [A].
    """

    time: NDArray[np.float64]
    object: NDArray[np.float64]
    action: NDArray[np.float64]
    crossed: NDArray[np.float64]
    rest: NDArray[np.float64]
    actions: NDArray[np.int64]

    __repr__ = brief
    __eq__ = alike

    def mean(self, start: float, stop: float) -> tuple[float, float, float]:
        """Mean shares of object, action and crossed between two times [s], bounds included; else NaN."""
        inside = (self.time >= start - 1e-9) & (self.time <= stop + 1e-9) & np.isfinite(self.object)
        shares = (self.object, self.action, self.crossed)
        o, a, c = (float(share[inside].mean()) if inside.any() else float("nan") for share in shares)
        return o, a, c

    def arrays(self) -> dict[str, NDArray]:
        """Its arrays by name, ready for an .npz."""
        return {field.name: getattr(self, field.name) for field in fields(self)}


def events_of(behaviour: Behaviour) -> dict[str, NDArray[np.int64]]:
    """Rows of the trials [T] at which each event happens, or -1."""
    start = np.zeros(len(behaviour), np.int64)
    return {START: start, SIGHT: behaviour.first_sight, TOUCH: behaviour.first_touch}


def shares_by_event(behaviour: Behaviour) -> dict[str, VarianceShares]:
    """Which word the activity follows, aligned at each event."""
    return {event: variance_shares(behaviour, rows) for event, rows in events_of(behaviour).items()}


def bin_times() -> NDArray[np.float64]:
    """Times of the bins relative to an event [s], [B]."""
    return np.multiply(DT, np.arange(-BEFORE, AFTER + 1), dtype=np.float64)


def align(activity: NDArray[np.float64], rows: NDArray[np.int64]) -> NDArray[np.float64]:
    """Activity from `BEFORE` steps before to `AFTER` steps after an event, [T, B, N]; NaN outside a trial.

    Args:
        activity: [T, 251, N].
        rows: [T], the row of the event in each trial, or -1: then all of it is NaN.
    """
    wanted = rows[:, np.newaxis] + np.arange(-BEFORE, AFTER + 1)  # [T, B]
    inside = (wanted >= 0) & (wanted < activity.shape[1]) & (rows != NEVER)[:, np.newaxis]
    picked = activity[np.arange(len(rows))[:, np.newaxis], np.where(inside, wanted, 0)]
    return np.where(inside[..., np.newaxis], picked, np.nan)


def mean_by_instruction(behaviour: Behaviour, rows: NDArray[np.int64]) -> NDArray[np.float64]:
    """Mean aligned activity of each instruction, [9, B, N]; NaN where too few trials are left."""
    means, _, counts = _cells(align(behaviour.activity, rows), behaviour.instructions)
    return np.where((counts >= LEAST_TRIALS)[..., np.newaxis], means, np.nan)


def variance_shares(behaviour: Behaviour, rows: NDArray[np.int64]) -> VarianceShares:
    """Shares of variance explained by the words, aligned at the row of an event in each trial.

    With m_ao the mean output of a neuron over the trials of action a and object o in one bin, v_ao its
    variance there, and a dot for a mean over an index (every instruction counts the same, however many
    of its trials are left):

        object   mean_o  (m_.o - m_..)^2
        action   mean_a  (m_a. - m_..)^2
        crossed  mean_ao (m_ao - m_a. - m_.o + m_..)^2
        rest     mean_ao v_ao

    each summed over the neurons and divided by the sum of all four, the total variance. With few
    trials in a cell the first three are a little too large, by about v / trials.

    An action word of which an instruction seldom comes to the event (INDICATE to touch) takes no part;
    with fewer than two left, all shares are NaN.

    Args:
        behaviour: The trials.
        rows: [T], row of the event in each trial, or -1.
    """
    means, variances, counts = _cells(align(behaviour.activity, rows), behaviour.instructions)
    at_event = counts[:, BEFORE].reshape(3, 3)
    actions = np.flatnonzero((at_event >= LEAST_TRIALS).all(axis=1))
    shape = (3, 3, *means.shape[1:])
    cells, within = means.reshape(shape)[actions], variances.reshape(shape)[actions]  # [A, 3, B, N]
    parts = np.full((4, means.shape[1]), np.nan)
    if len(actions) >= 2:
        enough = (counts.reshape(3, 3, -1)[actions] >= LEAST_TRIALS).all(axis=(0, 1))
        parts = np.where(enough, _split(cells, within), np.nan)
    total = parts.sum(axis=0)
    shares = np.divide(parts, total, out=np.full_like(parts, np.nan), where=total > LEAST_VARIANCE)
    of_object, of_action, crossed, rest = shares
    return VarianceShares(bin_times(), of_object, of_action, crossed, rest, actions)


def _split(cells: NDArray[np.float64], within: NDArray[np.float64]) -> NDArray[np.float64]:
    """Variance by object, action, both and neither, summed over neurons, [4, B]."""
    of_action, of_object = cells.mean(axis=1, keepdims=True), cells.mean(axis=0, keepdims=True)
    grand = cells.mean(axis=(0, 1), keepdims=True)
    parts = (of_object - grand, of_action - grand, cells - of_action - of_object + grand)
    explained = [np.square(part).mean(axis=(0, 1)).sum(axis=-1) for part in parts]
    return np.stack([*explained, within.mean(axis=(0, 1)).sum(axis=-1)])


def _cells(
    aligned: NDArray[np.float64], instructions: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
    """Means and variances [9, B, N] and numbers of trials [9, B] of each instruction."""
    means, variances, counts = [], [], []
    for instruction in range(9):
        own = aligned[instructions == instruction]
        here = np.isfinite(own[..., 0])
        n = np.maximum(here.sum(axis=0), 1)[:, np.newaxis]
        mean = np.nansum(own, axis=0) / n
        means.append(mean)
        variances.append(np.nansum(np.square(own - mean), axis=0) / n)
        counts.append(here.sum(axis=0))
    return np.array(means), np.array(variances), np.array(counts)
