"""exp, sine, cosine and arc tangent on a device: `arm2d.arithmetic` with the same sums in the same order."""

import warp as wp

from arm2d import arithmetic as plain
from arm2d.device import numbers as c

ROUNDER = wp.float64(plain._ROUNDER)
LOG2_E = wp.float64(plain._LOG2_E)
LN2_HIGH = wp.float64(plain._LN2_HIGH)
LN2_LOW = wp.float64(plain._LN2_LOW)
# The series of c = r coth(r / 2), from the constant on.
COTH_0 = wp.float64(2.0)
COTH_1 = wp.float64(1.0 / 6.0)
COTH_2 = wp.float64(-1.0 / 360.0)
COTH_3 = wp.float64(1.0 / 15120.0)
COTH_4 = wp.float64(-1.0 / 604800.0)
COTH_5 = wp.float64(1.0 / 23950080.0)
EXPONENT_BIAS = wp.int64(1023)
MANTISSA_BITS = wp.int64(52)

SMALL_ANGLE = wp.float64(44.9)
QUARTER = wp.float64(90.0)
EIGHT = wp.float64(8.0)
# 1 / (n (n + 1)) for sines and 1 / (n (n - 1)) for cosines, n = 16, 14 ... 2.
SINE_TERMS = wp.types.vector(8, wp.float64)(*(1.0 / (n * (n + 1)) for n in range(16, 0, -2)))
COSINE_TERMS = wp.types.vector(8, wp.float64)(*(1.0 / (n * (n - 1)) for n in range(16, 0, -2)))
# 1 / n, n = 15, 13 ... 3.
ATAN_TERMS = wp.types.vector(7, wp.float64)(*(1.0 / n for n in range(15, 1, -2)))
ATAN_EIGHTHS = wp.types.vector(9, wp.float64)(*plain._ATAN_EIGHTHS)


@wp.func
def power_of_two(rounded: wp.float64) -> wp.float64:
    """2**k, where k = `rounded` - ROUNDER is a whole number: moved from the lowest bits into the exponent."""
    bits = wp.cast(rounded, wp.int64)
    return wp.cast((bits + EXPONENT_BIAS) << MANTISSA_BITS, wp.float64)


@wp.func
def sigmoid(x: wp.float64) -> wp.float64:
    """1 / (1 + e**-x) for |x| <= 700, with a single division."""
    minus = -x
    rounded = minus * LOG2_E + ROUNDER
    k = rounded - ROUNDER
    r = minus - k * LN2_HIGH - k * LN2_LOW
    z = r * r
    c = COTH_0 + z * (COTH_1 + z * (COTH_2 + z * (COTH_3 + z * (COTH_4 + z * COTH_5))))
    above, below, power = c + r, c - r, power_of_two(rounded)
    return below / (below + power * above)


@wp.func
def sin_cos(angle_deg: wp.float64):
    """(sine, cosine) of an angle in degrees: Taylor series after taking off quarter turns."""
    if angle_deg > -SMALL_ANGLE and angle_deg < SMALL_ANGLE:  # no quarter turn to take off
        sine, cosine = sin_cos_of_small(angle_deg * c.RADIANS_PER_DEGREE)
        return sine, cosine
    quarter = (angle_deg / QUARTER + ROUNDER) - ROUNDER
    sine, cosine = sin_cos_of_small((angle_deg - QUARTER * quarter) * c.RADIANS_PER_DEGREE)
    turns = wp.int32(quarter) & 3
    if turns == 0:
        return sine, cosine
    if turns == 1:
        return cosine, -sine
    if turns == 2:
        return -sine, -cosine
    return -cosine, sine


@wp.func
def sin_cos_of_small(r: wp.float64):
    """(sine, cosine) of r in [-pi/4, pi/4]."""
    z = r * r
    sine = wp.float64(0.0)
    cosine = wp.float64(0.0)
    for n in range(8):
        sine = (c.ONE - sine) * z * SINE_TERMS[n]
        cosine = (c.ONE - cosine) * z * COSINE_TERMS[n]
    return r - r * sine, c.ONE - cosine


@wp.func
def atan_of_ratio(t: wp.float64) -> wp.float64:
    """Arc tangent of t in [0, 1], in radians: from the nearest eighth, then a Taylor series."""
    nearest = wp.int32(EIGHT * t + c.HALF)
    eighth = wp.float64(nearest) / EIGHT
    s = (t - eighth) / (c.ONE + t * eighth)
    z = s * s
    series = wp.float64(0.0)
    for n in range(7):
        series = z * (ATAN_TERMS[n] - series)
    return ATAN_EIGHTHS[nearest] + (s - s * series)


@wp.func
def bearing(x: wp.float64, y: wp.float64) -> wp.float64:
    """Direction of the point (x, y) in degrees, in [-90, 270)."""
    across, along = wp.abs(x), wp.abs(y)
    if across == c.ZERO and along == c.ZERO:
        return c.ZERO
    angle = wp.float64(0.0)
    if along <= across:
        angle = atan_of_ratio(along / across) * c.DEGREES_PER_RADIAN
    else:
        angle = QUARTER - atan_of_ratio(across / along) * c.DEGREES_PER_RADIAN
    if x < c.ZERO:
        angle = c.HALF_TURN - angle
        if y >= c.ZERO:
            return angle
        return c.WHOLE_TURN - angle
    if y >= c.ZERO:
        return angle
    return -angle
