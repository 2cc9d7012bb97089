"""Layout of the lanes: trials that advance side by side, one field after the other.

Quantity F of lane i stands at `F + i` in the flat array of floats `s` or of integers `n`. Fields at
constant distances in one array let LLVM see that they do not overlap, so loops over lanes vectorise.
"""

from typing import Final

N_LANES: Final = 32
# Loops run over whole blocks of lanes; idle lanes hold the finite values of an ended trial.
BLOCK: Final = 8

# Fields of `s`.
ALPHA: Final = 0 * N_LANES  # angle of S1 [deg]
TURN: Final = 1 * N_LANES  # S1's last turn after clipping [deg]
Y: Final = 2 * N_LANES  # three fields: states of the inter-neurons
Z: Final = 5 * N_LANES  # three fields: their outputs, sigmoid(y + beta)
WORDS: Final = 8 * N_LANES  # three fields: drive of the instruction on each inter-neuron
DRIVE: Final = 11 * N_LANES  # three fields: drive of all 18 inputs
BEARING: Final = 14 * N_LANES  # three fields: each disc's bearing [deg]
LOW: Final = 17 * N_LANES  # three fields: right edge of what the camera sees of a disc [deg]
HIGH: Final = 20 * N_LANES  # three fields: left edge
DISTANCE: Final = 23 * N_LANES  # three fields: each disc's distance from J1 [cm]
NEAREST: Final = 26 * N_LANES  # least of the three distances [cm]
TARGET: Final = 27 * N_LANES  # bearing of the target [deg]
CONE: Final = 28 * N_LANES  # a good step's largest distance from the target [deg]
GOAL: Final = 29 * N_LANES  # the run that ends the trial, in steps or [deg]
COUNT: Final = 30 * N_LANES  # what a good step adds to the run ...
PUSH: Final = 31 * N_LANES  # ... and what each degree of its turn adds
RUN: Final = 32 * N_LANES  # current run of good steps, or of turns [deg]
BEST: Final = 33 * N_LANES  # largest run so far
FIRST_OFFSET: Final = 34 * N_LANES  # d_i [deg]
STRETCH: Final = 35 * N_LANES  # largest 1 - beta / 90 with the target in view
N_FLOAT_FIELDS: Final = 36

# Fields of `n`.
BETA: Final = 0 * N_LANES  # index of beta on its grid
NEXT_BETA: Final = 1 * N_LANES  # the same after the turn of this step
CAMERA: Final = 2 * N_LANES  # nine bits, I3 lowest
TOUCH: Final = 3 * N_LANES  # two bits, I1 (right) lowest
SIDE: Final = 4 * N_LANES  # three fields: NONE, RIGHT or LEFT, where each disc touches
TARGET_SIDE: Final = 7 * N_LANES  # the same of the target
COLLIDED: Final = 8 * N_LANES  # 1 if a disc that is not the target touches S2
CRITERION: Final = 9 * N_LANES  # truth table of good steps, one bit for each situation
STEP: Final = 10 * N_LANES  # steps made
DONE: Final = 11 * N_LANES  # 1 when the trial has ended
TRIAL: Final = 12 * N_LANES  # which trial
WAIT: Final = 13 * N_LANES  # steps until the words change; NOT_SEEN before the target was in view
N_INTEGER_FIELDS: Final = 14

NONE: Final = 0
RIGHT: Final = 1
LEFT: Final = 2
NOT_SEEN: Final = -1
CHANGED: Final = -2
