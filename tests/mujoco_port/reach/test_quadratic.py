"""The solver of the inverse kinematics, held against what a minimum must fulfil."""

import numpy as np
import pytest

from mujoco_port.reach.quadratic import MAX_STEP, bounded, relaxed, solve_bounded, solve_positive

N, M = 10, 3


def programme(seed, width):
    """A random programme with a feasible point: H, g, J, e, lower, upper; the narrower, the more is held."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(N, N))
    lower, upper = -width * rng.random(N), width * rng.random(N)
    jacobian = rng.normal(size=(6, N))
    inside = lower + (upper - lower) * rng.uniform(0.1, 0.9, N)
    return root @ root.T + 0.1 * np.eye(N), rng.normal(size=N), jacobian, jacobian[:M] @ inside, lower, upper


def is_minimum(hessian, gradient, jacobian, error, lower, upper, step):
    """The conditions of Karush, Kuhn and Tucker: feasible, and no held joint would gain by coming back."""
    low, high = step == lower, step == upper
    free = ~(low | high)
    slope = hessian @ step + gradient
    force = slope - jacobian[:M].T @ np.linalg.lstsq(jacobian[:M, free].T, slope[free], rcond=None)[0]
    feasible = (
        np.abs(jacobian[:M] @ step - error).max() < 1e-8 and (lower <= step).all() and (step <= upper).all()
    )
    outward = [*np.abs(force[free]), *-force[low], *force[high]]
    return feasible and max(outward) < 1e-6


@pytest.mark.parametrize(
    # In a box so narrow that half of the joints are held, holding and releasing may go round in a circle.
    ("width", "n_held", "exceptions"),
    [(0.2, 4.0, 1), (0.5, 2.8, 0), (1.0, 2.2, 0), (3.0, 1.6, 0)],
)
def test_step_fulfils_the_conditions_of_a_minimum_on_random_boxes(width, n_held, exceptions):
    held, missed = [], 0
    for seed in range(200):
        problem = programme(seed, width)
        step = solve_bounded(*problem)
        missed += not is_minimum(*problem, step)
        held.append(((step == problem[4]) | (step == problem[5])).sum())
    assert missed <= exceptions
    assert np.mean(held) == pytest.approx(n_held, abs=0.3)  # there was something to hold


def test_wide_box_gives_the_solution_with_equalities_only():
    hessian, gradient, jacobian, error, _, _ = programme(1, 1.0)
    rows = jacobian[:M]
    system = np.block([[hessian, rows.T], [rows, np.zeros((M, M))]])
    expected = np.linalg.solve(system, np.concatenate([-gradient, error]))[:N]
    wide = np.full(N, 1e6)
    step = solve_bounded(hessian, gradient, jacobian, error, -wide, wide)
    np.testing.assert_allclose(step, expected, rtol=1e-7, atol=1e-9)


def test_joint_that_was_held_too_early_is_released():
    """Without bounds (2, 1.1) is best, so joint 0 leaves furthest; with joint 1 held it comes back to 0.1."""
    hessian, gradient = np.array([[1.0, -1.9], [-1.9, 4.0]]), np.array([0.09, -0.6])
    lower, upper = np.array([-1.0, -1.0]), np.array([0.5, 0.1])
    step = solve_bounded(hessian, gradient, np.zeros((0, 2)), np.zeros(0), lower, upper)
    np.testing.assert_allclose(step, [0.1, 0.1], rtol=1e-12)


def test_step_ends_at_joint_limits_and_turns_no_joint_further_than_allowed():
    hessian, gradient, *_ = programme(3, 1.0)
    angles, far = np.zeros(N), 100.0 * gradient
    lower, upper = np.full(N, -0.1), np.full(N, 2.0)
    reached = bounded(hessian, far, np.zeros((0, N)), np.zeros(0), angles, lower, upper)
    assert (reached >= lower).all()
    assert (reached <= MAX_STEP).all()
    assert (reached == -0.1).any()
    assert (reached == MAX_STEP).any()


def test_cholesky_solves_what_numpy_solves():
    hessian, _, jacobian, _, _, _ = programme(5, 1.0)
    columns = jacobian.T.copy()
    solve_positive(hessian.copy(), columns)
    np.testing.assert_allclose(columns, np.linalg.solve(hessian, jacobian.T), rtol=1e-9)


REST, WEIGHTS, ROLL, HEADING = np.linspace(-0.3, 0.3, N), np.linspace(0.1, 1.0, N), 0.9, 0.7
DOWN = np.array([0.0, np.sin(ROLL), np.cos(ROLL)])


def wished(kinematics, angles, heading_weight, level_weight):
    """What a relaxed step lowers: half the squares of departure from rest, of heading error and of tilt."""
    hand = kinematics.forward(angles).rotation
    off = np.arctan2(hand[1, 0], hand[0, 0]) - HEADING
    tilt = np.arccos(np.clip(-(hand @ DOWN)[2], -1.0, 1.0))
    return 0.5 * (WEIGHTS @ (angles - REST) ** 2 + heading_weight * off**2 + level_weight * tilt**2)


@pytest.mark.parametrize(("heading_weight", "level_weight"), [(2.0, 0.0), (0.0, 3.0), (2.0, 3.0)])
def test_a_relaxed_step_goes_down_the_slope_of_what_is_wished(kinematics, heading_weight, level_weight):
    """The price of moving is so high here that only the slope counts; nothing is to be reached."""
    price, nothing, wide = 1e7, np.zeros(0), np.full(N, 10.0)
    rng = np.random.default_rng(6)
    for _ in range(5):
        angles = rng.uniform(kinematics.lower, kinematics.upper)
        jacobian, hand = kinematics._jacobian(angles), kinematics.forward(angles).rotation
        wishes = np.array([heading_weight, level_weight, price])
        there = relaxed(
            angles,
            jacobian,
            hand,
            nothing,
            HEADING,
            DOWN,
            REST,
            WEIGHTS,
            wishes,
            angles - wide,
            angles + wide,
        )
        step, slope = 1e-6 * np.eye(N), np.empty(N)
        for joint in range(N):
            ahead, back = (
                wished(kinematics, angles + side * step[joint], heading_weight, level_weight)
                for side in (1.0, -1.0)
            )
            slope[joint] = (ahead - back) / 2e-6
        np.testing.assert_allclose(-price * (there - angles), slope, atol=2e-5 * np.abs(slope).max())
