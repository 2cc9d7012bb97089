"""Whether everybody can tell the three objects apart, and read their names."""

from itertools import combinations

import numpy as np
import pytest
from matplotlib.colors import rgb_to_hsv, to_rgb

from arm2d.drawing import FLOOR, OBJECT_COLOURS

# From linear RGB to linear RGB as it is seen without one kind of cone (Machado, Oliveira and Fernandes, IEEE
# TVCG 15(6), 2009, severity 1).
SIGHT = {
    "all cones": np.eye(3),
    "no long cones": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "no middle cones": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "no short cones": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}
XYZ_OF_RGB = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
WHITE = XYZ_OF_RGB.sum(axis=1)
APART = 30.0  # CIE 1976 colour difference; some 2.3 are just noticeable
# Hues [deg] that people name so, and how far others reach on either side.
HUES = {"BLUE": 225.0, "GREEN": 145.0, "RED": 360.0}
READABLE = 3.0  # contrast with the floor, of large letters and marks (WCAG 2.1)


def linear(colour):
    """Linear RGB [3] of a colour of the screen (sRGB)."""
    value = np.array(to_rgb(colour))
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def lab(rgb):
    """CIE L*a*b* [3] of linear RGB."""
    share = XYZ_OF_RGB @ np.clip(rgb, 0.0, 1.0) / WHITE
    x, y, z = np.where(share > 0.008856, np.cbrt(share), 7.787 * share + 16 / 116)
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


@pytest.mark.parametrize("sight", SIGHT)
def test_any_two_objects_can_be_told_apart(sight):
    seen = [lab(np.array(SIGHT[sight]) @ linear(colour)) for colour in OBJECT_COLOURS.values()]
    for one, other in combinations(seen, 2):
        assert np.linalg.norm(one - other) > APART


def test_the_colours_are_what_the_words_say():
    for word, colour in OBJECT_COLOURS.items():
        hue, saturation, value = rgb_to_hsv(to_rgb(colour))
        off = (360.0 * hue - HUES[word.name] + 180.0) % 360.0 - 180.0
        assert abs(off) < 15.0
        assert saturation > 0.7
        assert value > 0.6


def test_words_in_these_colours_can_be_read():
    def luminance(colour):
        return XYZ_OF_RGB[1] @ linear(colour)

    for colour in OBJECT_COLOURS.values():
        assert (luminance(FLOOR) + 0.05) / (luminance(colour) + 0.05) > READABLE
