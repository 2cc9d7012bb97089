"""Whether a robot has carried out its instruction: the criteria of the 2D world (section VI) in 3D.

Judged is what happened to the objects, moment by moment of the physics. S1 exists on the robot as a direction
only: the one that was ordered.

    INDICATE   10 s on end: the target's bearing within 4.6 degrees of S1 (30 if the reading `indicate_angle`
               is wide, but 4.6 in the end, as F1 asks), and nothing touches the target
    TOUCH      10 s on end: on target, the hand's little-finger side on the target, S1 at rest
    MOVE       on target and the hand's little-finger side on the target, from a touch on, until the target's
               bearing has changed by 34.4 degrees; it stands upright all the while
    IGNORE     10 s on end: the target neither in view nor touched; in view is what lies within 15 degrees of
               S1, seen from J1, or from S1's end where the camera is there

As soon as the robot, or the target, touches another object the trial has failed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import ActionWord, Readings
from arm2d.constants import DT, GOOD_STEPS_FOR_SUCCESS
from arm2d.geometry import in_view
from mujoco_port.acting.contacts import RIGHT_SIDE
from mujoco_port.acting.rollout import PhysicalRecord

GOOD_TIME_S: Final = DT * GOOD_STEPS_FOR_SUCCESS
# Contacts of two hard bodies chatter. A break of at most this long is none.
LONGEST_BREAK_S: Final = 0.02
UPRIGHT: Final = float(
    np.cos(np.radians(10.0))
)  # a cylinder of 17 mm falls at 37, the narrowest, of 8 mm, at 20


@dataclass(frozen=True)
class Verdict:
    """What became of an instruction.

    Attributes:
        success: Whether it was carried out.
        reason: In words, why not or how.
        progress: Seconds, or degrees for MOVE, of what was asked that were reached.
        end: The physics step at which this was certain; N if it never was.
        certain: Whether nothing that comes later can change it.
    """

    success: bool
    reason: str
    progress: float
    end: int
    certain: bool


def judge(record: PhysicalRecord, readings: Readings) -> Verdict:
    """Judge what a robot has done so far."""
    action, target = record.instruction.action, int(record.instruction.object)
    others = np.delete(record.contact, target, axis=1).any(axis=1)
    n = len(record.alpha)
    fault = int(np.argmax(others)) if others.any() else n
    progress, goal = progress_of(record, readings)
    reached = progress >= goal - 1e-9
    when = int(np.argmax(reached)) if reached.any() else n
    best = float(progress[: fault + 1].max(initial=0.0))
    if when < fault:
        return _at_the_goal(record, readings, best, when)
    if others.any():
        return Verdict(False, "another object was touched", best, fault, True)
    unit = "degrees" if action is ActionWord.MOVE else "s"
    return Verdict(False, f"{best:.1f} of {goal:g} {unit}", best, n, False)


def _at_the_goal(record: PhysicalRecord, readings: Readings, best: float, when: int) -> Verdict:
    """What it is worth to have done for as long as was asked: INDICATE has to point closely, too.

    The plane's trial ends at one of its steps, some moment of the last 0.1 s: the best of these counts.
    """
    step = round(DT / record.step_s)
    off = float(_offsets(record)[max(0, when - step) : when + 1].min())
    if record.instruction.action is ActionWord.INDICATE and off >= readings.target_cone:
        return Verdict(False, f"{off:.1f} degrees beside the object in the end", best, when, True)
    return Verdict(True, "carried out", best, when, True)


def progress_of(record: PhysicalRecord, readings: Readings) -> tuple[NDArray[np.float64], float]:
    """How far the robot has come without a break, [N], and how far it has to: in [s], or [deg] for MOVE."""
    good, target = _is_good(record, readings), int(record.instruction.object)
    if record.instruction.action is ActionWord.MOVE:
        return arcs(good, bearings(record)[:, target]), readings.move_angle
    return lengths(good, record.step_s), GOOD_TIME_S


def _offsets(record: PhysicalRecord) -> NDArray[np.float64]:
    """How far the target's bearing is from S1, [N] in [deg]."""
    return np.abs(bearings(record)[:, int(record.instruction.object)] - record.alpha)


def bearings(record: PhysicalRecord) -> NDArray[np.float64]:
    """Bearings of the objects from J1, [N, 3] in [deg], in [-90, 270)."""
    x, y = record.objects[..., 0], record.objects[..., 1]
    degrees = np.degrees(np.arctan2(y, x))
    return np.where(degrees < -90.0, degrees + 360.0, degrees)


def closed(good: NDArray[np.bool_], gap: int) -> NDArray[np.bool_]:
    """The same moments [N], with breaks of at most `gap` moments between two good ones closed."""
    edges = np.flatnonzero(np.diff(good.astype(np.int8), prepend=0, append=0))
    starts, ends = edges[::2], edges[1::2]
    whole = good.copy()
    for end, start in zip(ends[:-1], starts[1:], strict=True):
        if start - end <= gap:
            whole[end:start] = True
    return whole


def lengths(good: NDArray[np.bool_], step_s: float) -> NDArray[np.float64]:
    """How long it has been good on end, [N] in [s], of moments that are `step_s` [s] apart."""
    index = np.arange(1, len(good) + 1)
    return (step_s * (index - np.maximum.accumulate(np.where(good, 0, index)))).astype(np.float64)


def arcs(good: NDArray[np.bool_], bearing: NDArray[np.float64]) -> NDArray[np.float64]:
    """How far the bearing [N] in [deg] has changed since it has been good on end, [N] in [deg]."""
    index = np.arange(len(good))
    last_bad = np.maximum.accumulate(np.where(good, -1, index))
    return np.where(good, np.abs(bearing - bearing[np.maximum(last_bad, 0)]), 0.0)


def _is_good(record: PhysicalRecord, readings: Readings) -> NDArray[np.bool_]:
    """The moments that count, [N]."""
    action, target = record.instruction.action, int(record.instruction.object)
    off = _offsets(record)
    touched = record.contact[:, target] != 0
    right = closed((record.contact[:, target] & RIGHT_SIDE) != 0, round(LONGEST_BREAK_S / record.step_s))
    if action is ActionWord.INDICATE:
        return (off < readings.indicate_cone) & ~touched
    if action is ActionWord.TOUCH:
        return (off < readings.target_cone) & right & record.still
    if action is ActionWord.MOVE:
        return (off < readings.target_cone) & right & (record.upright[:, target] > UPRIGHT)
    seen = in_view(record.alpha, record.objects[:, target, :2] / record.scale, readings)
    return ~seen & ~touched
