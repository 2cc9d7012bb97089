"""The events of a trial at which neurons are looked at, and the stretches of time round them."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from evolution.agents.behaviour import Behaviour
from evolution.agents.variance import VarianceShares, variance_shares

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


def events_of(behaviour: Behaviour) -> dict[str, NDArray[np.int64]]:
    """Rows of the trials [T] at which each event happens, or -1."""
    start = np.zeros(len(behaviour), np.int64)
    return {START: start, SIGHT: behaviour.first_sight, TOUCH: behaviour.first_touch}


def shares_by_event(behaviour: Behaviour) -> dict[str, VarianceShares]:
    """Which word the activity follows, aligned at each event."""
    return {event: variance_shares(behaviour, rows) for event, rows in events_of(behaviour).items()}
