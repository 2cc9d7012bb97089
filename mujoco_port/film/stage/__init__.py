"""The robot at its table, drawn off-screen: the stage, its views, cameras and lamps."""

from mujoco_port.film.stage.stage import Stage as Stage
