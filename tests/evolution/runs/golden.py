"""Fingerprints of short runs, stored in golden.json: one per condition, one per alternative of the ledger.

They change only when the world or the algorithm is meant to change; then remake them with

    python tests/evolution/runs/golden.py
"""

import hashlib
import json
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from arm2d import Condition, Readings, draw_trials, run_trials
from arm2d.readings import PLAIN
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_history
from evolution.runs.run import evolve
from evolution.search.config import RunConfig
from evolution.search.settings import Settings

STORED = Path(__file__).with_name("golden.json")
EVOLVED = Path(__file__).parents[2] / "evolved-plain.npz"
# Every alternative of the ledger; tests/test_ledger.py holds the ledger against it.
ALTERNATIVES = {
    "mutation_probability": [0.04],
    "mutation_sd": [0.03],
    "parent_scaling": ["cubed", "excess", "rank"],
    "ties": ["children"],
    "crossover": [0.3],
    "bias_ranges": ["negative"],
    "tau_exponent_max": [1.0, 0.0],
    "object_radius": [3.0, 8.0, 10.0, 11.8],
    "sector_half_width": [5.0, 8.0],
    "start_areas": ["bounds"],
    "start_half_width": [0.0, 8.0],
    "sector_centres": [(45.0, 90.0, 135.0)],
    "bound_vision": ["near"],
    "object_vision": ["any_part"],
    "camera_origin": ["end"],
    "turn": ["radians"],
    "success": ["f1_f2_f3"],
    "run_counting": ["cumulative"],
    "indicate_angle": ["wide"],
    "f3_time": ["best"],
    "ignore_stops": ["never"],
    "starts_shared": ["genotype"],
    "collision_penalty": ["whole"],
}
# What another reading of the ledger goes with.
TOGETHER = {"sector_centres": {"sector_half_width": 3.0}}
# Small, so that thirty of them take a few seconds.
SHORT = Settings(population=30, elites=2, parents=10, generations=12)
BASE = {
    "with-indicate": RunConfig(Condition.WITH_INDICATE, 1, Settings(generations=40), PLAIN),
    "with-ignore": RunConfig(Condition.WITH_IGNORE, 1, Settings(generations=40), PLAIN),
    "cubed, own starts": RunConfig(
        seed=2,
        settings=Settings(population=20, parents=10, generations=40),
        readings=replace(PLAIN, parent_scaling="cubed", starts_shared="genotype", mutation_probability=0.04),
    ),
}


def _alternatives():
    """A short run of each alternative, under the condition it makes a difference to."""
    for name, values in ALTERNATIVES.items():
        for value in values:
            readings = PLAIN.with_values({name: value, **TOGETHER.get(name, {})})
            condition = Condition.WITH_IGNORE if name == "ignore_stops" else Condition.WITH_INDICATE
            yield f"{name} {value}", RunConfig(condition, 3, SHORT, readings)


DEFAULT = {f"default, {c}": RunConfig(c, 4, SHORT, Readings()) for c in Condition}
RUNS = {
    **BASE,
    "plain": RunConfig(Condition.WITH_INDICATE, 3, SHORT, PLAIN),
    **dict(_alternatives()),
    **DEFAULT,
}


def fingerprint(config):
    """SHA-256 of all fitness, parents and best genotypes, and of the champions."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run"
        evolve(path, config)
        opened = RunFolder.open(path)
        history = recorded_history(opened)
        arrays = [history.fitness, history.parents, history.best_genotypes]
        arrays.append(opened.read_arrays(path / "champions.npz")["genotypes"])
    if config.settings == SHORT:
        arrays += evolved_scores(config)
    return hashlib.sha256(b"".join(each.tobytes() for each in arrays)).hexdigest()


def evolved_scores(config):
    """What evolved agents make of a reading: random ones do too little to tell readings apart."""
    with np.load(EVOLVED, allow_pickle=False) as stored:
        genotypes = stored["genotypes"]
    trials = draw_trials(config.condition.instructions, 2, config.readings, np.random.default_rng(4))
    scores = run_trials(genotypes, trials, config.readings)
    return [scores.f1, scores.f2, scores.f3, scores.success, scores.steps]


def fingerprints(names):
    """Those of some runs, by name."""
    return {name: fingerprint(RUNS[name]) for name in names}


if __name__ == "__main__":
    STORED.write_text(json.dumps(fingerprints(RUNS), indent=2) + "\n")
