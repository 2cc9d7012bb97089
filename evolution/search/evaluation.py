"""How well genotypes carry out all instructions of a condition, or of a task (section VII)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import Readings, Trials, TrialScores, draw_trials, run_trials
from arm2d.readings import given_or_default
from arm2d.records import alike
from arm2d.tasks.task import AnyTask, as_paper
from evolution.search.algorithm import mean_in_order
from evolution.search.randomness import Purpose, generator

# The paper's: 80 trials of each instruction, 40 from each start area.
TRIALS_PER_AREA: Final = 40


@dataclass(frozen=True)
class Evaluation:
    """What P genotypes made of all instructions, nine in the paper, in the order of `condition.instructions`.

    Attributes:
        condition: Names the instructions.
        per_area: Trials of each instruction from each start area.
        trial_seed: What the trials were drawn with.
        successes: [P, 9, 2], successful trials from the right and from the left area.
        fitness: [P, 9], mean F1 + F2 + F3.
        f1: [P, 9], mean F1,
        f2: [P, 9], mean F2,
        f3: [P, 9], mean F3.
        steps: [P, 9], mean number of steps.
    """

    condition: AnyTask
    per_area: int
    trial_seed: int
    successes: NDArray[np.int64]
    fitness: NDArray[np.float64]
    f1: NDArray[np.float64]
    f2: NDArray[np.float64]
    f3: NDArray[np.float64]
    steps: NDArray[np.float64]

    __eq__ = alike

    @classmethod
    def of(
        cls,
        scores: TrialScores,
        condition: AnyTask | str,
        *,
        per_area: int = TRIALS_PER_AREA,
        trial_seed: int = 0,
    ) -> Evaluation:
        """What scores [P, T] of `evaluation_trials` come to, whoever made them.

        Args:
            scores: Such as `VectorWorld.scores()` of a controller of your own.
            condition: As the trials were drawn with, and likewise
            per_area: and
            trial_seed: which the record keeps.

        Raises:
            ValueError: If there are not as many trials as so many of each instruction are.
        """
        condition = as_paper(condition)
        n_genotypes, n_trials = scores.f1.shape
        n_instructions = len(condition.instructions)
        if n_trials != n_instructions * 2 * per_area:
            raise ValueError(
                f"{n_trials} trials are not {2 * per_area} of each of {n_instructions} instructions; "
                "give the per_area that they were drawn with"
            )

        def mean(values: NDArray) -> NDArray[np.float64]:
            return mean_in_order(values.reshape(n_genotypes, n_instructions, -1))

        return cls(
            condition=condition,
            per_area=per_area,
            trial_seed=trial_seed,
            successes=scores.success.reshape(n_genotypes, n_instructions, 2, per_area).sum(axis=-1),
            fitness=mean(scores.fitness),
            f1=mean(scores.f1),
            f2=mean(scores.f2),
            f3=mean(scores.f3),
            steps=mean(scores.steps),
        )

    def __repr__(self) -> str:
        n_agents, n_instructions = self.fitness.shape
        share = 100 * self.success.mean()
        size = f"{n_agents} x {n_instructions} instructions x {self.trials} trials"
        return f"<Evaluation: {size}, {share:.0f} % carried out>"

    @property
    def success(self) -> NDArray[np.float64]:
        """Share of the trials of each instruction that were carried out, [P, 9]."""
        return self.successes.sum(axis=-1) / self.trials

    @property
    def trials(self) -> int:
        """Trials of each instruction."""
        return 2 * self.per_area

    @property
    def experienced(self) -> NDArray[np.bool_]:
        """Which of the instructions were met during evolution, [9]."""
        return np.array([word in self.condition.experienced for word in self.condition.instructions])


def evaluate(
    genotypes: ArrayLike,
    condition: AnyTask | str,
    readings: Readings | None = None,
    *,
    per_area: int = TRIALS_PER_AREA,
    trial_seed: int = 0,
) -> Evaluation:
    """Run fresh trials of all instructions.

    Args:
        genotypes: [P, G], or one [G]; 84 genes for three inter-neurons. All meet the same trials.
        condition: Which nine instructions; its name, such as "with-ignore", will do. Or a task of your own.
        readings: The world, which should be the one they evolved in; the default readings if none are given.
        per_area: Trials of each instruction from each start area.
        trial_seed: Draws the trials.

    Raises:
        ValueError: If a genotype is unsound, or there are no trials.
    """
    readings = given_or_default(readings)
    trials = evaluation_trials(condition, readings, per_area=per_area, trial_seed=trial_seed)
    scores = run_trials(genotypes, trials, readings)
    return Evaluation.of(scores, condition, per_area=per_area, trial_seed=trial_seed)


def evaluation_trials(
    condition: AnyTask | str,
    readings: Readings | None = None,
    *,
    per_area: int = TRIALS_PER_AREA,
    trial_seed: int = 0,
) -> Trials:
    """The trials that `evaluate` runs: instruction by instruction, right starts before left ones.

    Args:
        condition: Which instructions, as in `evaluate`.
        readings: The world; the default readings if none are given.
        per_area: Trials of each instruction from each start area.
        trial_seed: Draws the trials.

    Raises:
        ValueError: If there are no trials.
    """
    condition, rng = as_paper(condition), generator(trial_seed, Purpose.EVALUATION)
    return draw_trials(condition.instructions, per_area, given_or_default(readings), rng, condition)
