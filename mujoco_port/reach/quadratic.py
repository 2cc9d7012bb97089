"""The compiled part of the inverse kinematics: two kinds of step, both a small quadratic programme.

    minimise    1/2 d' H d + g' d
    subject to  J d = e,   lower <= d <= upper

An active set on the bounds: the free joints solve the problem with equalities only, by the Schur complement
of H; the joint that leaves its range furthest is then held at its bound, and a held joint that would rather
come back is released. With ten joints and three rows that takes one or two microseconds.

All compiled functions stand in this one file: the cache notices changes in a function's own file only.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from arm2d.compiling import compiled

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Flags = NDArray[np.bool_]

MAX_CHANGES = 40  # of the active set; each holds or releases one joint, a handful is usual
RELEASE_TOLERANCE = 1e-10  # on a multiplier, so that rounding does not hold and release in turn
# Added to the diagonal of J H^-1 J', relative to its trace. It keeps a stretched or blocked arm solvable,
# at the price of a step that falls a little short; the next step makes up for it.
RELATIVE_DAMPING = 1e-12
MAX_STEP = 0.3  # [rad], of one joint in one step: beyond, the linear model says little


@compiled
def relaxed(
    angles: Floats,
    jacobian: Floats,
    hand: Floats,
    error: Floats,
    heading: float,
    down: Floats,
    rest: Floats,
    weights: Floats,
    wishes: Floats,
    lower: Floats,
    upper: Floats,
) -> Floats:
    """Give the angles [J] after a proximal Gauss-Newton step on position, rest, heading and level together.

    Args:
        angles: q, [J] in [rad].
        jacobian: [6, J], of the hand, linear over angular, in world axes.
        hand: [3, 3], rotation of the hand; x along the fingers, z out of the palm.
        error: [3] in [m], from the hand to the target.
        heading: [rad], wanted direction of the fingers in the plane.
        down: [3], direction in the hand's frame that is to point down.
        rest: [J] in [rad].
        weights: [J], cost of the squared distance to `rest`.
        wishes: [3], cost of squared heading error, squared tilt and squared step.
        lower: [J] in [rad].
        upper: [J] in [rad].
    """
    n = angles.size
    rows = np.empty((3, n))  # derivatives of heading and of the two components of the tilt
    x = hand[:, 0]
    z = down[0] * hand[:, 0] + down[1] * hand[:, 1] + down[2] * hand[:, 2]
    flat = max(x[0] * x[0] + x[1] * x[1], 1e-6)
    for j in range(n):
        wx, wy, wz = jacobian[3, j], jacobian[4, j], jacobian[5, j]
        rows[0, j] = wz - x[2] * (wx * x[0] + wy * x[1]) / flat  # d atan2(x_y, x_x), as dx = w cross x
        rows[1, j], rows[2, j] = -wy, wx
    off = np.arctan2(x[1], x[0]) - heading
    off -= 2 * np.pi * np.round(off / (2 * np.pi))
    # The tilt is the angle from z to (0, 0, -1), not its sine: a hand that lies on its back must want to turn
    # over. With these rows its gradient is exact and its Hessian not too small.
    sine = np.sqrt(z[0] * z[0] + z[1] * z[1])
    stretch = np.arctan2(sine, -z[2]) / max(sine, 1e-9)
    residuals = (wishes[0] * off, wishes[1] * stretch * z[0], wishes[1] * stretch * z[1])
    costs = (wishes[0], wishes[1], wishes[1])

    hessian = np.zeros((n, n))
    gradient = np.empty(n)
    for i in range(n):
        gradient[i] = weights[i] * (angles[i] - rest[i])
        for r in range(3):
            gradient[i] += rows[r, i] * residuals[r]
            for j in range(i + 1):
                hessian[i, j] += costs[r] * rows[r, i] * rows[r, j]
                hessian[j, i] = hessian[i, j]
        hessian[i, i] += weights[i] + wishes[2]
    return bounded(hessian, gradient, jacobian, error, angles, lower, upper)


@compiled
def bounded(
    hessian: Floats,
    gradient: Floats,
    jacobian: Floats,
    error: Floats,
    angles: Floats,
    lower: Floats,
    upper: Floats,
) -> Floats:
    """Give the angles [J] after the step that solves the programme within the joint limits and `MAX_STEP`."""
    down = np.maximum(lower - angles, -MAX_STEP)
    up = np.minimum(upper - angles, MAX_STEP)
    step = solve_bounded(hessian, gradient, jacobian, error, down, up)
    return np.minimum(np.maximum(angles + step, lower), upper)  # rounding may exceed a limit by an ulp


@compiled
def solve_bounded(
    hessian: Floats, gradient: Floats, jacobian: Floats, error: Floats, lower: Floats, upper: Floats
) -> Floats:
    """Solve the programme above.

    Args:
        hessian: H, [n, n], symmetric and positive definite.
        gradient: g, [n].
        jacobian: J, [at least m, n]; rows beyond the m of `error` play no part.
        error: e, [m].
        lower: [n], at most 0.
        upper: [n], at least 0.

    Returns:
        d, [n], within the bounds; J d = e as nearly as they allow for.
    """
    n = gradient.size
    step = np.zeros(n)
    held = np.zeros(n, dtype=np.bool_)
    for _ in range(MAX_CHANGES):
        reaction = solve_free(hessian, gradient, jacobian, error, held, step)
        leaving = furthest_outside(step, lower, upper, held)
        if leaving >= 0:
            held[leaving] = True
            step[leaving] = lower[leaving] if step[leaving] < lower[leaving] else upper[leaving]
            continue
        returning = most_eager(hessian @ step + gradient - reaction, step, upper, held)
        if returning < 0:
            break
        held[returning] = False
    return np.minimum(np.maximum(step, lower), upper)


@compiled
def solve_free(
    hessian: Floats, gradient: Floats, jacobian: Floats, error: Floats, held: Flags, step: Floats
) -> Floats:
    """Set the free entries of `step` to the solution with equalities only, the held ones staying.

    Returns:
        J' lambda, [n], the pull of the equalities on every joint.
    """
    free = np.flatnonzero(~held)
    columns = free_minimum(hessian, gradient, jacobian, error.size, held, free, step)
    multipliers = equality_multipliers(jacobian, error, held, free, step, columns)
    m = error.size
    for a in range(free.size):
        step[free[a]] = columns[a, m]
        for r in range(m):
            step[free[a]] += columns[a, r] * multipliers[r, 0]
    reaction = np.zeros(gradient.size)
    for j in range(gradient.size):
        for r in range(m):
            reaction[j] += jacobian[r, j] * multipliers[r, 0]
    return reaction


@compiled
def free_minimum(
    hessian: Floats, gradient: Floats, jacobian: Floats, m: int, held: Flags, free: Integers, step: Floats
) -> Floats:
    """Solve for the k free joints without the equalities.

    Args:
        hessian: H, [n, n].
        gradient: g, [n].
        jacobian: J, [at least m, n].
        m: How many equalities there are.
        held: [n].
        free: [k], which joints are not held.
        step: d, [n], of which the held entries count.

    Returns:
        [k, m + 1]: the columns of H_ff^-1 J_f', and last the minimum itself.
    """
    k, n = free.size, gradient.size
    columns, factor = np.empty((k, m + 1)), np.empty((k, k))
    for a in range(k):
        for b in range(k):
            factor[a, b] = hessian[free[a], free[b]]
        pull = gradient[free[a]]
        for j in range(n):
            if held[j]:
                pull += hessian[free[a], j] * step[j]
        columns[a, m] = -pull
        for r in range(m):
            columns[a, r] = jacobian[r, free[a]]
    solve_positive(factor, columns)
    return columns


@compiled
def equality_multipliers(
    jacobian: Floats, error: Floats, held: Flags, free: Integers, step: Floats, columns: Floats
) -> Floats:
    """Give lambda, [m, 1], from what the minimum of the free joints leaves of e (Schur complement of H)."""
    m = error.size
    schur, missing = np.zeros((m, m)), np.empty((m, 1))
    for r in range(m):
        gap = error[r]
        for j in range(step.size):
            if held[j]:
                gap -= jacobian[r, j] * step[j]
        for a in range(free.size):
            gap -= jacobian[r, free[a]] * columns[a, m]
            for c in range(m):
                schur[r, c] += jacobian[r, free[a]] * columns[a, c]
        missing[r, 0] = gap
    damping = RELATIVE_DAMPING * np.trace(schur) + 1e-300
    for r in range(m):
        schur[r, r] += damping
    solve_positive(schur, missing)
    return missing


@compiled
def solve_positive(matrix: Floats, columns: Floats) -> None:
    """Solve matrix @ X = columns in place for a symmetric positive definite matrix [k, k], by Cholesky."""
    k, m = columns.shape
    for i in range(k):
        for j in range(i + 1):
            total = matrix[i, j]
            for p in range(j):
                total -= matrix[i, p] * matrix[j, p]
            matrix[i, j] = np.sqrt(max(total, 1e-300)) if i == j else total / matrix[j, j]
    for c in range(m):
        for i in range(k):
            for p in range(i):
                columns[i, c] -= matrix[i, p] * columns[p, c]
            columns[i, c] /= matrix[i, i]
        for i in range(k - 1, -1, -1):
            for p in range(i + 1, k):
                columns[i, c] -= matrix[p, i] * columns[p, c]
            columns[i, c] /= matrix[i, i]


@compiled
def furthest_outside(step: Floats, lower: Floats, upper: Floats, held: Flags) -> int:
    """Give the free joint that leaves its bounds furthest, or -1."""
    worst, distance = -1, 0.0
    for i in range(step.size):
        outside = max(lower[i] - step[i], step[i] - upper[i])
        if not held[i] and outside > distance:
            worst, distance = i, outside
    return worst


@compiled
def most_eager(slope: Floats, step: Floats, upper: Floats, held: Flags) -> int:
    """Give the held joint whose cost falls fastest on the way back inside, or -1.

    Args:
        slope: H d + g - J' lambda, [n]: zero for a free joint, the bound's force for a held one.
        step: d, [n].
        upper: [n].
        held: [n].
    """
    best, gain = -1, RELEASE_TOLERANCE
    for i in range(step.size):
        if held[i]:
            inward = slope[i] if step[i] >= upper[i] else -slope[i]
            if inward > gain:
                best, gain = i, inward
    return best
