"""Compile what most tests run: `tests/conftest.py` has it done once, while the workers are still collecting.

Each of several workers would otherwise compile the same for itself.
"""

import numpy as np

from arm2d import Condition, Readings, VectorWorld, draw_trials, record_trial, run_trials
from evolution.agents.transitions import action_transitions, draw_transition_trials


def main() -> None:
    """Score, record, change a word, step."""
    readings, rng = Readings(), np.random.default_rng(0)
    genotypes = rng.random((2, 84))
    trials = draw_trials(Condition.WITH_INDICATE.experienced, 1, readings, rng)
    run_trials(genotypes, trials, readings)
    record_trial(genotypes[0], trials[0], readings)
    run_trials(
        genotypes,
        draw_transition_trials(action_transitions(Condition.WITH_INDICATE), readings, rng),
        readings,
    )
    VectorWorld(trials, readings).step(np.zeros((len(trials), 2), np.int64))


if __name__ == "__main__":
    main()
