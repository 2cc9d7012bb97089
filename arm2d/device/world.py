"""What the readings fix, on the device: the records and tables of `arm2d.kernel.world`.

The groups of a batch may live under different readings: their worlds stand in a row, and so do the tables.
Values of beta are numbered from 0 on in the order of `WorldTables.betas`, which keeps tables short.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import warp as wp

from arm2d.device import numbers as c
from arm2d.device.memory import placed
from arm2d.kernel.contact import LARGEST_BETA
from arm2d.kernel.scores import CRITERIA
from arm2d.kernel.world import N_BETA_KEYS, beta_key, tables_of, world_of
from arm2d.readings import Readings


@wp.struct
class World:
    """`arm2d.kernel.world.World`, and the row of the tables that goes with it."""

    turn: wp.float64
    radius: wp.float64
    white_right: wp.float64
    white_left: wp.float64
    any_part: wp.int32
    from_end: wp.int32
    target_cone: wp.float64
    indicate_cone: wp.float64
    move_angle: wp.float64
    ignore_stops: wp.int32
    keep: wp.float64
    whole_penalty: wp.int32
    best_stretch: wp.int32
    strict_success: wp.int32
    quarter_sine: wp.float64
    quarter_cosine: wp.float64
    hit_gap_squared: wp.float64
    touch_gap_squared: wp.float64
    side_reach: wp.float64
    row: wp.int32


@wp.struct
class Tables:
    """W worlds and their tables; B values of beta at most.

    Attributes:
        worlds: [W].
        beta_numbers: [W, N_BETA_KEYS], the number of each value of beta by its key.
        beta_sines: [W, B], its sine and cosine.
        largest_betas: [1000], from which beta [deg] on S2 reaches so many [cm] from J1.
        criteria: [4], truth tables by action word.
    """

    worlds: wp.array[World]
    beta_numbers: wp.array2d[wp.int32]
    beta_sines: wp.array2d[wp.vec2d]
    largest_betas: wp.array[wp.float64]
    criteria: wp.array[wp.int32]


@wp.func
def key_of_beta(beta: wp.float64) -> wp.int32:
    """Where tables hold a value of beta [deg]: its whole tenths of a degree."""
    return wp.int32(beta * c.BETA_KEYS_PER_DEGREE + c.HALF)


def worlds_on(device: Any, worlds: Sequence[Readings]) -> tuple[Tables, Any]:
    """The tables of some readings, and [W, B] their values of beta, rows filled up with 90 degrees."""
    each = [tables_of(readings) for readings in worlds]
    n_betas = max(len(tables.betas) for tables in each)
    betas, sines = np.full((len(each), n_betas), c.BETA_MAX.value), np.zeros((len(each), n_betas, 2))
    numbers = np.zeros((len(each), N_BETA_KEYS), np.int32)
    for row, tables in enumerate(each):
        keys = [int(beta_key(beta)) for beta in tables.betas]
        betas[row, : len(keys)] = tables.betas
        sines[row, : len(keys)] = tables.beta_sines[keys]
        numbers[row, keys] = np.arange(len(keys))
    tables = Tables()
    tables.worlds = placed([_world(readings, row) for row, readings in enumerate(worlds)], World, device)
    tables.beta_numbers = placed(numbers, wp.int32, device)
    tables.beta_sines = placed(sines, wp.vec2d, device)
    tables.largest_betas = placed(LARGEST_BETA, wp.float64, device)
    tables.criteria = placed(CRITERIA.astype(np.int64).astype(np.uint32).view(np.int32), wp.int32, device)
    return tables, placed(betas, wp.float64, device)


def _world(readings: Readings, row: int) -> World:
    world = World()
    for name, value in world_of(readings)._asdict().items():
        setattr(world, name, int(value) if isinstance(value, bool) else value)
    world.row = row
    return world
