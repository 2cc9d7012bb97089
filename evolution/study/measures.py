"""What one run is compared by: plateau, first solution, and what its late agents make of nine instructions.

L sampled generations, 5 ranks, I instructions (nine in the paper), 2 start areas.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d.records import alike, brief
from evolution.agents.firsts import NEVER, first_row
from evolution.agents.parts import best_genotypes, late_spans
from evolution.agents.postevaluation import successes_by_area
from evolution.agents.solving import all_solved
from evolution.agents.subtasks import AgentClass, categories, classify
from evolution.results.analysis import PLATEAU_SHARE
from evolution.results.records import ends_at_largest
from evolution.runs.folder import AnyRun, RunFolder
from evolution.runs.history import History, check_array, check_range
from evolution.runs.storage import DamagedFileError, make_folder
from evolution.search.config import RunConfig
from evolution.search.evaluation import TRIALS_PER_AREA
from evolution.search.settings import N_BEST

FILE: Final = Path("measures") / "late.npz"
# Elites live for many generations, so neighbours say little that is new.
SAMPLE_STEP: Final = 10
# So that one of them is in the last third of any run.
FEWEST_GENERATIONS: Final = 3 * SAMPLE_STEP


@dataclass(frozen=True)
class RunMeasures:
    """One run in numbers.

    Attributes:
        config: The run.
        plateau: Median best fitness over the last sixth of its generations.
        first_solved: First generation in which one genotype carried out all its trials; -1 if none.
        solved_late: Share of the last third of generations in which one did.
        successes: [L, 5, I, 2], of 40 trials each, from the right and from the left area.
    """

    config: RunConfig
    plateau: float
    first_solved: int
    solved_late: float
    successes: NDArray[np.int16]

    __repr__ = brief
    __eq__ = alike

    @property
    def at_limit(self) -> bool:
        """Whether it ends at the largest fitness of its task, 2.57 in the paper."""
        return bool(ends_at_largest(self.plateau, self.config.task.largest_fitness))

    @property
    def solved(self) -> bool:
        """Whether one genotype ever carried out all its trials."""
        return self.first_solved != NEVER

    @property
    def agents(self) -> NDArray[np.int16]:
        """Successes [5 L, I] of 80, agent by agent."""
        return self.successes.sum(axis=-1).reshape(-1, self.successes.shape[2])

    @property
    def top_shares(self) -> NDArray[np.float64]:
        """Share of agents in category 10 of the sub-tasks I to IV, [4] (Table II)."""
        return (categories(self.agents, self.config.papers_condition) == 10).mean(axis=0)

    @property
    def class_shares(self) -> dict[AgentClass, float]:
        """Share of agents that are fully, partially, not compositional."""
        members = classify(self.agents, self.config.papers_condition)
        return {kind: float(each.mean()) for kind, each in members.items()}

    @property
    def success_by_area(self) -> NDArray[np.float64]:
        """Share of successful trials of each instruction from each area, [I, 2]: where a run fails."""
        return self.successes.mean(axis=(0, 1)) / TRIALS_PER_AREA


# Successes [L, 5, I, 2] of the sampled generations' best.
Simulate = Callable[[RunFolder], NDArray[np.int16]]


def measure(run: AnyRun, simulate: Simulate | None = None) -> RunMeasures:
    """The measures of a finished run; what had to be simulated is kept beside it.

    Args:
        run: The run, or its folder.
        simulate: Carries out the trials of the sampled generations' best, if not the processor.

    Raises:
        ValueError: If the run is not finished, or too short.
        DamagedFileError: If a file of it is damaged.
    """
    folder = RunFolder.open(run)
    check_generations(folder.config.settings.generations)
    if len(folder.finished_spans()) < len(folder.spans):
        raise ValueError(f"{folder.path} is not finished; go on with: wordarm study")
    successes = _late_successes(folder, simulate or simulated)
    first, share = solved_of(folder)
    return RunMeasures(folder.config, plateau_of(folder), first, share, successes)


def solved_of(folder: RunFolder) -> tuple[int, float]:
    """First generation in which one genotype carried out all its trials, -1 if none; share of late ones."""
    solved = all_solved(folder)
    return first_row(solved), float(solved[late_spans(folder)[0].start :].mean())


def check_generations(generations: int) -> None:
    """Refuse runs of too few generations to measure with a ValueError."""
    if generations < FEWEST_GENERATIONS:
        raise ValueError(
            f"a run of {generations} generations is too short to be measured; "
            f"it needs at least {FEWEST_GENERATIONS}"
        )


def is_measured(path: Path) -> bool:
    """Whether what has to be simulated is there."""
    return (path / FILE).exists()


def sampled_generations(folder: RunFolder) -> list[int]:
    """Every tenth of the late generations."""
    return [g for span in late_spans(folder) for g in span if g % SAMPLE_STEP == 0]


def plateau_of(folder: RunFolder) -> float:
    """Median best fitness at the end of a finished run; only the parts it stands in are read."""
    generations = folder.config.settings.generations
    first = generations - max(1, round(generations * PLATEAU_SHARE))
    parts = [
        folder.read_part(span)[max(0, first - span.start) :] for span in folder.spans if span.stop > first
    ]
    return float(np.median(History.join(parts).best))


def _late_successes(folder: RunFolder, simulate: Simulate) -> NDArray[np.int16]:
    n_instructions = len(folder.config.condition.instructions)
    path, shape = folder.path / FILE, (len(sampled_generations(folder)), N_BEST, n_instructions, 2)
    if path.exists():
        try:
            arrays = folder.read_arrays(path)
            check_array(path, arrays, "successes", shape, np.dtype(np.int16))
            check_range(path, arrays, "successes", 0, TRIALS_PER_AREA)
        except DamagedFileError as error:
            raise DamagedFileError(path, error.found, "remove it and repeat the command") from None
        return arrays["successes"]
    successes = simulate(folder)
    make_folder(path.parent)
    generations = np.array(sampled_generations(folder), np.int32)
    folder.write_arrays(path, {"generations": generations, "successes": successes})
    return successes


def simulated(folder: RunFolder) -> NDArray[np.int16]:
    """Successes [L, 5, I, 2] of the sampled generations' best, each agent in trials of its own."""
    successes = [successes_by_area(folder.config, *each) for each in sampled_best(folder)]
    return np.array(successes, np.int16)


def sampled_best(folder: RunFolder) -> Iterator[tuple[int, NDArray[np.float64]]]:
    """The sampled generations and their five best [5, 84]."""
    for span in late_spans(folder):
        for generation, best in best_genotypes(folder, span):
            if generation % SAMPLE_STEP == 0:
                yield generation, best
