"""Measured runs of the study with numbers that are made up, unequal from cell to cell and run to run."""

import numpy as np

from evolution.study.beyond.cells import beyond
from evolution.study.beyond.rows import CellRun

CONFIGS = beyond().configs
AGENTS = 1000
SEEDS = range(201, 209)  # so few that all ways to exchange runs are counted


def made_up(config, plateau=2.0, first_solved=-1, obeying=0, understood=(), all_understood=0):
    """A run with these numbers; `understood` in the order of what is held out, 0 where nothing is given."""
    held_out = config.task.held_out
    counts = dict(zip(held_out, [*understood, *[0] * len(held_out)], strict=False))
    successes = {word: (1 + place) / 20 for place, word in enumerate(config.task.instructions)}
    return CellRun(config, plateau, first_solved, 0.0, AGENTS, obeying, counts, all_understood, successes)


def made_study(seeds=range(201, 221), seed=0, generations=6000):
    """Runs of all cells: dealt colours solve least, five neurons most, With-Ignore a little more.

    Understanding is scarce but with four held out, where it is common.
    """
    rng, runs = np.random.default_rng(seed), []
    for config in beyond(generations).configs:
        if config.seed not in seeds:
            continue
        level = {"dealt": 0.6, "five": 0.97}.get(_kind(config), 0.85)
        level += 0.02 * (config.task.third == "ignore")
        plateau = config.task.largest_fitness * min(1.0, level + rng.normal(0, 0.02))
        solved = int(rng.integers(100, 6000)) if rng.random() < 2 * level - 1 else -1
        share = 0.6 if len(config.task.held_out) == 4 else 0.1
        obeying = int(AGENTS * rng.uniform(0.5, 1.0))
        understood = [int(obeying * share * rng.uniform(0.5, 1.5)) for _ in config.task.held_out]
        both = min(understood) // 2 if rng.random() < share else 0
        runs.append(made_up(config, plateau, solved, obeying, understood, both))
    return runs


def _kind(config):
    if config.settings.inter_neurons == 5:
        return "five"
    return config.task.places
