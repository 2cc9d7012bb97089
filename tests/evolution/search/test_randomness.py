import math
from itertools import product

import numpy as np

from evolution.search.randomness import Purpose, draw_gaussian, fill_gaussian, generator


def test_the_same_seed_purpose_and_generation_give_the_same_numbers():
    one, other = (generator(7, Purpose.TRIALS, 42).random(5) for _ in range(2))
    assert one.tolist() == other.tolist()


def test_no_two_purposes_generations_or_seeds_share_their_numbers():
    keys = list(product([0, 1, 2**32, 2**63 - 1], Purpose, [0, 1, 5999]))
    firsts = {generator(*key).random() for key in keys}
    assert len(firsts) == len(keys)


def test_the_numbers_never_change():
    """Stored runs can be rebuilt only while these stand."""
    names = ["INITIAL_GENOTYPES", "TRIALS", "PARENTS", "MUTATION", "CHAMPION", "EVALUATION", "RECORDING"]
    assert [Purpose[each] for each in names] == list(range(7))
    assert generator(7, Purpose.MUTATION, 42).random() == 0.2498559524989411


def test_compiled_numbers_have_the_bits_of_plain_python():
    uniform = np.random.default_rng(0).random((2, 10_000))
    compiled, plain = np.empty(10_000), np.empty(10_000)
    fill_gaussian(*uniform, compiled)
    fill_gaussian.py_func(*uniform, plain)
    assert np.array_equal(compiled, plain)


def test_numbers_are_those_of_the_c_library_up_to_its_own_errors():
    radial, angular = np.random.default_rng(1).random((2, 10_000))
    numbers = np.empty(10_000)
    fill_gaussian(radial, angular, numbers)
    expected = np.sqrt(-2.0 * np.log1p(-radial)) * np.cos(2.0 * math.pi * angular)
    # 2 pi angular is off by 4e-16 relative, times a radius of up to 5.
    assert np.abs(numbers - expected).max() < 1e-14


def test_the_ends_of_the_uniform_interval_give_finite_numbers():
    ends = np.array([0.0, 1.0 - 2.0**-53])
    for angular in ends:
        numbers = np.empty(2)
        fill_gaussian(ends, np.full(2, angular), numbers)
        assert np.isfinite(numbers).all()
        assert abs(numbers[0]) == 0.0
        # sqrt(2 * 53 * ln 2), the largest number there is.
        assert math.isclose(numbers[1], 8.571674348652905)


def test_drawing_none_is_possible():
    assert draw_gaussian(0, np.random.default_rng(0)).shape == (0,)
