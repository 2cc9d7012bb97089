"""What a user of the library holds: a run that tells how it went, and agents that can be tried.

    run = evolution.evolve("run", evolution.RunConfig("with-indicate", seed=1))
    run.history.best                             [G], the highest fitness of each generation
    run.genotypes(100)                           [P, G], all of one generation, bred again
    run.champions[0].evaluate()                  all nine instructions, 80 trials each
    run.champions[0].record("touch green")       one trial, step by step

Axes: G generations, P genotypes of one generation, G genes (84 for three inter-neurons).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from reprlib import repr as shortened
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition, Instruction, Readings, TrialRecord
from arm2d.tasks.task import AnyTask, as_paper, papers_condition
from evolution.agents.behaviour import Behaviour, record_behaviour
from evolution.agents.lineage import Lineage, trace_lineage
from evolution.agents.recording import record_instruction
from evolution.experiments import experiment
from evolution.results.notable import NotableAgent
from evolution.runs import run as loop
from evolution.runs import sources
from evolution.runs.folder import CHAMPIONS, AnyRun, RunFolder
from evolution.runs.history import History
from evolution.runs.recorded import recorded_history
from evolution.runs.replay import population_at
from evolution.search.config import RunConfig
from evolution.search.evaluation import TRIALS_PER_AREA, Evaluation, evaluate
from evolution.search.settings import Settings

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False, eq=False)
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
        return record_instruction(self, instruction, start_area, trial_seed)

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
        return find_agent(self, generation=self._number(generation), rank=rank)

    @cached_property
    def champions(self) -> tuple[Agent, ...]:
        """The agents it is remembered by, chosen by experienced instructions alone; the best comes first.

        Raises:
            ValueError: If it is not finished, or the file is damaged.
        """
        if not self.finished:
            raise ValueError(f"{self.path} is not finished and has no champions yet; run.agent() is its best")
        n = len(self.read_arrays(self.path / CHAMPIONS)["genotypes"])
        return tuple(find_agent(self, rank=rank) for rank in range(n))

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
        return int(generation % self.generations)


@dataclass(frozen=True)
class Experiment(experiment.Experiment):
    """The runs of an experiment, by condition and in the order of their seeds; see `open_experiment`.

    Attributes:
        path: Its folder.
        runs: By condition.
        unreadable: A sentence for every run whose config.toml cannot be understood.
        copies: A sentence for every folder that holds a run which another one holds too.
    """

    runs: Mapping[Condition, tuple[Run, ...]]

    @property
    def all_runs(self) -> tuple[Run, ...]:
        """All runs, condition by condition."""
        return tuple(run for runs in self.runs.values() for run in runs)


def open_experiment(path: Path | str) -> Experiment:
    """The experiment in a folder; a single run's folder is an experiment of one.

    Raises:
        ValueError: If there is no readable run in it, or its runs took place under different readings.
    """
    found = experiment.open_experiment(path)
    runs = {condition: tuple(map(Run.open, own)) for condition, own in found.runs.items()}
    return Experiment(found.path, runs, found.unreadable, found.copies)


def load(path: AnyRun) -> Run:
    """A run that was started before, finished or not.

    Args:
        path: Its folder; a run as an experiment or its results hold it will do.

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
        ValueError: If the config is no `RunConfig`, or the folder holds something else, a damaged part, or is
            in use.
        OSError: If it cannot be written; what was written before stays whole.
    """
    config = RunConfig() if config is None else config
    if not isinstance(config, RunConfig):
        raise ValueError(
            f"config = {shortened(config)} must be a record, such as RunConfig(settings=Settings())"
        )
    loop.evolve(Path(path), config, watcher)
    return load(path)


def find_agent(
    source: AnyRun | NotableAgent,
    *,
    generation: int | None = None,
    rank: int = 0,
    condition: AnyTask | str | None = None,
) -> Agent:
    """An agent by what it is called: a run, a genotype file, a shipped name; or the one that was found best.

    Args:
        source: A run, its folder, a genotype file (.npz or .npy), a name such as "best-generaliser", or what
            `best_agent` found, which needs no generation and rank.
        generation: Of the run; by default its champions are meant.
        rank: 0 for the best of the generation, of the champions, or of the file.
        condition: For files that do not tell; with-indicate if none is given.

    Raises:
        ValueError: If there is no such thing, or it is not what it should be.
    """
    known = None if condition is None else as_paper(condition)
    if isinstance(source, NotableAgent):
        if (generation, rank) != (None, 0):
            raise ValueError(
                f"{source.run.path} and the agent's place are known; leave generation and rank out"
            )
        source, generation, rank = source.run, source.generation, source.rank
    return Agent(**vars(sources.find_agent(source, generation=generation, rank=rank, condition=known)))
