"""Layout of the lanes: trials that advance side by side, one field after the other.

Quantity F of lane i stands at `F + i` in the flat array of floats `s` or of integers `n`. Fields at
constant distances in one array let LLVM see that they do not overlap, so loops over lanes vectorise.
The drive of the words heard stands apart, in rows, one for each lane: `d[row_of(inter) * i]` and on.
"""

import re
from typing import Final

import numba
import numpy as np
from llvmlite.binding import get_host_cpu_name
from numpy.typing import NDArray

# What the kernel's arguments are, when they are arrays.
Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

N_LANES: Final = 32


def _lanes_of_a_vector() -> int:
    """How many lanes LLVM puts into a vector: eight where it takes 512 bits, as for AMD's Zen 4 and later.

    For Intel's processors with AVX-512 it keeps to 256.
    """
    processor = numba.config.CPU_NAME or get_host_cpu_name()  # type: ignore[attr-defined]
    zen = re.fullmatch(r"znver(\d+)", processor)
    return 8 if zen and int(zen[1]) >= 4 else 4


# Loops run over whole blocks of lanes, so that none is left to be done alone; idle lanes hold the finite
# values of an ended trial. No result depends on it.
BLOCK: Final = _lanes_of_a_vector()

# Fields of `s`.
ALPHA: Final = 0 * N_LANES  # angle of S1 [deg]
BETA: Final = 1 * N_LANES  # angle of S2 [deg]
TURN: Final = 2 * N_LANES  # S1's last turn after clipping [deg]
BEND: Final = 3 * N_LANES  # S2's last turn after clipping [deg]
BEARING: Final = 4 * N_LANES  # three fields: each disc's bearing [deg]
LOW: Final = 7 * N_LANES  # three fields: right edge of what can be seen of a disc from J1 [deg]
HIGH: Final = 10 * N_LANES  # three fields: left edge
DISTANCE: Final = 13 * N_LANES  # three fields: each disc's distance from J1 [cm]
LIMIT: Final = 16 * N_LANES  # S2 may meet a disc in this step only from below this beta [deg]
TARGET: Final = 17 * N_LANES  # bearing of the target [deg]
CONE: Final = 18 * N_LANES  # a good step's largest distance from the target [deg]
GOAL: Final = 19 * N_LANES  # the run that ends the trial, in steps or [deg]
COUNT: Final = 20 * N_LANES  # what a good step adds to the run ...
PUSH: Final = 21 * N_LANES  # ... and what each degree of its turn adds
RUN: Final = 22 * N_LANES  # current run of good steps, or of turns [deg]
BEST: Final = 23 * N_LANES  # largest run so far
FIRST_OFFSET: Final = 24 * N_LANES  # d_i [deg]
STRETCH: Final = 25 * N_LANES  # largest 1 - beta / 90 with the target in view
SUM: Final = 26 * N_LANES  # what the inter-neurons drive in one of them, on the way to its next state
# Three fields each, kept where the camera is at the end of S1.
EDGE: Final = 27 * N_LANES  # how far from S1's direction, seen from J1, a disc's centre leaves the view [deg]
MIDDLE_EDGE: Final = 30 * N_LANES  # the same of the middle sector
EDGES_FOR: Final = 33 * N_LANES  # the distance from J1 that they hold for [cm]
N_WORLD_FIELDS: Final = 36
# Three more fields for each inter-neuron, NEURON further from one to the next.
Y: Final = (N_WORLD_FIELDS + 0) * N_LANES  # its state
Z: Final = (N_WORLD_FIELDS + 1) * N_LANES  # its output, sigmoid(y + beta)
DRIVE: Final = (N_WORLD_FIELDS + 2) * N_LANES  # drive of all inputs on it
N_NEURON_FIELDS: Final = 3
NEURON: Final = N_NEURON_FIELDS * N_LANES

# Fields of `n`.
CAMERA: Final = 0 * N_LANES  # nine bits, I3 lowest
TOUCH: Final = 1 * N_LANES  # two bits, I1 (right) lowest
NEAR: Final = 2 * N_LANES  # 1 if the arm moved, or has just started, and may meet a disc
SIDE: Final = 3 * N_LANES  # three fields: NONE, RIGHT or LEFT, where each disc touches
TARGET_SIDE: Final = 6 * N_LANES  # the same of the target
COLLIDED: Final = 7 * N_LANES  # 1 if a disc that is not the target touches S2
CRITERION: Final = 8 * N_LANES  # truth table of good steps, one bit for each situation
STEP: Final = 9 * N_LANES  # steps made
DONE: Final = 10 * N_LANES  # 1 when the trial has ended
TRIAL: Final = 11 * N_LANES  # which trial
WAIT: Final = 12 * N_LANES  # steps until the words change, NOT_SEEN or CHANGED
SEEN: Final = 13 * N_LANES  # 1 if the target is in view from the end of S1; kept where the camera is there
TARGET_BITS: Final = 14 * N_LANES  # the camera's bits of the target's colour
UNCLEAR: Final = 15 * N_LANES  # 1 if a disc is too close to a sector's edge to tell its side from J1
N_INTEGER_FIELDS: Final = 16

NONE: Final = 0
RIGHT: Final = 1
LEFT: Final = 2
NOT_SEEN: Final = -1
CHANGED: Final = -2
