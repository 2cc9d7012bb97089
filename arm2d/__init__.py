"""The planar world of the experiment: instructions, controller, trials.

    import arm2d
    trials = arm2d.draw_trials(instructions, per_area, readings, rng)
    scores = arm2d.run_trials(genotypes, trials, readings)
    record = arm2d.record_trial(genotype, trials[0], readings)

Names are loaded on first use: whoever only needs `Readings` or `Instruction` (the command line's
`--help`) does not wait for Numba.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from arm2d.controller import Networks, check_genotypes, decode, encode
    from arm2d.drawing import draw_state
    from arm2d.instructions import NON_EXPERIENCED, ActionWord, Condition, Instruction, ObjectWord
    from arm2d.readings import Readings
    from arm2d.running import record_trial, run_trials
    from arm2d.trials import LabelChanges, TrialRecord, Trials, TrialScores, draw_trials
    from arm2d.vector_world import INPUT_NAMES, VectorWorld
    from arm2d.video import render_video
    from arm2d.world import World

_HOMES = {
    "drawing": ("draw_state",),
    "video": ("render_video",),
    "controller": ("Networks", "check_genotypes", "decode", "encode"),
    "instructions": ("ActionWord", "Condition", "Instruction", "NON_EXPERIENCED", "ObjectWord"),
    "readings": ("Readings",),
    "running": ("record_trial", "run_trials"),
    "world": ("World",),
    "vector_world": ("INPUT_NAMES", "VectorWorld"),
    "trials": ("LabelChanges", "TrialRecord", "TrialScores", "Trials", "draw_trials"),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [  # noqa: RUF022 - in the order of _HOMES
    "draw_state",
    "render_video",
    "Networks",
    "check_genotypes",
    "decode",
    "encode",
    "ActionWord",
    "Condition",
    "Instruction",
    "NON_EXPERIENCED",
    "ObjectWord",
    "Readings",
    "record_trial",
    "run_trials",
    "World",
    "INPUT_NAMES",
    "VectorWorld",
    "LabelChanges",
    "TrialRecord",
    "TrialScores",
    "Trials",
    "draw_trials",
]


def __getattr__(name: str) -> object:
    if name not in _HOME_OF:
        raise AttributeError(f"module 'arm2d' has no attribute {name!r}")
    return getattr(import_module(f"arm2d.{_HOME_OF[name]}"), name)
