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

As soon as the robot, or the target, touches another object the trial has failed, unless the goal is reached
in the same step of 0.1 s. `ignore_stops`, `run_counting`, `success` and `collision_penalty` mean here what
they mean in the plane.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import ActionWord, Readings
from arm2d.constants import BETA_MAX, DT, GOOD_STEPS_FOR_SUCCESS, MAX_STEPS, STRAIGHT
from arm2d.geometry import in_view
from mujoco_port.acting.contacts import ARM, HAND, OBJECT, RIGHT_SIDE
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
    fault, n = _first_fault(record), len(record.alpha)
    progress, goal = progress_of(record, readings)
    when = _first(progress >= goal - 1e-9)
    best = float(progress[: fault + 1].max(initial=0.0))
    if record.instruction.action is ActionWord.IGNORE and readings.ignore_stops == "never":
        return _after_the_whole_trial(record, readings, best, fault)
    if when < n and _in_time(record, readings, when, fault):
        return _at_the_goal(record, readings, float(progress[when]), when)
    if fault < n:
        return Verdict(False, "another object was touched", best, fault, True)
    return Verdict(False, _so_far(record, best, goal), best, n, False)


def _first(moments: NDArray[np.bool_]) -> int:
    """The first of these moments [N]; N if there is none."""
    return int(np.argmax(moments)) if moments.any() else len(moments)


def _first_fault(record: PhysicalRecord) -> int:
    """When the robot, or the target, first touches another object; N if never.

    Objects that stand beside the target may touch one another, as discs may overlap in the plane.
    """
    target = int(record.instruction.object)
    by_robot = (np.delete(record.contact, target, axis=1) & (HAND | ARM)).any(axis=1)
    return _first(by_robot | ((record.contact[:, target] & OBJECT) != 0))


def _in_time(record: PhysicalRecord, readings: Readings, when: int, fault: int) -> bool:
    """Whether the goal was reached before a fault, or in the same step.

    The plane scores the whole of its last step, also one that touches another object. Where such a touch cuts
    F1 whole, the trial has failed then.
    """
    if readings.collision_penalty == "whole" and record.instruction.action is not ActionWord.IGNORE:
        return when < fault
    step = _moments_of_a_step(record)
    return when // step <= fault // step


def _moments_of_a_step(record: PhysicalRecord) -> int:
    """Physics steps of a control step."""
    return round(DT / record.step_s)


def _so_far(record: PhysicalRecord, best: float, goal: float) -> str:
    unit = "degrees" if record.instruction.action is ActionWord.MOVE else "s"
    return f"{best:.1f} of {goal:g} {unit}"


def _at_the_goal(record: PhysicalRecord, readings: Readings, best: float, when: int) -> Verdict:
    """What it is worth to have done for as long as was asked.

    INDICATE has to point closely, too. The plane's trial ends at one of its steps, some moment of the last
    0.1 s: the best of these counts. Under the strict reading of success S2 has to be straight.
    """
    action = record.instruction.action
    off = float(_offsets(record)[max(0, when - _moments_of_a_step(record)) : when + 1].min())
    if action is ActionWord.INDICATE and off >= readings.target_cone:
        return Verdict(False, f"{off:.1f} degrees beside the object in the end", best, when, True)
    if readings.success == "f1_f2_f3" and action in (ActionWord.TOUCH, ActionWord.MOVE):
        straight = _straightness(record, readings, when)
        if straight <= STRAIGHT:
            bent = BETA_MAX * (1.0 - straight)
            return Verdict(False, f"S2 was bent by {bent:.1f} degrees", best, when, True)
    return Verdict(True, "carried out", best, when, True)


def _straightness(record: PhysicalRecord, readings: Readings, when: int) -> float:
    """F3: how straight S2 is while the target is in view, at the end or at its best."""
    control_step = np.arange(when + 1) // _moments_of_a_step(record) + 1
    beta = record.orders[np.minimum(control_step, record.steps), 1]
    straight = np.where(_in_view(record, readings)[: when + 1], 1.0 - beta / BETA_MAX, 0.0)
    return float(straight.max() if readings.f3_time == "best" else straight[-1])


def _after_the_whole_trial(record: PhysicalRecord, readings: Readings, best: float, fault: int) -> Verdict:
    """IGNORE where nothing but a touch ends a trial: 10 s away at some time, and away in the end."""
    end = min(fault, len(record.alpha) - 1, MAX_STEPS * _moments_of_a_step(record) - 1)
    ended = fault < len(record.alpha) or len(record.alpha) >= MAX_STEPS * _moments_of_a_step(record)
    if best < GOOD_TIME_S - 1e-9:
        reason = "another object was touched" if fault <= end else _so_far(record, best, GOOD_TIME_S)
        return Verdict(False, reason, best, end, ended)
    if end >= 0 and _in_view(record, readings)[end]:
        return Verdict(False, "the object is in view in the end", best, end, ended)
    return Verdict(True, "carried out", best, end, ended)


def progress_of(record: PhysicalRecord, readings: Readings) -> tuple[NDArray[np.float64], float]:
    """How far the robot has come, [N], and how far it has to: in [s], or [deg] for MOVE.

    Without a break, or all in all if that is how runs are counted.
    """
    good, target = _is_good(record, readings), int(record.instruction.object)
    in_all = readings.run_counting == "cumulative"
    if record.instruction.action is ActionWord.MOVE:
        return arcs(good, bearings(record)[:, target], in_all=in_all), readings.move_angle
    if in_all:
        return (record.step_s * np.cumsum(good)).astype(np.float64), GOOD_TIME_S
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


def arcs(
    good: NDArray[np.bool_], bearing: NDArray[np.float64], *, in_all: bool = False
) -> NDArray[np.float64]:
    """How far the bearing [N] in [deg] has changed while it was good, [N] in [deg].

    On end; with `in_all` the way of earlier moments is added to it, a way back taken off.
    """
    if in_all:
        moved = np.where(good & np.roll(good, 1), np.diff(bearing, prepend=bearing[:1]), 0.0)
        return np.abs(np.cumsum(moved)).astype(np.float64)
    index = np.arange(len(good))
    last_bad = np.maximum.accumulate(np.where(good, -1, index))
    return np.where(good, np.abs(bearing - bearing[np.maximum(last_bad, 0)]), 0.0)


def _in_view(record: PhysicalRecord, readings: Readings) -> NDArray[np.bool_]:
    """Whether the target is in view, [N]."""
    places = record.objects[:, int(record.instruction.object), :2] / record.scale
    return in_view(record.alpha, places, readings)


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
    return ~_in_view(record, readings) & ~touched
