"""How long runs will take that were not started yet."""

from __future__ import annotations

import math
import time
from typing import Final

from evolution.experiments.plan import Plan
from evolution.experiments.standing import TESTS_PER_EVOLUTION, Pace, size_of
from evolution.runs.folder import GENERATIONS_PER_PART
from evolution.search.config import RunConfig
from evolution.search.population import first_population, next_population
from evolution.search.scoring import score_population

GENERATIONS: Final = 5
# An evolved population takes that many times as long as a random one (python -m benchmarks.kernel).
EVOLVED: Final = 1.5


def expected_pace(plan: Plan) -> tuple[Pace, str]:
    """What a generation and a test will take, and in words how that is known."""
    pace = plan.pace()
    if not math.isnan(pace.generation):
        return pace, "by the pace of the runs so far"
    generation = EVOLVED * _trial_generation(plan.configs[0])
    test = TESTS_PER_EVOLUTION * GENERATIONS_PER_PART * generation / 2
    return Pace(generation, test), f"by {GENERATIONS} random generations tried out, times {EVOLVED:g}"


def _trial_generation(config: RunConfig) -> float:
    """CPU time [s] of a generation of the paper's size, from a run's first ones, which are not kept."""
    population = first_population(config)
    score_population(population, config)  # compiles, or loads what was compiled
    began = time.process_time()
    for _ in range(GENERATIONS):
        population = next_population(population, score_population(population, config), config)
    return (time.process_time() - began) / GENERATIONS / size_of(config)
