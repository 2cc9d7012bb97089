"""Measured runs made up from known effects, in the worlds of the factorial study."""

import numpy as np

from arm2d import Condition
from evolution.study.declared.claim import FULL, QUESTIONS, Answer
from evolution.study.declared.factors import FACTORS, levels_of
from evolution.study.declared.parts import factorial
from evolution.study.declared.regression import Estimate
from evolution.study.declared.rows import COUNTS, MeasuredRun

PLACES = {factor.name: place for place, factor in enumerate(FACTORS)}
AGENTS = 500


def configs(*conditions):
    """The runs of the factorial study in these conditions, by default in both; drawn when first asked for."""
    return [config for config in factorial().configs if config.condition in (conditions or Condition)]


def level_of(config, factor):
    """The name of a run's level."""
    return levels_of(config.readings)[PLACES[factor]]


def made_up(config, plateau=2.0, shares=(0.0, 0.0, 0.0, 0.0), solved=False, **counts):
    """A run with these numbers; whatever is not given is 0."""
    own = dict.fromkeys(COUNTS, 0) | {"agents": AGENTS} | counts
    for name, share in zip(("I", "II", "III", "IV"), shares, strict=True):
        own[f"category 10 of {name}"] = round(AGENTS * share)
    return MeasuredRun(config, plateau, 100 if solved else -1, 0.0, own, np.zeros((9, 2)))


def logistic(x):
    return 1 / (1 + np.exp(-x))


def runs_with_effects(seed=0):
    """Runs in which a few factors do something.

    Small mutations raise the plateau by 0.3, excess by 0.2 and with small mutations by 0.25 more; start areas
    at the bounds lower it by 0.2. Where both are, the shares are the published ones of With-Indicate; being
    solved follows the camera.
    """
    rng, runs = np.random.default_rng(seed), []
    for config in configs():
        small, excess = (
            level_of(config, "mutation") == "0.4 / 0.03",
            level_of(config, "parent_scaling") == "excess",
        )
        bounds, end = level_of(config, "start_areas") == "bounds", level_of(config, "camera_origin") == "end"
        plateau = 1.9 + 0.3 * small + 0.2 * excess + 0.25 * (small and excess) - 0.2 * bounds
        share = logistic(-2.5 + 1.5 * small + 1.4 * excess + rng.normal(0, 0.5))
        solved = rng.random() < logistic(-1.5 + 2.0 * end)
        runs.append(
            made_up(config, plateau + rng.normal(0, 0.1), (share, share / 9, share / 15, share / 300), solved)
        )
    return runs


def made_up_answers():
    """Every question of the claim answered from two sources; every third by few runs of one condition."""
    names = [question.name for question in QUESTIONS] + [f"runs with {FULL} agents"]
    return {
        source: [
            Answer(
                name,
                (9, 9) if k % 3 else (12, 4),
                (1.0 - 0.01 * k, 0.0123),
                Estimate(0.3 + 0.01 * k + shift, 0.2 + shift, 0.6 + shift),
                0.01,
                corrected=0.2 * (k % 2),
            )
            for k, name in enumerate(names)
        ]
        for source, shift in (("default", 0.0), ("printed", 0.05))
    }
