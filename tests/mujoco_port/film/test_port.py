"""Trials as videos and pictures of the robot; and what bad input gets."""

import imageio.v3 as imageio
import numpy as np
import pytest

from arm2d import NON_EXPERIENCED
from arm2d.drawing import OBJECT_COLOURS
from models.robots import UnknownRobotError
from mujoco_port.film.gallery import CELL_WIDTH, GAP, HEADER
from mujoco_port.film.gallery import HOLD_S as GALLERY_HOLD_S
from mujoco_port.film.gallery import frames as gallery_frames
from mujoco_port.film.kinematic import FRAMES_PER_STEP, moments, roll_out
from mujoco_port.film.port import port_gallery, port_picture, port_trial
from mujoco_port.film.stage import Stage
from mujoco_port.film.take import kinematic_take
from mujoco_port.film.video import PER_SECOND
from mujoco_port.reach.workspace import on_table, tip_in_plane


@pytest.fixture(scope="module")
def shortest(champion_records):
    return min((each for each in champion_records if each.success), key=lambda each: each.steps)


def test_hand_target_is_the_end_of_s2_laid_on_the_table(robot, shortest):
    rollout = roll_out(shortest, robot, frames_per_step=1)
    tip = tip_in_plane(shortest.alpha, shortest.beta)
    np.testing.assert_allclose(rollout.targets[:, :2], robot.plane.scale * tip, atol=1e-12)
    np.testing.assert_allclose(rollout.objects, robot.plane.scale * shortest.discs, atol=1e-12)


def test_whole_steps_of_a_rollout_are_the_states_of_the_record(robot, shortest):
    rollout = roll_out(shortest, robot, frames_per_step=2)
    whole = rollout.steps % 1 == 0
    assert whole.sum() == shortest.steps + 1
    np.testing.assert_array_equal(rollout.objects[whole], on_table(robot.plane, shortest.discs))


def test_last_moment_of_a_rollout_is_the_end_of_the_trial():
    np.testing.assert_allclose(moments(3, 2.5), [0, 0.4, 0.8, 1.2, 1.6, 2.0, 2.4, 2.8, 3.0])
    np.testing.assert_array_equal(moments(3, 1), [0, 1, 2, 3])


@pytest.mark.slow
def test_video_shows_robot_and_plane_in_real_time(shortest, tmp_path):
    path = port_trial(shortest, tmp_path / "trial.mp4", quality="draft")
    meta = imageio.immeta(path, plugin="FFMPEG")
    assert meta["size"] == (1280, 720)
    assert meta["fps"] == 10 * FRAMES_PER_STEP
    assert meta["duration"] == pytest.approx(shortest.steps * 0.1 + 1.0, abs=0.2)
    assert [each.name for each in tmp_path.iterdir()] == ["trial.mp4"]


def test_picture_shows_all_objects_and_nothing_is_black(shortest, tmp_path):
    picture = imageio.imread(port_picture(shortest, 0, tmp_path / "start.png"))
    robot_view = picture[:, :800].astype(float) / 255
    for colour in OBJECT_COLOURS.values():
        rgb = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255
        direction = (
            robot_view @ rgb / np.maximum(np.linalg.norm(robot_view, axis=-1) * np.linalg.norm(rgb), 1e-9)
        )
        saturated = robot_view.max(axis=-1) - robot_view.min(axis=-1) > 0.25
        assert ((direction > 0.97) & saturated).sum() > 300, colour
    assert (robot_view.max(axis=-1) < 0.04).mean() < 0.005


@pytest.fixture(scope="module")
def stage(robot):
    with Stage(robot, 400, 360) as stage:
        yield stage


def test_picture_over_the_backdrop_is_the_one_that_is_drawn_at_once(robot, shortest, monkeypatch):
    monkeypatch.setattr("mujoco_port.film.stage.view.dimmed", np.copy)  # only a backdrop is dimmed
    take = kinematic_take(shortest, robot, 1)
    with Stage(robot, 400, 360) as stage:
        pictures = [pictures_of(stage, take, k) for k in (0, len(take.steps) // 2, -1)]
    for over, at_once in pictures:
        difference = np.abs(over.astype(int) - at_once).max(axis=-1)
        assert (difference > 8).mean() < 0.002  # the robot's own shadow on the floor may be missing


def pictures_of(stage, take, moment):
    """One moment over the backdrop, and drawn at once."""
    stage.pose(take.angles[moment], take.objects[moment])
    stage.highlight(take.touched[moment])
    return stage.picture(), stage.picture_at_once()


def test_touched_object_glows_and_the_others_do_not(stage, robot, shortest):
    take = kinematic_take(shortest, robot, 1)
    stage.pose(take.angles[0], take.objects[0])
    stage.highlight(np.zeros(3, bool))
    dark = stage.picture().astype(int)
    stage.highlight(np.array([False, True, False]))
    lit = stage.picture().astype(int)
    rows, columns = np.nonzero(np.abs(lit - dark).max(axis=-1) > 20)
    assert len(rows) > 200
    assert (lit[rows, columns].sum(axis=-1) > dark[rows, columns].sum(axis=-1)).mean() > 0.95
    # A ring and a cylinder: all in one place, far smaller than the picture.
    assert np.ptp(rows) < 80
    assert np.ptp(columns) < 60
    stage.highlight(np.zeros(3, bool))
    np.testing.assert_array_equal(stage.picture(), dark)


def test_what_glows_is_what_is_touched_in_the_planar_world(robot, champion_records):
    record = next(each for each in champion_records if each.contact.any())
    take = kinematic_take(record, robot, 1)
    np.testing.assert_array_equal(take.touched, record.contact != 0)


def test_a_gallery_goes_on_until_the_longest_trial_has_ended(robot, champion_records):
    """Two cells stand for nine: one frame of each moment, the last ones held."""
    short, long = sorted(champion_records, key=lambda each: each.steps)[:2]
    takes = [kinematic_take(record, robot, 0.2) for record in (short, long)]
    pictures = list(gallery_frames(takes, robot, "two of nine"))
    n_held = round(GALLERY_HOLD_S * PER_SECOND)
    assert len(pictures) == max(len(take.steps) for take in takes) + n_held
    assert {picture.shape for picture in pictures} == {(1080, 1920, 3)}
    first, last = pictures[0].astype(int), pictures[-1].astype(int)
    np.testing.assert_array_equal(last, pictures[-n_held])
    assert (np.abs(first - last)[HEADER:, : CELL_WIDTH + GAP] > 30).any()  # the verdict, if nothing else
    dark = (last < 40).all(axis=-1)
    for k, take in enumerate(takes):
        edge = dark[HEADER, GAP + k * (CELL_WIDTH + GAP) : GAP + k * (CELL_WIDTH + GAP) + CELL_WIDTH]
        assert edge.all() == (take.record.instruction in NON_EXPERIENCED)


def test_a_gallery_of_too_few_trials_is_refused(shortest, tmp_path):
    with pytest.raises(ValueError, match="a gallery has 9 trials, not 1; give one per instruction"):
        port_gallery([shortest], "one", tmp_path / "gallery.mp4")


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (
            lambda r, d: port_trial(r, d / "x.mp4", robot="nao"),
            UnknownRobotError,
            "unknown robot 'nao'; there are: icub, icub-erd",
        ),
        (
            lambda r, d: port_trial(r, d / "x.mp4", quality="best"),
            ValueError,
            "unknown quality 'best'; there are: draft, normal, high",
        ),
        (lambda r, d: port_trial(r, d / "x.avi"), ValueError, "does not end in .mp4"),
        (lambda r, d: port_trial(r, d / "no" / "x.mp4"), OSError, "its folder is missing or read-only"),
        (lambda r, d: port_picture(r, 9999, d / "x.png"), ValueError, "step 9999 does not exist"),
    ],
)
def test_bad_input_gets_one_sentence_and_leaves_nothing(call, error, message, shortest, tmp_path):
    with pytest.raises(error, match=message):
        call(shortest, tmp_path)
    assert not list(tmp_path.iterdir())
