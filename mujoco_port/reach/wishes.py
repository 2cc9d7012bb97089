"""What a robot's record is wished to give: a cost over walks through the workspace, for the search.

The walks' steps are those of the 2D world, and they go to and fro: what an arm did before must not matter.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d.constants import ALPHA_MAX, ALPHA_MIN, BETA_MAX, BETA_MIN
from arm2d.readings import TURN_SETS
from models.robots import Robot
from mujoco_port.reach.clearance import Clearance
from mujoco_port.reach.kinematics import ArmKinematics, OutOfReachError
from mujoco_port.reach.workspace import hand_headings, hand_targets

TURN_DEG: Final = TURN_SETS["degrees"][0]  # a step of the 2D world
SWEEPS_DEG: Final = (90.0, 30.0, 20.0, 0.0)  # beta of walks from bound to bound: bent, half lifted, straight
STRETCHES_DEG: Final = (-30.0, 30.0, 90.0, 150.0, 195.0, 210.0)  # alpha of walks from bent to straight
# alpha at which walks begin that turn S1 while S2 stretches, and to which side: at the bounds many joints are
# near their limits at once.
DIAGONALS_DEG: Final = ((60.0, -1), (30.0, -1), (210.0, -1), (121.0, 1), (150.0, 1), (180.0, 1))
# Walks into the corner at the left bound, where the hand passes before the body: at a beta to the bound, and
# along it to the other end of beta.
CORNER_FROM_DEG: Final = 150.0
CORNER_BETAS_DEG: Final = (90.0, 45.0)
CORNER_DEG: Final = (193.0, 35.0)  # least alpha and beta
# Clearance is costly to measure and changes slowly: it is taken at the ends of walks and every so many steps
# between, in the corner more often.
CHECKED_EVERY: Final = 13
CHECKED_IN_CORNER: Final = 3


# Where contacts are made, S2 nearly straight and S1 on a sector, the hand's pose counts this many times.
COUNTS: Final = 4.0
STRAIGHT_DEG: Final = 12.0
SECTORS_DEG: Final = (20.0, 160.0)

# What is wished, and what a lack of it costs. The prices are chosen so that reach comes first, then gaps and
# turns, and so that the soft wishes are of one size, some tenths, when all is well.
MOST_TILT: Final = np.radians(12.0)
MOST_TURN: Final = 0.10  # [rad], of a joint in a step; the project promises 0.15
LEAST_GAPS_M: Final = (0.008, 0.006)  # to the table, and between links
LEAST_ROOM: Final = 0.03  # of a joint's range, to its limits
PRICE_OF_MISS: Final = 3.0  # for each target
PRICE_OF_TILT: Final = 8.0  # for the mean square [rad^2]
PRICE_OF_MOST_TILT: Final = 10.0  # for each rad more than wished
PRICE_OF_HEADING: Final = 10.0  # for the mean square [rad^2], the square cut at 2
PRICE_OF_GAP: Final = 100.0  # for each m of the largest lack
PRICE_OF_GAPS: Final = 4e3  # for the mean squared lack [m^2]
PRICE_OF_TURN: Final = 0.3  # for each rad of the largest turn
PRICE_OF_MOST_TURN: Final = 20.0  # for each rad more than wished
PRICE_OF_ROOM: Final = 2.0  # for the mean lack, as a share of what is wished
PRICE_OF_LEANING: Final = 0.5  # for the mean square of the torso's angles [rad^2]


@dataclass(frozen=True)
class Cost:
    """What a record costs, wish by wish; 0 would be perfect."""

    reach: float
    roll: float = 0.0
    heading: float = 0.0
    table: float = 0.0
    body: float = 0.0
    turn: float = 0.0
    limits: float = 0.0
    leaning: float = 0.0

    @property
    def total(self) -> float:
        """The sum."""
        return sum(getattr(self, each.name) for each in fields(self))


@dataclass
class Seen:
    """What the walks have shown: one entry for each place, gap or step."""

    missed: int = 0
    angles: list[NDArray[np.float64]] = field(default_factory=list)  # [J] each
    tilts: list[float] = field(default_factory=list)
    headings: list[float] = field(default_factory=list)
    counts: list[float] = field(default_factory=list)
    turns: list[float] = field(default_factory=list)
    gaps: list[tuple[float, float]] = field(default_factory=list)


class Wishes:
    """The cost of variations of one robot's record; they differ in place and posture only."""

    def __init__(self, robot: Robot) -> None:
        self._clearance = Clearance(robot)
        self._walks = walks()

    def cost(self, robot: Robot) -> Cost:
        """Give what a record costs."""
        kinematics, seen = ArmKinematics(robot), Seen()
        self._clearance.stand(robot.base_position)
        for alpha, beta in self._walks:
            walk(kinematics, alpha, beta, seen, self._clearance.measure)
        return priced(seen, kinematics)


def walks() -> list[tuple[NDArray, NDArray]]:
    """(alpha, beta) [deg] of walks in steps of the 2D world: to and fro, stretching, and both at once."""
    down = np.append(np.arange(BETA_MAX, BETA_MIN, -TURN_DEG), BETA_MIN)
    steps = TURN_DEG * np.arange(len(down))
    return [
        _to_and_fro(),
        *((np.full_like(down, alpha), down) for alpha in STRETCHES_DEG),
        *((np.clip(alpha + sign * steps, ALPHA_MIN, ALPHA_MAX), down) for alpha, sign in DIAGONALS_DEG),
        *(_into_the_corner(beta) for beta in CORNER_BETAS_DEG),
    ]


def _into_the_corner(bend: float) -> tuple[NDArray, NDArray]:
    """One walk at a beta to the left bound, and along it until S2 is straight (or bent, from half bent)."""
    across = np.append(np.arange(CORNER_FROM_DEG, ALPHA_MAX, TURN_DEG), ALPHA_MAX)
    end = BETA_MIN if bend == BETA_MAX else BETA_MAX
    along = np.append(np.arange(bend, end, np.copysign(TURN_DEG, end - bend)), end)[1:]
    alpha = np.concatenate([across, np.full(len(along), ALPHA_MAX)])
    return alpha, np.concatenate([np.full(len(across), bend), along])


def _to_and_fro() -> tuple[NDArray, NDArray]:
    """One walk from bound to bound and back, beta by beta."""
    across = np.append(np.arange(ALPHA_MIN, ALPHA_MAX, TURN_DEG), ALPHA_MAX)
    alpha, beta = [], []
    for nth, (bend, following) in enumerate(zip(SWEEPS_DEG, (*SWEEPS_DEG[1:], None), strict=True)):
        sweep = across if nth % 2 == 0 else across[::-1]
        stretch = [] if following is None else np.arange(bend - TURN_DEG, following, -TURN_DEG)
        alpha += [*sweep, *np.full(len(stretch), sweep[-1])]
        beta += [*np.full(len(sweep), bend), *stretch]
    return np.array(alpha), np.array(beta)


def walk(
    kinematics: ArmKinematics,
    alpha: NDArray[np.float64],
    beta: NDArray[np.float64],
    seen: Seen,
    gaps: Callable[[NDArray[np.float64]], tuple[float, float]],
) -> None:
    """Follow one walk [K] in [deg] and add to what was seen; it ends where the arm does not reach."""
    plane = kinematics.robot.plane
    targets, headings = hand_targets(plane, alpha, beta), hand_headings(plane, alpha, beta)
    corner = (alpha > CORNER_DEG[0]) & (beta > CORNER_DEG[1])
    matters = (beta < STRAIGHT_DEG) & (alpha > SECTORS_DEG[0]) & (alpha < SECTORS_DEG[1])
    posture = None
    for k, (target, heading) in enumerate(zip(targets, headings, strict=True)):
        before = posture
        try:
            posture = (
                kinematics.settle(target, heading)
                if before is None
                else kinematics.step(before, target, heading)
            )
        except OutOfReachError:
            seen.missed += len(targets) - k
            return
        if before is not None:
            seen.turns.append(float(np.abs(posture - before).max()))
        if k % (CHECKED_IN_CORNER if corner[k] else CHECKED_EVERY) == 0 or k == len(targets) - 1:
            seen.gaps.append(gaps(posture))
        hand = kinematics.forward(posture)
        seen.angles.append(posture)
        seen.tilts.append(kinematics.roll_error(hand))
        seen.headings.append(kinematics.heading_error(hand, heading))
        seen.counts.append(COUNTS if matters[k] else 1.0)


def priced(seen: Seen, kinematics: ArmKinematics) -> Cost:
    """Give what all that was seen costs."""
    reach = PRICE_OF_MISS * seen.missed
    if not seen.turns:
        return Cost(reach)
    angles, tilts, headings = np.array(seen.angles), np.array(seen.tilts), np.array(seen.headings)
    share = np.array(seen.counts) / np.sum(seen.counts)
    room = np.minimum(angles - kinematics.lower, kinematics.upper - angles)
    room = (room / (kinematics.upper - kinematics.lower)).min(axis=1)
    lacks = np.maximum(np.array(LEAST_GAPS_M) - np.array(seen.gaps), 0.0)
    table, body = PRICE_OF_GAP * lacks.max(axis=0) + PRICE_OF_GAPS * (lacks**2).mean(axis=0)
    most = max(seen.turns)
    torso = [name.startswith("torso") for name in kinematics.robot.joints]
    return Cost(
        reach=reach,
        roll=PRICE_OF_TILT * float(share @ tilts**2)
        + PRICE_OF_MOST_TILT * max(float(tilts.max()) - MOST_TILT, 0.0),
        heading=PRICE_OF_HEADING * float(share @ np.minimum(headings**2, 2.0)),
        table=float(table),
        body=float(body),
        turn=PRICE_OF_TURN * most + PRICE_OF_MOST_TURN * max(most - MOST_TURN, 0.0),
        limits=PRICE_OF_ROOM * float(np.maximum(1.0 - room / LEAST_ROOM, 0.0).mean()),
        leaning=PRICE_OF_LEANING * float((angles[:, torso] ** 2).sum(axis=1).mean()),
    )
