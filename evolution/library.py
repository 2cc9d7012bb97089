"""What a user of the library holds: a run that tells how it went, and agents that can be tried.

    run = evolution.evolve("run", evolution.RunConfig("with-indicate", seed=1))
    run.history.best                             [G], the highest fitness of each generation
    run.genotypes(100)                           [P, G], all of one generation, bred again
    run.champions[0].evaluate()                  all nine instructions, 80 trials each
    run.champions[0].record("touch green")       one trial, step by step

Axes: G generations, P genotypes of one generation, G genes (84 for three inter-neurons).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from arm2d import Instruction, Readings, TrialRecord
from arm2d.tasks.task import AnyTask, as_paper, papers_condition
from evolution.agents.behaviour import Behaviour, record_behaviour
from evolution.agents.lineage import Lineage, trace_lineage
from evolution.agents.recording import record_instruction
from evolution.runs import run as loop
from evolution.runs import sources
from evolution.runs.folder import CHAMPIONS, RunFolder
from evolution.runs.history import History
from evolution.runs.recorded import recorded_history
from evolution.runs.replay import population_at
from evolution.search.config import RunConfig
from evolution.search.evaluation import TRIALS_PER_AREA, Evaluation, evaluate
from evolution.search.settings import Settings

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False)
class Agent(sources.Agent):
    """One evolved controller with the world it evolved in; see `find_agent`, `Run.agent`, `Run.champions`.

    Attributes:
        genotype: [G].
        condition: Whose instructions it hears.
        readings: The world it evolved in.
        origin: Where it comes from, for people.
        name: The same, fit for a file name.
        folder: The run it was taken from, if it was.
    """

    def evaluate(self, *, per_area: int = TRIALS_PER_AREA, trial_seed: int = 0) -> Evaluation:
        """What it makes of all nine instructions: `per_area` fresh trials of each from each start area."""
        return evaluate(
            self.genotype, self.condition, self.readings, per_area=per_area, trial_seed=trial_seed
        )

    def record(
        self,
        instruction: Instruction | str,
        *,
        start_area: Literal["right", "left"] = "right",
        trial_seed: int = 0,
    ) -> TrialRecord:
        """One trial from a freshly drawn start, step by step.

        Args:
            instruction: One of the nine of its condition; text such as "touch green" will do.
            start_area: Where S1 starts.
            trial_seed: Draws start angle and object positions.

        Raises:
            ValueError: If there is no such instruction, or its condition has none.
        """
        asked = Instruction.parse(instruction) if isinstance(instruction, str) else instruction
        return record_instruction(self, asked, start_area, trial_seed)

    def behaviour(self, *, per_area: int = 20, trial_seed: int = 0) -> Behaviour:
        """Trials of all nine instructions, step by step, with its neurons."""
        condition = papers_condition(self.condition, "this analysis")
        return record_behaviour(
            self.genotype, condition, self.readings, per_area=per_area, trial_seed=trial_seed
        )

    def heat_map(self, *, per_area: int = TRIALS_PER_AREA, trial_seed: int = 0) -> Figure:
        """A figure of what `evaluate` gives."""
        from evolution.figures.run import heat_map

        return heat_map(self.evaluate(per_area=per_area, trial_seed=trial_seed), self.origin)


@dataclass(frozen=True, repr=False)
class Run(RunFolder):
    """A run as its folder holds it; see `load` and `evolve`. What has been read stays as it was read.

    Attributes:
        path: The folder.
        config: All that determines it.
    """

    def __repr__(self) -> str:
        config = self.config
        return f"<Run: {config.condition}, seed {config.seed}, {self.path}>"

    @property
    def condition(self) -> AnyTask:
        """Which third action is met, or a task of one's own."""
        return self.config.condition

    @property
    def seed(self) -> int:
        """All of its random numbers follow from it."""
        return self.config.seed

    @property
    def settings(self) -> Settings:
        """The genetic algorithm."""
        return self.config.settings

    @property
    def readings(self) -> Readings:
        """How the paper is understood."""
        return self.config.readings

    @property
    def finished(self) -> bool:
        """Whether its last generation is scored and its champions are chosen."""
        return (self.path / CHAMPIONS).exists()

    @cached_property
    def history(self) -> History:
        """Every scored generation: `best`, `mean`, `median`, `worst` [G], `fitness` and `parents` [G, P].

        Raises:
            ValueError: If nothing is recorded yet, or a file is damaged.
        """
        return recorded_history(self)

    @property
    def generations(self) -> int:
        """G, how many generations are scored."""
        return len(self.history)

    @property
    def fitness(self) -> NDArray[np.float64]:
        """Of every genotype of every generation, [G, P]."""
        return self.history.fitness

    def genotypes(self, generation: int = -1) -> NDArray[np.float64]:
        """All genotypes of a generation, [P, G], bred again bit by bit.

        Args:
            generation: From 0; -1 is the last one that is scored.

        Raises:
            ValueError: If the run has not come so far, or a file is damaged.
        """
        return population_at(self, self._number(generation)).genotypes

    def agent(self, generation: int = -1, rank: int = 0) -> Agent:
        """The genotype that came `rank`-th in a generation, from 0; raises as `genotypes`."""
        return find_agent(self.path, generation=self._number(generation), rank=rank)

    @cached_property
    def champions(self) -> tuple[Agent, ...]:
        """The agents it is remembered by, chosen by experienced instructions alone; the best comes first.

        Raises:
            ValueError: If it is not finished, or the file is damaged.
        """
        if not self.finished:
            raise ValueError(f"{self.path} is not finished and has no champions yet; run.agent() is its best")
        n = len(self.read_arrays(self.path / CHAMPIONS)["genotypes"])
        return tuple(find_agent(self.path, rank=rank) for rank in range(n))

    def lineage(self, generation: int = -1, rank: int = 0) -> Lineage:
        """The line of ancestors of an agent, from generation 0 on; raises as `genotypes`."""
        return trace_lineage(self, self._number(generation), rank)

    def fitness_curve(self) -> Figure:
        """A figure of best and mean fitness over the generations."""
        from evolution.figures.run import fitness_curve

        origin = f"{self.condition}, seed {self.seed}, {self.generations} generations"
        return fitness_curve(self.history, origin, self.config.task.largest_fitness)

    def _number(self, generation: int) -> int:
        """The number of a generation that may be counted from the end."""
        if not -self.generations <= generation < self.generations:
            raise ValueError(
                f"{self.path} has no generation {generation}; it has {self.generations}, numbered from 0"
            )
        return generation % self.generations


def load(path: Path | str) -> Run:
    """A run that was started before, finished or not.

    Args:
        path: Its folder.

    Raises:
        ValueError: If there is none, or its config.toml cannot be understood.
    """
    return Run.open(path)


def evolve(path: Path | str, config: RunConfig | None = None, watcher: loop.Watcher | None = None) -> Run:
    """Start a run in a folder, or go on with it, until its last generation or until stopped.

    Ctrl-C loses at most the last hundred generations; the same call goes on.

    Args:
        path: The folder; made if it is not there.
        config: The run; by default seed 1 of With-Indicate with the paper's settings, about a minute.
            A folder with another one is refused.
        watcher: Is told of progress, and may stop the run.

    Raises:
        ValueError: If the folder holds something else, a damaged part, or is in use.
        OSError: If it cannot be written; what was written before stays whole.
    """
    loop.evolve(Path(path), config or RunConfig(), watcher)
    return load(path)


def find_agent(
    text: Path | str,
    *,
    generation: int | None = None,
    rank: int = 0,
    condition: AnyTask | str | None = None,
) -> Agent:
    """An agent by what it is called: a run's folder, a genotype file, or a shipped name.

    Args:
        text: Run folder, genotype file (.npz or .npy), or a name such as "best-generaliser".
        generation: Of the run; by default its champions are meant.
        rank: 0 for the best of the generation, of the champions, or of the file.
        condition: For files that do not tell; with-indicate if none is given.

    Raises:
        ValueError: If there is no such thing, or it is not what it should be.
    """
    known = None if condition is None else as_paper(condition)
    return Agent(**vars(sources.find_agent(str(text), generation=generation, rank=rank, condition=known)))
