"""The elementary functions of arm2d.arithmetic against numpy's, compiled against plain."""

import numba
import numpy as np
import pytest

from arm2d import arithmetic

RNG = np.random.default_rng(1)
ULP = np.finfo(float).eps

CASES = {
    "exp": (arithmetic.exp, RNG.uniform(-300, 300, 5000), np.exp),
    "sigmoid": (arithmetic.sigmoid, RNG.uniform(-200, 200, 5000), lambda x: 1 / (1 + np.exp(-x))),
    "log": (arithmetic.log, 10 ** RNG.uniform(-17, 17, 5000), np.log),
}


@pytest.mark.parametrize("name", CASES)
def test_function_is_within_four_units_in_the_last_place(name):
    function, x, expected = CASES[name]
    values = np.array([function(each) for each in x])
    np.testing.assert_allclose(values, expected(x), rtol=4 * ULP, atol=2 * ULP)


def test_sine_and_cosine_are_within_two_epsilons():
    angles = np.concatenate([RNG.uniform(-720, 720, 5000), np.arange(-720.0, 721.0, 15.0)])
    sines, cosines = np.array([arithmetic.sin_cos(each) for each in angles]).T
    # The reference itself loses a few bits in converting large angles to radians.
    np.testing.assert_allclose(sines, np.sin(np.radians(angles)), atol=12 * ULP)
    np.testing.assert_allclose(cosines, np.cos(np.radians(angles)), atol=12 * ULP)


def test_quarter_turns_have_exact_sines():
    assert [arithmetic.sin_cos(a) for a in (0.0, 90.0, 180.0)] == [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0)]


def test_angles_without_a_quarter_turn_have_the_bits_of_the_series_alone():
    """The short way is taken below 44.9 degrees; from there to 45 the long way has to agree with it."""
    angles = np.linspace(-44.999, 44.999, 20001)
    short = [arithmetic._sin_cos_of_small(each * arithmetic._RADIANS_PER_DEGREE) for each in angles]
    compiled = numba.njit(arithmetic.sin_cos, error_model="numpy")
    np.testing.assert_array_equal([arithmetic.sin_cos(each) for each in angles], short)
    np.testing.assert_array_equal([compiled(each) for each in angles], short)


def test_bearing_gives_the_direction_between_minus_90_and_270():
    x, y = RNG.normal(size=(2, 5000))
    bearings = np.array([arithmetic.bearing(a, b) for a, b in zip(x, y, strict=True)])
    expected = (np.degrees(np.arctan2(y, x)) + 90) % 360 - 90
    np.testing.assert_allclose(bearings, expected, rtol=4 * ULP, atol=1e-13)
    assert bearings.min() >= -90
    assert bearings.max() < 270


def test_bearing_of_the_axes_is_exact():
    points = [(1.0, 0.0), (0.0, 2.0), (-3.0, 0.0), (0.0, -1.0)]
    assert [arithmetic.bearing(*point) for point in points] == [0.0, 90.0, 180.0, -90.0]


@pytest.mark.parametrize("name", CASES)
def test_compiled_function_gives_the_same_bits_as_plain_python(name):
    function, x, _ = CASES[name]
    compiled = numba.njit(function, error_model="numpy")
    np.testing.assert_array_equal([compiled(each) for each in x], [function(each) for each in x])
