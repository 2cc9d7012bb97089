"""The stages of a run, as processes of an experiment carry them out: plain arguments in, exit code out."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from evolution.agents.postevaluation import post_evaluate
from evolution.agents.solving import solved_trials
from evolution.agents.transitions import run_transition_test
from evolution.answers import INTERRUPTED
from evolution.runs.folder import RunFolder
from evolution.runs.interrupt import StopRequest
from evolution.runs.lock import locked
from evolution.runs.run import Watcher, evolve
from evolution.search.config import RunConfig


def evolve_run(folder: str, config: Mapping[str, Any]) -> int:
    """Start a run, or go on with it; what it says goes to the log.

    Args:
        folder: Of the run.
        config: The run, as `RunConfig.to_mapping` gives it.

    Returns:
        130 if it was told to stop before its last generation.
    """
    run = RunConfig.from_mapping(config)
    with StopRequest() as stop:
        watcher = Watcher(
            on_start=lambda generation: print(f"{folder}: from generation {generation} on", flush=True),
            on_note=lambda note: print(note, file=sys.stderr),
            wants_stop=lambda: stop.requested,
        )
        done = evolve(Path(folder), run, watcher)
    if done < run.settings.generations:
        print(f"stopped after {done} of {run.settings.generations} generations")
        return INTERRUPTED
    return 0


def test_run(folder: str) -> int:
    """Carry out the paper's two tests of a finished run, or what is left of them.

    Args:
        folder: Of the run.
    """
    run = RunFolder.open(Path(folder))
    with locked(run.path):
        post_evaluate(run)
        run_transition_test(run)
        solved_trials(run)
    return 0
