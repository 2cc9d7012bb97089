"""What is filmed of a trial that a robot has carried out by itself."""

from __future__ import annotations

import numpy as np

from arm2d import TrialRecord
from mujoco_port.acting.rollout import PhysicalRecord
from mujoco_port.acting.verdict import Verdict
from mujoco_port.film.kinematic import FRAMES_PER_STEP
from mujoco_port.film.take import Take


def physical_take(planar: TrialRecord, record: PhysicalRecord, verdict: Verdict) -> Take:
    """A trial that the robot has carried out by itself, objects where they were pushed to.

    Args:
        planar: The same trial in the planar world.
        record: What the robot did.
        verdict: What became of it.
    """
    rows_per_step = len(record.alpha) // record.steps
    rows = np.arange(0, len(record.alpha), round(rows_per_step / FRAMES_PER_STEP))
    verdicts = (("planar world", planar.success), ("robot", verdict.success))
    touched = record.contact[rows] != 0
    return Take(planar, rows / rows_per_step, record.angles[rows], record.places[rows], touched, verdicts)
