"""Makes tests/evolved.npz and tests/evolved-plain.npz: 60 evolved genotypes each, from three short runs.

    python tests/make_evolved.py

The first were evolved under the default readings, the others under the plain ones. Takes about two minutes.
The tests need agents that see, touch and push; random ones seldom do.
"""

import tempfile
from pathlib import Path

import numpy as np

from arm2d import Condition, Readings
from arm2d.readings import PLAIN
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_history
from evolution.runs.run import evolve
from evolution.search.config import RunConfig
from evolution.search.settings import Settings

# Runs that get on: the tests need what evolution finds, not how often it does.
FILES = {
    "evolved.npz": (
        Readings(),
        ((Condition.WITH_INDICATE, 104), (Condition.WITH_INDICATE, 109), (Condition.WITH_IGNORE, 103)),
    ),
    "evolved-plain.npz": (
        PLAIN,
        ((Condition.WITH_INDICATE, 7), (Condition.WITH_INDICATE, 4), (Condition.WITH_IGNORE, 1)),
    ),
}
GENERATIONS = 1200
# The five best of every fiftieth of the last generations: twenty genotypes of a run.
PICKED = slice(-151, None, 50)


def main() -> None:
    """Evolve and write."""
    for name, (readings, runs) in FILES.items():
        genotypes = np.concatenate([picked(*run, readings) for run in runs])
        np.savez_compressed(Path(__file__).with_name(name), genotypes=genotypes)


def picked(condition: Condition, seed: int, readings: Readings) -> np.ndarray:
    """Twenty genotypes [20, 84] of a short run."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run"
        evolve(path, RunConfig(condition, seed, Settings(generations=GENERATIONS), readings))
        return recorded_history(RunFolder.open(path)).best_genotypes[PICKED].reshape(-1, 84)


if __name__ == "__main__":
    main()
