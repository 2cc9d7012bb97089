"""From the plane to the robot: the map to the table, inverse kinematics, gaze, the workspace certificate."""

from mujoco_port.neighbours import check

check()
