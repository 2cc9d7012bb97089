"""The robot acts: motors, contacts, eyes, open and closed loop, the verdict in three dimensions."""

from mujoco_port.neighbours import check

check()
