"""How soon evolution carries out the instructions: a learning curve to stand beside those of other learners.

    python -m benchmarks.learning evolution.csv --seeds 1 2 3
    python -m benchmarks.learning smaller.csv --readings.mutation-sd 0.03

The paper's genetic algorithm, run after run; the best genotype of some generations is tested as
`docs/examples/ppo.py` tests a policy. CPU time of the whole run, files included, tests not.
"""

from __future__ import annotations

import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import tyro
from numpy.typing import NDArray

from arm2d import Condition, Readings
from arm2d.readings import PLAIN
from evolution.experiments.variants import value_names
from evolution.results.learning import LearningCurve, write_curves
from evolution.runs.run import Watcher, evolve
from evolution.runs.sources import find_agent
from evolution.search import scoring
from evolution.search.config import RunConfig
from evolution.search.evaluation import TRIALS_PER_AREA, evaluate
from evolution.search.settings import Settings


@dataclass
class Meter:
    """What a run has used by each of its generations: steps of trials, and CPU time [s]."""

    steps: int = 0
    began: float = field(default_factory=time.process_time)
    readings: list[tuple[int, float]] = field(default_factory=list)

    def counting(self, run_trials: Any) -> Any:
        """`run_trials`, with its steps counted."""

        def counted(*arguments: Any, **options: Any) -> Any:
            scores = run_trials(*arguments, **options)
            self.steps += int(scores.steps.sum())
            return scores

        return counted

    def read(self, _: object) -> None:
        """Note the figures."""
        self.readings.append((self.steps, time.process_time() - self.began))


def evolution_curve(config: RunConfig, folder: Path, tests: int) -> LearningCurve:
    """Evolve in a folder; then test the best of some generations, closer together at first."""
    meter, run_trials = Meter(), scoring.run_trials
    scoring.run_trials = meter.counting(run_trials)
    try:
        evolve(folder, config, Watcher(on_generation=meter.read))
    finally:
        scoring.run_trials = run_trials
    curve = LearningCurve.empty(learner_of(config), config.papers_condition, config.seed)
    for generation in generations_tested(config.settings.generations, tests).tolist():
        agent = find_agent(str(folder), generation=generation, rank=0)
        found = evaluate(
            agent.genotype, agent.condition, agent.readings, per_area=TRIALS_PER_AREA, trial_seed=generation
        )
        steps, cpu = meter.readings[generation]
        curve = curve.longer(steps, cpu, found.successes[0].sum(axis=-1))
    return curve


def learner_of(config: RunConfig) -> str:
    """What evolution is called under these readings, by what differs from the plain ones."""
    name = "+".join(value_names(config.readings, PLAIN))
    return f"evolution, {name}" if name else "evolution"


def generations_tested(generations: int, tests: int) -> NDArray[np.int64]:
    """The numbers of about as many generations as there are tests, the first and the last among them."""
    return np.unique(np.geomspace(1, generations, tests).round().astype(int)) - 1


def main(
    output: Annotated[Path, tyro.conf.Positional],
    seeds: tuple[int, ...] = (1, 2, 3),
    generations: int = 6000,
    tests: int = 60,
    condition: Condition = Condition.WITH_INDICATE,
    readings: Readings = PLAIN,
) -> None:
    """Evolve with each seed and write the curves.

    Args:
        output: The table to be written.
        seeds: A run each.
        generations: Of each run.
        tests: Of each run.
        condition: Which third action there is.
        readings: How the paper is understood; without, plainly, as in the example of PPO.
    """
    curves = []
    with tempfile.TemporaryDirectory() as folder:
        # Compile, or load what was compiled, before a clock starts.
        evolve(Path(folder) / "warm", RunConfig(settings=Settings(generations=2)))
        for seed in seeds:
            config = RunConfig(condition, seed, Settings(generations=generations), readings)
            curves.append(evolution_curve(config, Path(folder) / str(seed), tests))
            end = curves[-1]
            print(
                f"seed {seed}: {end.steps[-1]:,} steps, {end.cpu[-1]:.0f} s CPU, {end.successes[-1]}",
                flush=True,
            )
            write_curves(output, curves)


if __name__ == "__main__":
    tyro.cli(main)
