"""exp, log, sine, cosine and arc tangent from + - * / and square root alone.

A C library's functions differ in the last bit from one processor or version to the next; IEEE 754
fixes only + - * / and square root. Functions built from those give the same bits on every x86-64
machine, run by plain Python or compiled by Numba: that makes a run reproducible to the bit.

Each is a series cut where the next term falls below half a unit in the last place, and accurate to
a few units (tests/arm2d/test_arithmetic.py compares them with 40-digit arithmetic).
"""

import math
from collections.abc import Callable
from typing import Any, Final

from numba.core import types
from numba.extending import intrinsic, overload, register_jitable

# Adding and subtracting 1.5 * 2**52 rounds a small double to the nearest whole number, and leaves
# that number in the lowest bits of the sum.
_ROUNDER: Final = 6755399441055744.0
_LOG2_E: Final = 1.4426950408889634
# ln 2 in two parts; whole multiples (up to 2**20) of the first are exact.
_LN2_HIGH: Final = 0.6931471803691238
_LN2_LOW: Final = 1.9082149292705877e-10
_RADIANS_PER_DEGREE: Final = math.pi / 180.0
_DEGREES_PER_RADIAN: Final = 180.0 / math.pi
# atan(k / 8) [rad], k = 0..8.
_ATAN_EIGHTHS: Final = (
    0.0,
    0.12435499454676144,
    0.24497866312686414,
    0.3587706702705722,
    0.4636476090008061,
    0.5585993153435624,
    0.6435011087932844,
    0.7188299996216245,
    0.7853981633974483,
)


def _power_of_two(rounded: float) -> float:
    """2**k, where k = `rounded` - _ROUNDER is a whole number in [-1022, 1023]."""
    return math.ldexp(1.0, int(rounded - _ROUNDER))


@intrinsic
def _power_of_two_from_bits(typing_context: Any, rounded: types.Type) -> tuple[Any, Callable]:
    """The same for compiled code: k is moved from the sum's lowest bits into the exponent."""

    def build(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        int64 = context.get_value_type(types.int64)
        bits = builder.bitcast(arguments[0], int64)
        exponent = builder.add(bits, int64(1023))
        return builder.bitcast(builder.shl(exponent, int64(52)), arguments[0].type)

    return types.float64(types.float64), build


@overload(_power_of_two, inline="always")
def _compiled_power_of_two(rounded):  # noqa: ANN001, ANN202 - Numba holds its signature against the lambda's
    return lambda rounded: _power_of_two_from_bits(rounded)  # type: ignore[call-arg] - Numba adds the context


@register_jitable
def _exp_parts(x: float) -> tuple[float, float, float]:
    """(a, b, p) with exp(x) = p a / b: p a power of two, a / b near 1.

    With r the rest of x / ln 2, exp(r) = (c + r) / (c - r), c = r coth(r / 2), an even function
    whose series in r**2 has the coefficients 2 B_2n / (2n)! (Bernoulli numbers).
    """
    rounded = x * _LOG2_E + _ROUNDER
    k = rounded - _ROUNDER
    r = x - k * _LN2_HIGH - k * _LN2_LOW
    z = r * r
    c = 2.0 + z * (
        1.0 / 6.0 + z * (-1.0 / 360.0 + z * (1.0 / 15120.0 + z * (-1.0 / 604800.0 + z * (1.0 / 23950080.0))))
    )
    return c + r, c - r, _power_of_two(rounded)


@register_jitable
def exp(x: float) -> float:
    """e**x for |x| <= 700."""
    above, below, power = _exp_parts(x)
    return power * above / below


@register_jitable
def sigmoid(x: float) -> float:
    """1 / (1 + e**-x) for |x| <= 700, with a single division."""
    above, below, power = _exp_parts(-x)
    return below / (below + power * above)


@register_jitable
def log(x: float) -> float:
    """Natural logarithm of a positive number.

    x = m 2**k with m in [0.7, 1.42); ln m = 2 artanh((m - 1) / (m + 1)), as a series.
    """
    m, k = math.frexp(x)
    if m < 0.7071067811865476:
        m, k = 2.0 * m, k - 1
    s = (m - 1.0) / (m + 1.0)
    z = s * s
    series = 0.0
    for n in range(23, 1, -2):
        series = z * (1.0 / n + series)
    return k * _LN2_HIGH + (2.0 * (s + s * series) + k * _LN2_LOW)


@register_jitable
def sin_cos(angle_deg: float) -> tuple[float, float]:
    """(sine, cosine) of an angle in degrees: Taylor series after taking off quarter turns."""
    if -44.9 < angle_deg < 44.9:  # no quarter turn to take off
        return _sin_cos_of_small(angle_deg * _RADIANS_PER_DEGREE)
    quarter = (angle_deg / 90.0 + _ROUNDER) - _ROUNDER
    sine, cosine = _sin_cos_of_small((angle_deg - 90.0 * quarter) * _RADIANS_PER_DEGREE)
    turns = int(quarter) % 4
    if turns == 0:
        return sine, cosine
    if turns == 1:
        return cosine, -sine
    if turns == 2:
        return -sine, -cosine
    return -cosine, sine


@register_jitable
def _sin_cos_of_small(r: float) -> tuple[float, float]:
    """(sine, cosine) of r in [-pi/4, pi/4]."""
    z = r * r
    sine, cosine = 0.0, 0.0
    for n in range(16, 0, -2):
        sine = (1.0 - sine) * z * (1.0 / (n * (n + 1)))
        cosine = (1.0 - cosine) * z * (1.0 / (n * (n - 1)))
    return r - r * sine, 1.0 - cosine


@register_jitable
def _atan_of_ratio(t: float) -> float:
    """Arc tangent of t in [0, 1], in radians: from the nearest eighth, then a Taylor series."""
    nearest = int(8.0 * t + 0.5)
    c = nearest / 8.0
    s = (t - c) / (1.0 + t * c)
    z = s * s
    series = 0.0
    for n in range(15, 1, -2):
        series = z * (1.0 / n - series)
    return _ATAN_EIGHTHS[nearest] + (s - s * series)


@register_jitable
def bearing(x: float, y: float) -> float:
    """Direction of the point (x, y) in degrees, in [-90, 270) (spec section 4)."""
    across, along = abs(x), abs(y)
    if across == 0.0 and along == 0.0:
        return 0.0
    if along <= across:
        angle = _atan_of_ratio(along / across) * _DEGREES_PER_RADIAN
    else:
        angle = 90.0 - _atan_of_ratio(across / along) * _DEGREES_PER_RADIAN
    if x < 0.0:
        angle = 180.0 - angle
        return angle if y >= 0.0 else 360.0 - angle
    return angle if y >= 0.0 else -angle
