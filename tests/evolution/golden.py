"""Fingerprints of short runs, stored in golden.json.

They change only when the world or the algorithm is meant to change; then remake them with

    python tests/evolution/golden.py
"""

import hashlib
import json
import tempfile
from pathlib import Path

from arm2d import Condition, Readings
from evolution.config import RunConfig
from evolution.folder import RunFolder
from evolution.recorded import recorded_history
from evolution.run import evolve
from evolution.settings import Settings

STORED = Path(__file__).with_name("golden.json")
RUNS = {
    "with-indicate": RunConfig(Condition.WITH_INDICATE, 1, Settings(generations=40)),
    "with-ignore": RunConfig(Condition.WITH_IGNORE, 1, Settings(generations=40)),
    "cubed, own starts": RunConfig(
        seed=2,
        settings=Settings(population=20, parents=10, generations=40),
        readings=Readings(parent_scaling="cubed", starts_shared="genotype", mutation_probability=0.04),
    ),
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
    return hashlib.sha256(b"".join(each.tobytes() for each in arrays)).hexdigest()


if __name__ == "__main__":
    STORED.write_text(json.dumps({name: fingerprint(run) for name, run in RUNS.items()}, indent=2) + "\n")
