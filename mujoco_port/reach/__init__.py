"""From the plane to the robot: the map to the table, inverse kinematics, the gaze, the workspace certificate."""

from mujoco_port.neighbours import check

check()
