"""Pictures and videos of the planar world, in colours that everybody can tell apart and read."""

from itertools import combinations

import imageio.v2 as imageio
import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.colors import rgb_to_hsv, to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Wedge

from arm2d import Readings, draw_state, record_trial, render_video
from arm2d.drawing import FLOOR, OBJECT_COLOURS, Scene, arm_points, look, state_at
from arm2d.video import Panel
from tests.arm2d.controllers import one_trial, steady_controller

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

# What a matplotlibrc may ask for.
STRANGE = {"font.size": 30.0, "axes.facecolor": "red", "lines.linewidth": 9.0, "text.usetex": True}


@pytest.fixture(scope="module")
def record():
    trial = one_trial(1, 1, 60.0, {0: (150.0, 30.0), 1: (140.0, 62.0), 2: (150.0, 150.0)})
    return record_trial(steady_controller(0, -1), trial)


def pixels_like(picture, colour):
    """How many pixels of a frame [H, W, 3] have this colour."""
    return int((np.abs(picture / 255.0 - to_rgb(colour)).max(axis=-1) < 0.02).sum())


def test_frame_shows_all_three_discs_in_their_colours(record):
    picture = Panel(record, 480, 360).frame(0)
    assert picture.shape == (360, 480, 3)
    for colour in OBJECT_COLOURS.values():
        assert pixels_like(picture, colour) > 50


def test_picture_changes_when_the_arm_moves_and_only_then(record):
    panel = Panel(record, 480, 360, caption=False)
    start = panel.frame(0)
    assert not np.array_equal(panel.frame(1), start)
    np.testing.assert_array_equal(panel.frame(0), start)


def test_arm_is_drawn_with_its_lengths_and_angles():
    joint, tip = arm_points(90.0, 90.0)
    np.testing.assert_allclose(joint, [0, 100], atol=1e-12)
    np.testing.assert_allclose(tip, [-50, 100], atol=1e-12)


@pytest.mark.parametrize(("origin", "reach"), [("J1", 172.0), ("end", 72.0)])
def test_field_of_view_starts_where_the_camera_sits_and_ends_as_far_ahead(origin, reach):
    readings = Readings(camera_origin=origin)
    turning = one_trial(2, 1, 60.0, {1: (150.0, 150.0)})
    axes = Figure().add_subplot()
    scene = Scene(axes, record_trial(steady_controller(1, 0, readings), turning, readings))
    scene.show(10)
    wedges = [each for each in scene.moving if isinstance(each, Wedge)]
    eye = arm_points(60.0 + 10 * 2.9, 90.0)[0] if origin == "end" else (0.0, 0.0)
    for wedge in wedges:
        np.testing.assert_allclose(wedge.center, eye, atol=1e-9)
        assert wedge.r == pytest.approx(reach)
    edges = [(wedge.theta1 - 89.0, wedge.theta2 - 89.0) for wedge in wedges]
    np.testing.assert_allclose(edges, [(-15, -5), (-5, 5), (5, 15)])


def test_states_between_two_steps_lie_between_them(record):
    assert state_at(record, 0.5)[1] == pytest.approx((record.beta[0] + record.beta[1]) / 2)


def test_state_names_the_instruction(record):
    figure = Figure()
    axes = figure.add_subplot()
    draw_state(axes, record, record.steps)
    assert "TOUCH Green" in [text.get_text() for text in axes.texts]


def test_note_stands_under_the_instruction(record):
    axes = Figure().add_subplot()
    Scene(axes, record, note="run 7, trial 3")
    assert "run 7, trial 3" in [text.get_text() for text in axes.texts]


def test_last_state_says_how_the_trial_went(record):
    axes = Figure().add_subplot()
    scene = Scene(axes, record)
    scene.show(record.steps - 0.5)
    assert not any("carried out" in text.get_text() for text in axes.texts)
    scene.show(record.steps)
    assert f"carried out, {record.steps / 10} s" in [text.get_text() for text in axes.texts]


def test_small_picture_is_a_large_one_seen_from_afar(record):
    large = Panel(record, 960, 720).frame(5)
    small = Panel(record, 480, 360).frame(5)
    shares = [[pixels_like(each, OBJECT_COLOURS[2]) / each[..., 0].size] for each in (small, large)]
    assert shares[0] == pytest.approx(shares[1], rel=0.25)  # edges take a larger part of a small disc


def test_step_that_does_not_exist_is_refused(record):
    with pytest.raises(
        ValueError, match=f"step 251 does not exist; this trial has the states 0 to {record.steps}"
    ):
        draw_state(Figure().add_subplot(), record, 251)


def test_video_lasts_as_long_as_the_trial_and_its_hold(record, tmp_path):
    short = record_trial(steady_controller(0, 0), one_trial(2, 1, 60.0, {1: (150.0, 60.0)}))
    path = render_video(short, tmp_path / "trial.mp4")
    with imageio.get_reader(path) as reader:
        meta = reader.get_meta_data()
    assert meta["duration"] == pytest.approx(short.steps * 0.1 + 1.0, abs=0.1)
    assert [each.name for each in tmp_path.iterdir()] == ["trial.mp4"]


def test_video_of_another_kind_is_refused(record, tmp_path):
    with pytest.raises(ValueError, match=r"trial.gif does not end in .mp4"):
        render_video(record, tmp_path / "trial.gif")


def test_video_into_a_missing_folder_leaves_nothing_behind(record, tmp_path):
    with pytest.raises(OSError):  # noqa: PT011 - whichever the writer raises
        render_video(record, tmp_path / "missing" / "trial.mp4")
    assert not list(tmp_path.iterdir())


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


def test_a_style_is_in_force_only_while_it_is_asked_for():
    with mpl.rc_context(STRANGE):
        with look({"font.size": 7.0}):
            assert mpl.rcParams["font.size"] == 7.0
            assert mpl.rcParams["axes.facecolor"] == mpl.rcParamsDefault["axes.facecolor"]
            assert not mpl.rcParams["text.usetex"]
        assert mpl.rcParams["font.size"] == STRANGE["font.size"]


def test_a_films_frames_are_the_same_under_any_style(record):
    plain = Panel(record, 240, 180, note="a note").frame(2.5)
    with mpl.rc_context(STRANGE):
        assert np.array_equal(Panel(record, 240, 180, note="a note").frame(2.5), plain)
