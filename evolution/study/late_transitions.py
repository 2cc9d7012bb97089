"""The paper's second test on the agents a run is measured by: words that change in mid-trial.

Of the late generations every tenth is tested, and there the agents that belong to a class, in the trials that
`wordarm postevaluate` would give them. Axes: 3 classes, 2 tests (action, object).
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from evolution.agents.parts import best_genotypes, late_spans
from evolution.agents.subtasks import AgentClass, classify
from evolution.agents.transitions import action_transitions, object_transitions, passes, transition_successes
from evolution.runs.folder import RunFolder
from evolution.runs.history import check_array, check_range
from evolution.runs.storage import DamagedFileError, make_folder
from evolution.search.randomness import Purpose, generator
from evolution.study.measures import SAMPLE_STEP, RunMeasures

FILE: Final = Path("measures") / "transitions.npz"
CLASSES: Final = tuple(AgentClass)
TESTS: Final = ("action", "object")


def passed_transitions(folder: RunFolder, measures: RunMeasures) -> NDArray[np.int32]:
    """How many agents of each class pass each test, [3, 2]; kept beside the run.

    Args:
        folder: A finished run.
        measures: Of this run; they say which agents belong to a class.

    Raises:
        DamagedFileError: If a file of it is damaged.
    """
    path = folder.path / FILE
    if path.exists():
        try:
            arrays = folder.read_arrays(path)
            check_array(path, arrays, "passed", (len(CLASSES), len(TESTS)), np.dtype(np.int32))
            check_range(path, arrays, "passed", 0, measures.successes[..., 0, 0].size)
        except DamagedFileError as error:
            raise DamagedFileError(path, error.found, "remove it and repeat the command") from None
        return arrays["passed"]
    passed = _test(folder, measures)
    make_folder(path.parent)
    folder.write_arrays(path, {"passed": passed})
    return passed


def are_tested(path: Path) -> bool:
    """Whether a run's folder has the result."""
    return (path / FILE).exists()


def _test(folder: RunFolder, measures: RunMeasures) -> NDArray[np.int32]:
    """Test the sampled generations one by one."""
    config = folder.config
    transitions = action_transitions(config.papers_condition), object_transitions(config.papers_condition)
    sampled = (
        (generation, genotypes)
        for span in late_spans(folder)
        for generation, genotypes in best_genotypes(folder, span)
        if generation % SAMPLE_STEP == 0
    )
    passed = np.zeros((len(CLASSES), len(TESTS)), np.int32)
    for (generation, genotypes), successes in zip(sampled, measures.successes.sum(axis=-1), strict=True):
        members = np.stack(list(classify(successes, config.papers_condition).values()))  # [3, 5]
        ranks = np.flatnonzero(members.any(axis=0))
        rng = generator(config.seed, Purpose.TRANSITIONS, generation)
        for test, changes in enumerate(transitions):
            found = passes(transition_successes(genotypes[ranks], changes, config.readings, rng))
            passed[:, test] += (members[:, ranks] & found).sum(axis=1).astype(np.int32)
    return passed
