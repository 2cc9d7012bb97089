"""The runs of an experiment that can be analysed, read whole; and a sentence for each of the others."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from shlex import quote

import numpy as np
from numpy.typing import NDArray

from arm2d.records import alike, brief
from evolution.agents.firsts import first_row
from evolution.agents.postevaluation import POST_EVALUATION, PostEvaluation
from evolution.agents.solving import all_solved
from evolution.agents.transitions import TRANSITION_TEST, TransitionTest
from evolution.experiments.standing import standing_of
from evolution.runs.folder import RunFolder
from evolution.runs.history import History
from evolution.runs.recorded import recorded_histories
from evolution.search.config import RunConfig


@dataclass(frozen=True)
class TestedRun:
    """A run that was evolved and tested to the end.

    Attributes:
        run: Its folder.
        best: [G], best fitness per generation.
        first_solved: First generation in which one genotype carried out all trials; -1 if none.
        genotypes: Distinct ones among the five best of the late generations.
        longest_stay: The most of these generations in which one of them was among the five best.
        evaluation: What its agents made of all nine instructions.
        transitions: What its classed agents made of changes in mid-trial.
    """

    run: RunFolder
    best: NDArray[np.float64]
    first_solved: int
    genotypes: int
    longest_stay: int
    evaluation: PostEvaluation
    transitions: TransitionTest

    __repr__ = brief
    __eq__ = alike


def read_tested_runs(runs: Iterable[RunFolder]) -> tuple[list[TestedRun], list[str]]:
    """The runs that are complete and sound, and for each of the others why it is left out and what to do.

    Raises:
        ValueError: If the runs are of different lengths, which cannot stand in one table.
    """
    tested, missing = [], []
    for run in runs:
        if reason := unfinished(run):
            missing.append(f"{name_of(run)}: left out, {reason}")
            continue
        try:
            tested.append(_read(run))
        except ValueError as error:
            missing.append(f"{name_of(run)}: left out, {error}")
    lengths = {found.run.config.settings.generations for found in tested}
    if len(lengths) > 1:
        raise ValueError(f"the runs have {sorted(lengths)} generations; analyse runs of one length together")
    return tested, missing


def unfinished(run: RunFolder) -> str:
    """What a run lacks to be analysed and how to go on, or nothing."""
    standing = standing_of(run.path, run.config)
    if standing.damage:
        return standing.damage
    if not standing.finished:
        return f"{standing.generations} generations so far; go on with: {_evolve_command(run)}"
    if standing.tested < standing.to_test:
        return f"not post-evaluated; go on with: wordarm postevaluate {quote(str(run.path))}"
    return ""


def _read(run: RunFolder) -> TestedRun:
    """All of a run that an analysis needs; raises `ValueError` if a file is missing or damaged."""
    evaluation, transitions = POST_EVALUATION.read(run), TRANSITION_TEST.read(run)
    history = History.join(recorded_histories(run))
    late = history.best_genotypes[-len(evaluation.generations) :]
    _, copies = np.unique(late.reshape(-1, late.shape[-1]), axis=0, return_counts=True)
    return TestedRun(
        run=run,
        best=history.best,
        first_solved=first_row(all_solved(run)),
        genotypes=len(copies),
        longest_stay=int(copies.max()),
        evaluation=evaluation,
        transitions=transitions,
    )


def _evolve_command(run: RunFolder) -> str:
    """What goes on with a run."""
    condition, seed = run.config.condition, run.config.seed
    command = f"wordarm evolve --condition={condition} --seed={seed} --output={quote(str(run.path))}"
    if run.config.differences(RunConfig(condition, seed)):
        command += ", with the settings and readings of its config.toml as flags"
    return command


def name_of(run: RunFolder) -> str:
    """Condition and seed."""
    return f"{run.config.condition}, seed {run.config.seed}"
