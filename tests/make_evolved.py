"""Makes tests/evolved.npz: 60 evolved genotypes, twenty from each of three short runs.

    python tests/make_evolved.py

Takes about a minute. The tests need agents that see, touch and push; random ones seldom do.
"""

import tempfile
from pathlib import Path

import numpy as np

from arm2d import Condition
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_history
from evolution.runs.run import evolve
from evolution.search.config import RunConfig
from evolution.search.settings import Settings

RUNS = ((Condition.WITH_INDICATE, 7), (Condition.WITH_INDICATE, 4), (Condition.WITH_IGNORE, 1))
GENERATIONS = 1200
# The five best of every fiftieth of the last generations: twenty genotypes of a run.
PICKED = slice(-151, None, 50)


def main() -> None:
    """Evolve and write."""
    genotypes = []
    for condition, seed in RUNS:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "run"
            evolve(path, RunConfig(condition, seed, Settings(generations=GENERATIONS)))
            history = recorded_history(RunFolder.open(path))
        genotypes.append(history.best_genotypes[PICKED].reshape(-1, 84))
    np.savez_compressed(Path(__file__).with_name("evolved.npz"), genotypes=np.concatenate(genotypes))


if __name__ == "__main__":
    main()
