"""Compile what most commands and tests run, so that nobody waits for it later.

    python -m scripts.warm_up [--picture]

Set-up does so in the end, and the tests again, for sources that were changed since: each of several workers
would otherwise compile the same for itself. Where all is compiled, it takes two seconds.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

from arm2d import Condition, Readings, VectorWorld, draw_trials, record_trial, run_trials
from evolution.agents.transitions import action_transitions, draw_transition_trials


def main(picture: bool) -> None:
    """Score, record, change a word, step; and draw the robot."""
    readings, rng = Readings(), np.random.default_rng(0)
    genotypes = rng.random((2, 84))
    trials = draw_trials(Condition.WITH_INDICATE.experienced, 1, readings, rng)
    run_trials(genotypes, trials, readings)
    record = record_trial(genotypes[0], trials[0], readings)
    run_trials(
        genotypes,
        draw_transition_trials(action_transitions(Condition.WITH_INDICATE), readings, rng),
        readings,
    )
    VectorWorld(trials, readings).step(np.zeros((len(trials), 2), np.int64))
    if picture:
        import mujoco_port

        with tempfile.TemporaryDirectory() as folder:
            mujoco_port.port_picture(record, 1, Path(folder) / "robot.png")


if __name__ == "__main__":
    main("--picture" in sys.argv[1:])
