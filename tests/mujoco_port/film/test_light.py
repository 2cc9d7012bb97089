"""The planar world as light on the table: in register with the robot, and below what stands there."""

from dataclasses import replace

import numpy as np
import pytest

from arm2d import Readings
from arm2d.drawing import arm_points
from models.build import HAND_SITE, VISUAL_GROUP
from mujoco_port.film.light import S2_HALF, ground, shine_state
from mujoco_port.film.quality import QUALITIES
from mujoco_port.film.stage import Stage
from mujoco_port.film.take import kinematic_take

MILLIMETRE = 1e-3
NO_RINGS = np.empty((0, 3))
SLACK = 0.004


@pytest.fixture(scope="module")
def stage(robot):
    quality = replace(QUALITIES["draft"], oversampling=1)
    with Stage(robot, 800, 720, quality) as stage:
        yield stage


def test_what_stands_on_the_stage_plays_the_discs_of_the_world(robot):
    with Stage(robot, 64, 64, QUALITIES["draft"], Readings(object_radius=8.0)) as stage:
        assert stage.model.geom("red").size[0] == pytest.approx(0.0224)
        assert stage.robot.plane.object_radius == pytest.approx(0.0224)


def brightened(stage, centre):
    """How much brighter pixels of a square of the table become by the arm's light, and their places [cm]."""
    arm, stage._back.arm = stage._back.arm, None
    without = stage.close_up(centre, 0.1, 500).astype(int)
    stage._back.arm = arm
    lit = stage.close_up(centre, 0.1, 500).astype(int) - without
    near = stage._near
    on_table = np.abs(near._distance - near._ground.distance) < SLACK / 4  # else it is the beam to the hand
    return lit.sum(axis=-1) * on_table, near._ground.places


@pytest.mark.parametrize("share", [0.0, 0.3, 0.6, 1.0])
def test_the_light_of_s2_ends_straight_below_the_hand_to_a_millimetre(stage, robot, champion_records, share):
    record = next(each for each in champion_records if each.success and each.contact.any())
    take = kinematic_take(record, robot, 1)
    moment = round(share * (len(take.steps) - 1))
    stage.pose(take.angles[moment], take.objects[moment] + 1.0)  # no object in the way of the light
    stage.shine(*take.planar[moment])
    hand = stage.data.site_xpos[stage.model.site(HAND_SITE).id].copy()
    stage._back.option.geomgroup[VISUAL_GROUP] = 0  # nor the robot
    lit, places = brightened(stage, hand[:2])
    stage._back.option.geomgroup[VISUAL_GROUP] = 1
    joint, tip = arm_points(*take.planar[moment])
    along = (tip - joint) / np.linalg.norm(tip - joint)
    side = np.array([-along[1], along[0]])
    from_hand = places - hand[:2] / robot.plane.scale
    u, v = from_hand @ along, from_hand @ side
    full = lit > 0.8 * lit.max()
    one = MILLIMETRE / robot.plane.scale  # [cm] of the planar world
    assert u[full].max() == pytest.approx(S2_HALF, abs=one)
    behind = full & (u > -8.0) & (u < -2.0)
    assert (v[behind].max() + v[behind].min()) / 2 == pytest.approx(0.0, abs=one)


def flat(places):
    """A grey picture that shows the table only, and its ground."""
    distance = np.ones(places.shape[:2], np.float32)
    picture = np.full((*places.shape[:2], 3), 60, np.uint8)
    return picture, distance, ground(places.astype(np.float32), distance, Readings())


@pytest.mark.parametrize("origin", ["J1", "end"])
@pytest.mark.parametrize("alpha", [20.0, 90.0, 175.0])
def test_the_camera_lights_what_it_sees_from_where_it_sits(origin, alpha):
    readings = replace(Readings(), camera_origin=origin)
    angle = np.radians(alpha)
    eye = 100.0 * np.array([np.cos(angle), np.sin(angle)]) if origin == "end" else np.zeros(2)
    offsets = np.radians(alpha + np.array([-16.0, -14.0, -6.0, 0.0, 6.0, 14.0, 16.0]))
    far = 60.0 if origin == "end" else 130.0  # beyond S2, which is bent
    places = (eye + far * np.stack([np.cos(offsets), np.sin(offsets)], axis=-1))[None]
    picture, distance, lit = flat(places)
    lit = replace(lit, light=np.zeros_like(lit.light))
    shine_state(picture, distance, lit, alpha, 90.0, NO_RINGS, readings, SLACK)
    seen = picture[0, :, 0].astype(int) - 60
    assert (seen[[0, -1]] < 5).all()  # no more than the arm's glow
    assert (seen[[1, 2, 4, 5]] > 10).all()
    assert seen[3] > seen[[1, 2, 4, 5]].max()


def test_light_lies_below_what_stands_on_the_table():
    places = np.array([[[50.0, 0.0], [50.0, 0.0]]])
    picture, distance, lit = flat(places)
    distance = distance - np.array([[0.0, 0.05]], np.float32)  # the second pixel shows something nearer
    shine_state(picture, distance, lit, 0.0, 90.0, NO_RINGS, Readings(), SLACK)
    assert picture[0, 0, 0] > 200
    assert (picture[0, 1] == 60).all()


def test_start_areas_and_chords_are_drawn_where_readings_have_them():
    angles = np.radians([50.0, 60.0, 120.0, 130.0])
    places = 100.0 * np.stack([np.cos(angles), np.sin(angles)], axis=-1)[None]
    strength = flat(np.repeat(places, 2, axis=0))[2].light[0, :, 3]
    assert strength[1] > 2 * strength[0]
    assert strength[2] > 2 * strength[3]


def test_one_who_faces_the_robot_sees_its_left_on_the_right(stage):
    places = stage._front._ground.places
    row = places.shape[0] * 3 // 4
    assert (np.diff(places[row, ::50, 0]) < 0.0).all()  # x, to the robot's right, falls from left to right
    assert places[row, 0, 1] == pytest.approx(places[row, -1, 1], abs=0.5)  # and the table does not lean
