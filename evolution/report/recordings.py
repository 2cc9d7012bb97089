"""Recorded trials in the compact form that the report's canvas plays.

`a` and `b` are the angles of S1 and S2 after each step in 1/100 degrees, `d` the three discs' centres
at the start in mm, `m` [step, disc, x, y] wherever one has moved, `c` [step, disc, side] wherever a contact
has changed (0 none, 1 S2's right side, 2 its left), and `ok` whether the instruction was carried out.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from arm2d import TrialRecord
from arm2d.view import camera_position
from evolution.agents.recording import record_instruction
from evolution.results.notable import Agent
from evolution.runs.sources import find_source

AREAS: Final = ("right", "left")
TRIAL_SEED: Final = 0


def recordings_of(agent: Agent) -> dict[str, Any]:
    """An agent's nine instructions, one trial from each start area, and the world they took place in.

    Raises:
        ValueError: If the agent's run is damaged.
    """
    source = find_source(str(agent.run.path), generation=agent.generation, rank=agent.rank)
    readings = source.readings
    trials = {
        str(instruction): {
            area: compact(record_instruction(source, instruction, area, TRIAL_SEED)) for area in AREAS
        }
        for instruction in source.condition.instructions
    }
    return {
        "radius": readings.object_radius,
        "centres": list(readings.sector_centres),
        "half_width": readings.sector_half_width,
        "camera": float(camera_position(0.0, readings)[0]),  # how far along S1 [cm]
        "trials": trials,
    }


def compact(record: TrialRecord) -> dict[str, Any]:
    """One trial, as described above; angles within 0.005 degrees, places within 0.5 mm."""
    discs = np.rint(10 * record.discs).astype(int)  # [K + 1, 3, 2]
    return {
        "a": np.rint(100 * record.alpha).astype(int).tolist(),
        "b": np.rint(100 * record.beta).astype(int).tolist(),
        "d": discs[0].tolist(),
        "m": _changes(discs),
        "c": _changes(record.contact[..., np.newaxis].astype(int)),
        "ok": record.success,
    }


def _changes(values: np.ndarray) -> list[list[int]]:
    """[step, disc, *value] wherever values [K + 1, 3, n] differ from the step before."""
    steps, discs = np.nonzero((np.diff(values, axis=0) != 0).any(axis=-1))
    return [
        [int(step) + 1, int(disc), *values[step + 1, disc].tolist()]
        for step, disc in zip(steps, discs, strict=True)
    ]
