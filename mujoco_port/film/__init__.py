"""What is seen: the stage, captions, videos, galleries and the two ports."""

from mujoco_port.neighbours import check

check()
