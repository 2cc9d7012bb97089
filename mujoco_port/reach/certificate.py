"""The workspace certificate: what a robot's arm does everywhere the 2D arm can be.

A grid of all (alpha, beta) is walked four times, once stretching and bending at every alpha, once turning
from bound to bound at every beta, and both with the hand raised throughout, as it is above objects; always
in steps no wider than one of the 2D world. The posture at a place depends a little on the way there, and
what is told of a place is the worst of all walks.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from rich.progress import track

from arm2d.constants import ALPHA_MAX, ALPHA_MIN, BETA_MAX, BETA_MIN
from arm2d.readings import TURN_SETS
from arm2d.records import brief
from models.robots import Robot
from mujoco_port.reach.clearance import Clearance
from mujoco_port.reach.kinematics import ArmKinematics, OutOfReachError
from mujoco_port.reach.workspace import hand_headings, hand_targets

STEP_DEG: Final = TURN_SETS["degrees"][0]  # one turn of the 2D world
REACHED: Final = 1e-6  # [m], error below which a place counts as reached
MOST_TURN: Final = 0.15  # [rad], of a joint between neighbours of a full grid


@dataclass(frozen=True)
class Certificate:
    """What was measured on a grid; axes W walks, A alpha, B beta, J joints. Unreached places are NaN.

    Attributes:
        alpha: [A] in [deg].
        beta: [B] in [deg].
        angles: [W, A, B, J] in [rad].
        error: [W, A, B] in [m], from the hand to its target.
        room: [W, A, B] in [rad], from the nearest joint limit; negative beyond it.
        to_table: [W, A, B] in [m], least gap between the robot and the table; negative where they overlap.
        to_itself: [W, A, B] in [m], least gap between links that no common joint holds together.
        turn: [W, A, B] in [rad], largest turn of a joint in a step of the 2D world to any of four sides.
        roll_error: [W, A, B] in [rad], between the palm's wanted and real direction.
        heading_error: [W, A, B] in [rad].
        scale: [m/cm], of the map.
    """

    alpha: NDArray[np.float64]
    beta: NDArray[np.float64]
    angles: NDArray[np.float64]
    error: NDArray[np.float64]
    room: NDArray[np.float64]
    to_table: NDArray[np.float64]
    to_itself: NDArray[np.float64]
    turn: NDArray[np.float64]
    roll_error: NDArray[np.float64]
    heading_error: NDArray[np.float64]
    scale: float

    __repr__ = brief

    @property
    def reached(self) -> NDArray[np.bool_]:
        """[A, B], where both walks arrive."""
        return np.all(self.error <= REACHED, axis=0)

    def faults(self) -> list[str]:
        """What keeps this from being a certificate, in sentences; none if it is one."""
        found = []
        missed = self.reached.size - int(self.reached.sum())
        if missed:
            found.append(f"{missed} of {self.reached.size} places are not reached within {REACHED:g} m")
        for name, gap in (("the table", self.to_table), ("itself", self.to_itself)):
            met = int((np.nan_to_num(gap, nan=1.0) <= 0.0).any(axis=0).sum())
            if met:
                found.append(
                    f"in {met} places the robot meets {name}, by up to {-1e3 * np.nanmin(gap):.1f} mm"
                )
        if np.nanmin(self.room) < 0.0:
            found.append(f"a joint lies {-np.nanmin(self.room):.3f} rad beyond its limit")
        if np.nanmax(self.turn) > MOST_TURN:
            found.append(
                f"a joint turns by {np.nanmax(self.turn):.3f} rad to a neighbour, more than {MOST_TURN} rad"
            )
        return found

    @property
    def widest(self) -> float:
        """The widest step of the grid [deg]."""
        return float(max(np.diff(self.alpha).max(), np.diff(self.beta).max()))

    def summary(self) -> list[str]:
        """The result in sentences."""
        n_alpha, n_beta = self.reached.shape
        return [
            f"{self.reached.mean():.1%} of {n_alpha} x {n_beta} places, at most {self.widest:.2f} degrees "
            f"apart, are reached within {REACHED:g} m; the largest error is {np.nanmax(self.error):.0e} m.",
            f"Joints keep at least {np.degrees(np.nanmin(self.room)):.2f} degrees from their limits, and "
            f"turn by at most {np.nanmax(self.turn):.3f} rad between neighbours.",
            f"The robot stays {1e3 * np.nanmin(self.to_table):.1f} mm from the table and "
            f"{1e3 * np.nanmin(self.to_itself):.1f} mm from itself.",
            f"The palm is at most {np.degrees(np.nanmax(self.roll_error)):.1f} degrees off its wanted roll "
            f"(median {np.degrees(np.nanmedian(self.roll_error)):.1f}), and the hand at most "
            f"{np.degrees(np.nanmax(self.heading_error)):.1f} off its heading "
            f"(median {np.degrees(np.nanmedian(self.heading_error)):.1f}).",
        ]

    def arrays(self) -> dict[str, NDArray]:
        """All of it by name, as it is stored."""
        return {name: np.asarray(value) for name, value in vars(self).items()}


def check_step(step_deg: float) -> None:
    """Refuse a grid that is none by a ValueError."""
    if not step_deg > 0.0:
        raise ValueError(
            f"a step of {step_deg:g} degrees leads nowhere; give a positive one, such as {STEP_DEG:g}"
        )


def certify(robot: Robot, *, step_deg: float = STEP_DEG) -> Certificate:
    """Measure a robot on the grid of all (alpha, beta).

    Args:
        robot: Its record.
        step_deg: Widest step of the grid [deg]; the walks' steps are those of the 2D world in any case.

    Raises:
        ValueError: If `step_deg` is not positive, or nothing at all is reached.
    """
    check_step(step_deg)
    alpha, beta = _axis(ALPHA_MIN, ALPHA_MAX, step_deg), _axis(BETA_MIN, BETA_MAX, step_deg)
    n_joints, shape = len(robot.joints), (len(alpha), len(beta))
    low, high = ArmKinematics(robot), ArmKinematics(raised(robot))
    arms, clearance = (low, low, high, high), Clearance(robot)
    angles = np.full((len(arms), *shape, n_joints), np.nan)
    places = [_along_beta(*shape), _along_alpha(*shape)] * 2
    steps = [(walk, *place) for walk, places_of_walk in enumerate(places) for place in places_of_walk]
    result = {
        name: np.full((len(arms), *shape), np.nan)
        for name in ("error", "room", "to_table", "to_itself", "turn", "roll_error", "heading_error")
    }
    before: tuple[NDArray, float, float] | None = None
    for walk, i, j in track(steps, f"workspace of {robot.name}"):
        if (i, j) == places[walk][0]:
            before = None
        posture = _arrive(arms[walk], before, alpha[i], beta[j])
        if posture is None:
            result["error"][walk, i, j] = np.inf
            continue
        before = posture, alpha[i], beta[j]
        angles[walk, i, j] = posture
        for name, value in _measure(arms[walk], clearance, posture, alpha[i], beta[j]).items():
            result[name][walk, i, j] = value
    if not np.isfinite(result["error"]).any():
        raise ValueError(
            f"at {robot.plane.scale:g} m/cm '{robot.name}' reaches nothing of the workspace; "
            "choose a smaller scale"
        )
    return Certificate(alpha=alpha, beta=beta, angles=angles, scale=robot.plane.scale, **result)


def raised(robot: Robot) -> Robot:
    """The same robot, its table laid before, with its hand raised at every beta."""
    return replace(robot, plane=replace(robot.plane, lift_range=(BETA_MIN - 2.0, BETA_MIN - 1.0)))


def _axis(first: float, last: float, step: float) -> NDArray[np.float64]:
    return np.linspace(first, last, int(np.ceil((last - first) / step - 1e-9)) + 1)


def _along_beta(n_alpha: int, n_beta: int) -> list[tuple[int, int]]:
    """All places, back and forth in beta, from alpha to alpha; it starts bent, as a trial does."""
    down = range(n_beta - 1, -1, -1)
    return [(i, j) for i in range(n_alpha) for j in (down if i % 2 == 0 else reversed(down))]


def _along_alpha(n_alpha: int, n_beta: int) -> list[tuple[int, int]]:
    """All places, back and forth in alpha, from beta to beta."""
    across = range(n_alpha)
    return [(i, j) for j in range(n_beta - 1, -1, -1) for i in (across if j % 2 == 0 else reversed(across))]


def _arrive(
    kinematics: ArmKinematics, before: tuple[NDArray, float, float] | None, alpha: float, beta: float
) -> NDArray | None:
    """The posture at a place, reached from the last one in steps of the 2D world; None if out of reach."""
    plane = kinematics.robot.plane
    try:
        if before is None:
            target, heading = hand_targets(plane, alpha, beta), float(hand_headings(plane, alpha, beta))
            return kinematics.settle(target, heading)
        posture, last_alpha, last_beta = before
        n_steps = int(np.ceil(max(abs(alpha - last_alpha), abs(beta - last_beta)) / STEP_DEG - 1e-9))
        for part in np.arange(1, n_steps + 1) / n_steps:
            here = last_alpha + part * (alpha - last_alpha), last_beta + part * (beta - last_beta)
            posture = kinematics.step(posture, hand_targets(plane, *here), float(hand_headings(plane, *here)))
    except OutOfReachError:
        return None
    return posture


def _measure(
    kinematics: ArmKinematics, clearance: Clearance, posture: NDArray, alpha: float, beta: float
) -> dict[str, float]:
    robot, hand = kinematics.robot, kinematics.forward(posture)
    to_table, to_itself = clearance.measure(posture)
    return {
        "error": float(np.linalg.norm(hand.position - hand_targets(robot.plane, alpha, beta))),
        "room": float(np.minimum(posture - kinematics.lower, kinematics.upper - posture).min()),
        "to_table": to_table,
        "to_itself": to_itself,
        "turn": _widest_turn(kinematics, posture, alpha, beta),
        "roll_error": kinematics.roll_error(hand),
        "heading_error": kinematics.heading_error(hand, float(hand_headings(robot.plane, alpha, beta))),
    }


def _widest_turn(kinematics: ArmKinematics, posture: NDArray, alpha: float, beta: float) -> float:
    """The largest turn of a joint [rad] in the step from here to any of four sides."""
    plane, turns = kinematics.robot.plane, [0.0]
    for by_alpha, by_beta in ((STEP_DEG, 0.0), (-STEP_DEG, 0.0), (0.0, STEP_DEG), (0.0, -STEP_DEG)):
        side = np.clip(alpha + by_alpha, ALPHA_MIN, ALPHA_MAX), np.clip(beta + by_beta, BETA_MIN, BETA_MAX)
        try:
            there = kinematics.step(posture, hand_targets(plane, *side), float(hand_headings(plane, *side)))
        except OutOfReachError:
            continue  # told as unreached where it is a place of the grid
        turns.append(float(np.abs(there - posture).max()))
    return max(turns)
