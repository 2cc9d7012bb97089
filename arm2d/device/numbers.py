"""Constants of the world as Warp's kernels read them; a bare Python number would be of 32 bits there."""

from math import pi

import warp as wp

from arm2d import constants as c
from arm2d.kernel import lanes, scores
from arm2d.network.genes import genes_of

# Where the parameters of the paper's network stand, the only one that a device runs.
GENES = genes_of(c.N_INTER)

ALPHA_MIN = wp.float64(c.ALPHA_MIN)
ALPHA_MAX = wp.float64(c.ALPHA_MAX)
BETA_MIN = wp.float64(c.BETA_MIN)
BETA_MAX = wp.float64(c.BETA_MAX)
S1_LENGTH = wp.float64(c.S1_LENGTH)
S2_LENGTH = wp.float64(c.S2_LENGTH)
DT = wp.float64(c.DT)
VIEW = wp.float64(c.VIEW_HALF_WIDTH)
MIDDLE = wp.float64(c.MIDDLE_SECTOR_HALF_WIDTH)
TWICE_TOUCH_TOLERANCE = wp.float64(2.0 * c.TOUCH_TOLERANCE)
THRESHOLD_TOLERANCE = wp.float64(c.THRESHOLD_TOLERANCE)
COLLISION_FACTOR = wp.float64(c.COLLISION_FACTOR)
GOOD_STEPS = wp.float64(c.GOOD_STEPS_FOR_SUCCESS)
NEVER = wp.float64(2.0 * c.MAX_STEPS)
ENOUGH_STRETCH = wp.float64(c.STRAIGHT)
ZERO = wp.float64(0.0)
ONE = wp.float64(1.0)
HALF_TURN = wp.float64(180.0)
WHOLE_TURN = wp.float64(360.0)
BETA_KEYS_PER_DEGREE = wp.float64(10.0)
HALF = wp.float64(0.5)

RADIANS_PER_DEGREE = wp.float64(pi / 180.0)
DEGREES_PER_RADIAN = wp.float64(180.0 / pi)

MAX_STEPS = wp.int32(c.MAX_STEPS)
SUB_STEPS = wp.int32(c.SUB_STEPS)
SUB_STEPS_FLOAT = wp.float64(c.SUB_STEPS)

NONE = wp.int32(lanes.NONE)
RIGHT = wp.int32(lanes.RIGHT)
LEFT = wp.int32(lanes.LEFT)
NOT_SEEN = wp.int32(lanes.NOT_SEEN)
CHANGED = wp.int32(lanes.CHANGED)

MOVE = wp.int32(scores.MOVE)
TOUCH = wp.int32(scores.TOUCH)
INDICATE = wp.int32(scores.INDICATE)
IGNORE = wp.int32(scores.IGNORE)
