"""How a recorded trial stands after each of its steps: what a score would be, and how much is done.

The rules are those of `arm2d.reference`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm2d import constants as c
from arm2d.geometry import offset_of
from arm2d.instructions import ActionWord
from arm2d.records import alike, brief
from arm2d.reference import LEFT, RIGHT, goal, is_good, score, sees
from arm2d.trials import TrialRecord

SIDES = (None, RIGHT, LEFT)  # as `TrialRecord.contact` codes them


@dataclass(frozen=True)
class Progress:
    """How a trial of K steps stands; row 0 is the start.

    Attributes:
        share: [K + 1], of the good steps, or of the turn, that are asked for: those of the run that is on.
        score: [K + 1], F1 + F2 + F3 had the trial ended there; 0 at the start.
    """

    share: NDArray[np.float64]
    score: NDArray[np.float64]

    __repr__ = brief
    __eq__ = alike


def progress_of(record: TrialRecord) -> Progress:
    """Follow a recorded trial's score (spec section 8)."""
    r, action, target = record.readings, record.instruction.action, int(record.instruction.object)
    full = goal(action, r) if np.isfinite(goal(action, r)) else float(c.GOOD_STEPS_FOR_SUCCESS)
    first = offset_of(record.alpha[0], record.discs[0, target])
    run, best, stretch = 0.0, 0.0, 0.0
    share, sums = np.zeros(record.steps + 1), np.zeros(record.steps + 1)
    for step in range(1, record.steps + 1):
        alpha, beta, centre = record.alpha[step], record.beta[step], record.discs[step, target]
        turned, offset = record.turns[step - 1, 0], offset_of(alpha, centre)
        side, in_view = SIDES[record.contact[step, target]], sees(alpha, centre, r)
        stretch = max(stretch, 1.0 - beta / c.BETA_MAX) if in_view else stretch
        if is_good(action, offset, in_view, side, turned, r):
            run += turned if action is ActionWord.MOVE else 1.0
        elif r.run_counting == "uninterrupted":
            run = 0.0
        best = max(best, abs(run))
        collided = bool(np.delete(record.contact[step], target).any())
        outcome = score(action, first, offset, in_view, collided, best, beta, stretch, step, r)
        share[step], sums[step] = min(1.0, abs(run) / full), outcome.f1 + outcome.f2 + outcome.f3
    return Progress(share, sums)
