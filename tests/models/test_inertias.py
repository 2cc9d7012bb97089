"""Links whose inertia no body can have are named, and physics on such a robot is refused."""

import mujoco
import numpy as np
import pytest

from models.inertias import fault, unsound_inertias
from models.physics import NoPhysicsError, build_physics_model
from models.robots import get_robot


@pytest.mark.parametrize(
    ("mass", "principal", "reason"),
    [
        (1.0, [0.1, 0.2, 0.3], ""),  # a flat plate: the largest is the sum of the others
        (1.0, [0.1, 0.1, 0.3], "a moment of 0.3 kg m^2, more than the 0.2 of the others together"),
        (1.0, [-0.1, 0.2, 0.3], "a moment of -0.1 kg m^2"),
        (1.5, [0.0, 0.0, 0.0], "1.5 kg without inertia"),
        (0.0, [0.0, 0.0, 0.0], ""),  # the frame of a sensor
        (mujoco.mjMINVAL, [0.0, 0.0, 0.0], ""),  # MuJoCo takes it for none
    ],
)
def test_moments_of_a_body_are_positive_and_obey_the_triangle_inequality(mass, principal, reason):
    assert fault(mass, np.array(principal)) == reason


def test_the_default_robot_is_sound():
    assert unsound_inertias(get_robot("icub")) == ()


def test_unsound_links_are_named_with_their_reason():
    found = {each.link: each.reason for each in unsound_inertias(get_robot("icub-erd"))}
    assert found["head"] == "1.34 kg without inertia"
    assert found["r_wrist_1"] == "0.1 kg without inertia"
    assert "chest" not in found
    assert "imu_frame" not in found  # no mass


def test_physics_on_an_unsound_robot_is_refused_with_the_names():
    with pytest.raises(
        NoPhysicsError, match=r"robot 'icub-erd' has \d+ links that cannot act: .*head \(1\.34"
    ):
        build_physics_model(get_robot("icub-erd"))
