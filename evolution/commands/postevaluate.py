"""`wordarm postevaluate`: the paper's first test of a run or of all runs of an experiment."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tyro.conf import Positional


@dataclass(frozen=True)
class PostEvaluate:
    """Test the five best of each late generation on all nine instructions, and on changes in mid-trial.

    Repeat the command to go on where it was stopped.
    """

    path: Positional[Path]
    """Run folder, or experiment folder with its runs below it."""

    def run(self) -> int:
        """Post-evaluate every finished run."""
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

        from evolution.agents.postevaluation import late_spans, post_evaluate
        from evolution.agents.solving import solved_trials
        from evolution.agents.transition_test import run_transition_test
        from evolution.experiments.experiment import open_experiment
        from evolution.experiments.standing import standing_of
        from evolution.runs.lock import locked

        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
        experiment, damaged = open_experiment(self.path), []
        with Progress(*columns) as bars:
            for run in experiment.all_runs:
                standing = standing_of(run.path, run.config)
                name = standing.name
                if standing.damage or not standing.finished:
                    bars.console.print(f"{name}: left out, {standing.damage or 'not finished'}")
                    continue
                parts = len(late_spans(run))
                first = bars.add_task(f"{name}, instructions", total=parts)
                second = bars.add_task(f"{name}, transitions", total=parts)
                try:
                    with locked(run.path):
                        post_evaluate(run, lambda done, _, bar=first: bars.update(bar, completed=done))
                        run_transition_test(run, lambda done, _, bar=second: bars.update(bar, completed=done))
                        solved_trials(run)
                except ValueError as error:
                    damaged.append(str(error))
        if damaged or experiment.unreadable:
            raise ValueError("; ".join([*experiment.unreadable, *damaged]))
        return 0
