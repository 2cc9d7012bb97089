"""The workspace certificate: what it measures, what it finds wrong, what the command says and writes."""

from dataclasses import replace

import numpy as np
import pytest

from evolution.cli import main
from evolution.runs.storage import read_arrays
from mujoco_port.reach.certificate import MOST_TURN, STEP_DEG, _along_alpha, _along_beta, certify
from mujoco_port.reach.clearance import Clearance
from mujoco_port.reach.workspace import hand_headings, hand_targets

COARSE_DEG = 30.0  # the whole grid takes ten seconds; the walks' steps are the same
COARSEST_DEG = 120.0


@pytest.fixture(scope="module")
def certificate(robot):
    return certify(robot, step_deg=COARSE_DEG)


def test_robot_reaches_everything_and_meets_nothing(certificate):
    assert certificate.reached.all()
    assert certificate.faults() == []
    assert certificate.to_table.min() > 0.0
    assert certificate.to_itself.min() > 0.0
    assert certificate.room.min() >= 0.0
    assert certificate.turn.max() <= MOST_TURN


def test_grid_covers_the_workspace_in_steps_that_were_asked_for(certificate):
    assert (certificate.alpha[0], certificate.alpha[-1]) == (-30.0, 210.0)
    assert (certificate.beta[0], certificate.beta[-1]) == (0.0, 90.0)
    assert certificate.widest <= COARSE_DEG


def test_postures_of_all_walks_hold_the_hand_at_the_target_two_of_them_raised(certificate, robot, kinematics):
    for walk, above in zip(certificate.angles, (0.0, 0.0, 1.0, 1.0), strict=True):
        for i, j in ((0, 0), (3, 2), (-1, -1)):
            target = hand_targets(robot.plane, certificate.alpha[i], certificate.beta[j], above)
            assert np.linalg.norm(kinematics.forward(walk[i, j]).position - target) <= certificate.error.max()


def test_walks_start_bent_and_go_from_place_to_neighbouring_place():
    """To and fro in beta from alpha to alpha, or in alpha from beta to beta."""
    assert _along_beta(2, 3) == [(0, 2), (0, 1), (0, 0), (1, 0), (1, 1), (1, 2)]
    assert _along_alpha(3, 2) == [(2, 1), (1, 1), (0, 1), (0, 0), (1, 0), (2, 0)]


def test_the_turn_told_of_a_place_is_the_widest_of_those_to_its_four_sides(certificate, kinematics):
    plane = kinematics.robot.plane
    for i, j in np.ndindex(certificate.turn.shape[1:]):
        posture, alpha, beta = certificate.angles[0, i, j], certificate.alpha[i], certificate.beta[j]
        turns = []
        for by_alpha, by_beta in ((2.9, 0.0), (-2.9, 0.0), (0.0, 2.9), (0.0, -2.9)):
            side = np.clip(alpha + by_alpha, -30.0, 210.0), np.clip(beta + by_beta, 0.0, 90.0)
            heading = float(hand_headings(plane, *side))
            turns.append(
                np.abs(kinematics.step(posture, hand_targets(plane, *side), heading) - posture).max()
            )
        assert certificate.turn[0, i, j] == max(turns)


def test_faults_are_counted_place_by_place(certificate):
    """Two walks may fail at one place; unequal numbers of everything."""
    error, table, itself = (np.full_like(certificate.error, 0.0) for _ in range(3))
    table[:], itself[:] = 0.1, 0.1
    error[:2, 0, 0] = error[3, 1, 1] = error[0, 2, 2] = 1.0
    table[1, 0, 1], table[2, 0, 1] = -0.002, -0.005
    itself[0, 3, :2], itself[1, 3, 0] = 0.0, -0.0011
    itself[2, 4, 0] = np.nan
    room, turn = certificate.room.copy(), certificate.turn.copy()
    room[0, 0, 0], turn[3, 2, 1] = -0.25, 0.512
    made_up = replace(certificate, error=error, to_table=table, to_itself=itself, room=room, turn=turn)
    assert made_up.faults() == [
        f"3 of {error[0].size} places are not reached within 1e-06 m",
        "in 1 places the robot meets the table, by up to 5.0 mm",
        "in 2 places the robot meets itself, by up to 1.1 mm",
        "a joint lies 0.250 rad beyond its limit",
        "a joint turns by 0.512 rad to a neighbour, more than 0.15 rad",
    ]


def test_default_step_is_a_turn_of_the_2d_world_and_not_wider():
    assert STEP_DEG == 2.9


def test_world_too_large_for_the_arm_is_told(robot):
    large = replace(robot, plane=replace(robot.plane, scale=0.004))
    certificate = certify(large, step_deg=COARSEST_DEG)
    assert not certificate.reached.all()
    assert np.isnan(certificate.angles[~np.isfinite(certificate.error)]).all()
    assert "places are not reached within 1e-06 m" in certificate.faults()[0]


def test_robot_that_stands_too_low_meets_the_table(robot):
    x, y, z = robot.base_position
    low = replace(robot, base_position=(x, y + 0.15, z - 0.15))
    faults = " ".join(certify(low, step_deg=COARSEST_DEG).faults())
    assert "the robot meets the table" in faults


def test_moved_robot_has_the_gaps_of_one_built_there(robot, kinematics):
    place = (-0.05, -0.35, 0.10)
    moved = Clearance(robot)
    moved.stand(place)
    built = Clearance(replace(robot, base_position=place))
    np.testing.assert_allclose(moved.measure(kinematics.rest), built.measure(kinematics.rest), atol=1e-9)


def test_hand_in_the_belly_is_an_overlap(robot, kinematics):
    """An arm that hangs straight down with this torso passes through the hip."""
    _, to_itself = Clearance(robot).measure(np.zeros(len(kinematics.rest)))
    assert to_itself < 0.0


def test_command_writes_what_it_measured_and_says_so(robot, tmp_path, capsys):
    code = main(["workspace", "--step-deg", str(COARSEST_DEG), "--output", str(tmp_path)])
    said = capsys.readouterr().out
    assert code == 0
    assert "100.0% of 3 x 2 places" in said
    stored = read_arrays(tmp_path / "workspace-icub.npz")
    assert stored["angles"].shape == (4, 3, 2, len(robot.joints))
    assert float(stored["scale"]) == robot.plane.scale
    assert sorted(path.suffix for path in tmp_path.iterdir()) == [".npz", ".png", ".svg"]


def test_command_fails_where_the_arm_does_not_reach(tmp_path, capsys):
    arguments = ["--step-deg", str(COARSEST_DEG), "--scale", "0.004", "--output", str(tmp_path)]
    assert main(["workspace", *arguments]) == 1
    assert "Not certified: " in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--scale", "0"], "a scale of 0 m/cm is no map; give a positive one, such as 0.002"),
        (["--step-deg", "-1"], "a step of -1 degrees leads nowhere; give a positive one, such as 2.9"),
        (
            ["--scale", "9", "--step-deg", "120"],
            "'icub' reaches nothing of the workspace; choose a smaller scale",
        ),
        (["--robot", "nao"], "unknown robot 'nao'"),
    ],
)
def test_bad_input_gets_one_sentence_and_writes_nothing(arguments, sentence, tmp_path, capsys):
    assert main(["workspace", *arguments, "--output", str(tmp_path / "new")]) == 2
    said = capsys.readouterr().err
    assert sentence in said
    assert said.count("\n") == 1
    assert not any(tmp_path.rglob("*.npz"))
