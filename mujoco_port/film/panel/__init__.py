"""The picture of an agent's mind beside the robot, and what all pictures share."""

from mujoco_port.film.panel.panel import MindPanel as MindPanel
from mujoco_port.film.panel.sheet import BADGE as BADGE
from mujoco_port.film.panel.sheet import FAINT as FAINT
from mujoco_port.film.panel.sheet import UNLIT as UNLIT
from mujoco_port.film.panel.sheet import WIDTH as WIDTH
from mujoco_port.film.panel.sheet import blank as blank
from mujoco_port.film.panel.sheet import mark as mark
from mujoco_port.film.panel.sheet import pixels as pixels
