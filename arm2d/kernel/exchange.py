"""What the kernel is given and what it gives back: plain arrays that Numba can read."""

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from arm2d.compiling import compiled
from arm2d.constants import N_OBJECTS
from arm2d.kernel import lanes as at
from arm2d.kernel.lanes import N_LANES, Floats, Integers
from arm2d.kernel.network import Inter


class TrialArrays(NamedTuple):
    """T trials as plain arrays.

    Attributes:
        action: [T] and
        object: [T], the instruction that is scored.
        alpha: [T] in [deg].
        bearing: [T, 3] of the discs in [deg].
        distance: [T, 3] of the discs from J1 in [cm].
        heard: [T, 2, 2], (action, object) heard before and after the words change.
        delay: [T], steps from the target's coming into view to the change, or NO_CHANGE.
        word_steps: [T], steps that a word takes where `heard` [T, 3, 2] is one after the other; else 0.
    """

    action: Integers
    object: Integers
    alpha: Floats
    bearing: Floats
    distance: Floats
    heard: Integers
    delay: Integers
    word_steps: Integers


class Outcomes(NamedTuple):
    """What becomes of P genotypes in T trials, each [P, T]; filled in by the kernel."""

    f1: Floats
    f2: Floats
    f3: Floats
    success: NDArray[np.bool_]
    steps: Integers


NO_CHANGE: Final = -1

# Columns of a recording; one row for each step.
RECORD_ALPHA: Final = 0
RECORD_BETA: Final = 1
RECORD_TURN: Final = 2
RECORD_BEARING: Final = 3
RECORD_DISTANCE: Final = 6
RECORD_SIDE: Final = 9
RECORD_CAMERA: Final = 12
RECORD_TOUCH: Final = 13
RECORD_CHANGED: Final = 14
RECORD_STATE: Final = 15  # and on: a column for each inter-neuron


@compiled(allocates=False)
def record_step(s: Floats, n: Integers, row: Floats) -> None:
    """Write down lane 0 after a step, before the words may change."""
    row[RECORD_ALPHA] = s[at.ALPHA]
    row[RECORD_BETA] = s[at.BETA]
    row[RECORD_TURN] = s[at.TURN]
    row[RECORD_CAMERA] = n[at.CAMERA]
    row[RECORD_TOUCH] = n[at.TOUCH]
    row[RECORD_CHANGED] = 1.0 if n[at.WAIT] == at.CHANGED else 0.0
    for disc in range(N_OBJECTS):
        row[RECORD_BEARING + disc] = s[at.BEARING + disc * N_LANES]
        row[RECORD_DISTANCE + disc] = s[at.DISTANCE + disc * N_LANES]
        row[RECORD_SIDE + disc] = n[at.SIDE + disc * N_LANES]


@compiled(allocates=False)
def record_states(s: Floats, row: Floats, inter: Inter) -> None:
    """Write down the states of lane 0's inter-neurons."""
    for j in range(len(inter)):
        row[RECORD_STATE + j] = s[at.Y + at.NEURON * j]
