"""Contact in the JAX peer (spec section 3): every disc of every trial through all sub-steps."""

from __future__ import annotations

import jax.numpy as jnp  # pyright: ignore[reportMissingImports]

from arm2d import constants as c

NONE, RIGHT, LEFT = 0, 1, 2


def touch(state, alpha, beta, radius):
    """Where the discs are and touch once the arms have turned from `state` to alpha, beta [deg]."""
    a0, b0, a1, b1 = (each[..., None] for each in (state.alpha, state.beta, alpha, beta))
    x, y, side = state.discs[..., 0], state.discs[..., 1], state.sides
    u0, v0 = _to_s2(a0, b0, x, y)
    for k in range(1, c.SUB_STEPS + 1):
        a, b = a0 + (a1 - a0) * k / c.SUB_STEPS, b0 + (b1 - b0) * k / c.SUB_STEPS
        u, v = _to_s2(a, b, x, y)
        beyond = jnp.maximum(0.0, jnp.maximum(u - c.S2_LENGTH, -u))
        gap = jnp.sqrt(beyond * beyond + v * v)
        hit = gap < radius - c.PENETRATION_TOLERANCE
        carried, met = hit & (side != NONE), hit & (side == NONE)
        tangent = jnp.sqrt(jnp.maximum(radius * radius - beyond * beyond, 0.0)) * jnp.where(v0 < 0, -1.0, 1.0)
        free = jnp.where(gap <= radius + c.TOUCH_TOLERANCE, jnp.where(v < 0.0, RIGHT, LEFT), NONE)
        stood = jnp.where(v0 < 0.0, RIGHT, LEFT)
        side = jnp.where(carried, side, jnp.where(met, stood, free)).astype(jnp.int8)
        u, v = jnp.where(carried, u0, u), jnp.where(carried, v0, jnp.where(met, tangent, v))
        moved_x, moved_y = _from_s2(a, b, u, v)
        x, y = jnp.where(hit, moved_x, x), jnp.where(hit, moved_y, y)
        u0, v0 = u, v
    active = state.active[..., None]
    discs = jnp.where(active[..., None], jnp.stack([x, y], -1), state.discs)
    return discs, jnp.where(active, side, state.sides)


def _to_s2(alpha, beta, x, y):
    a, h = jnp.radians(alpha), jnp.radians(alpha + beta)
    x, y = x - c.S1_LENGTH * jnp.cos(a), y - c.S1_LENGTH * jnp.sin(a)
    return x * jnp.cos(h) + y * jnp.sin(h), y * jnp.cos(h) - x * jnp.sin(h)


def _from_s2(alpha, beta, u, v):
    a, h = jnp.radians(alpha), jnp.radians(alpha + beta)
    x = c.S1_LENGTH * jnp.cos(a) + u * jnp.cos(h) - v * jnp.sin(h)
    return x, c.S1_LENGTH * jnp.sin(a) + u * jnp.sin(h) + v * jnp.cos(h)


def bearing_of(points):
    """Direction of points [..., 2] from J1 [deg], in [-90, 270)."""
    return (jnp.degrees(jnp.arctan2(points[..., 1], points[..., 0])) + 90.0) % 360.0 - 90.0
