"""A small finished run and what else the fuzzed commands are about, made once."""

import os
import shutil
from pathlib import Path

import numpy as np

from evolution.agents.postevaluation import post_evaluate
from evolution.agents.solving import solved_trials
from evolution.agents.transitions import run_transition_test
from evolution.experiments.plan import Plan
from evolution.runs.folder import RunFolder
from evolution.runs.run import Watcher, evolve
from evolution.search.config import RunConfig
from evolution.search.settings import Settings

SETTINGS = Settings(population=6, elites=2, parents=3, generations=104, trials_per_area=1)
CONFIG = RunConfig(seed=5, settings=SETTINGS)
FLAGS = [
    "--seed=5",
    *(f"--{name.replace('_', '-')}={value}" for name, value in SETTINGS.to_mapping().items()),
]
EXPERIMENT = """output = "runs/fuzz"
conditions = ["with-indicate", "with-ignore"]
seeds = [1, "3-4"]
jobs = 1
post_evaluate = true
preset = "default"
[settings]
generations = [2, 3]
population = 6
elites = 1
parents = 2
[readings]
object_radius = [5.0, 8]
sector_centres = [[30, 90, 150], [45, 90, 135]]
turn = "degrees"
[[variant]]
name = "narrow"
[variant.readings]
sector_half_width = 5
"""


class Place:
    """A folder for one input after another; each finds the same things in it."""

    def __init__(self, home: Path):
        self.home, self.number = home, 0
        self.trap = home / "executed"
        evolve(home / "finished", CONFIG)
        folder = RunFolder.open(home / "finished")
        post_evaluate(folder)
        run_transition_test(folder)
        solved_trials(folder)
        seen = iter(range(200))
        evolve(home / "begun", CONFIG, Watcher(wants_stop=lambda: next(seen) > 50))
        self.config = CONFIG.to_toml()
        self.plan = Plan(home / "planned", (CONFIG,))
        self.genotypes = np.random.default_rng(0).random((3, 84))

    def copy(self, name: str) -> Path:
        """A run that an input may spoil: finished, or begun."""
        self.number += 1
        path = self.home / f"input-{self.number}"
        shutil.copytree(self.home / name, path)
        return path

    def file(self, name: str, data: bytes) -> Path:
        """A file in a folder of its own."""
        self.number += 1
        path = self.home / f"input-{self.number}" / name
        path.parent.mkdir()
        path.write_bytes(data)
        return path

    def clear(self) -> None:
        """Remove what the last input was about."""
        shutil.rmtree(self.home / f"input-{self.number}", ignore_errors=True)

    def contents(self) -> dict[str, tuple[int, int]]:
        """All files with size and time; a lock that was taken and given back is none."""
        found = {}
        for folder, _, names in os.walk(self.home):
            for name in names:
                if name not in ("lock", "lease"):
                    state = (Path(folder) / name).stat()
                    found[f"{folder}/{name}"] = (state.st_size, state.st_mtime_ns)
        return found
