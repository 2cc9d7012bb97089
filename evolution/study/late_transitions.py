"""The paper's second test on the agents a run is measured by: words that change in mid-trial.

Of the late generations every tenth is tested, and there the agents that belong to a class, in the trials that
`wordarm postevaluate` would give them. Axes: 3 classes, 2 tests (action, object).
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from evolution.agents.subtasks import AgentClass, classify
from evolution.agents.transitions import BothTests, Candidates, both_tests, passes
from evolution.runs.folder import RunFolder
from evolution.runs.history import check_array, check_range
from evolution.runs.storage import DamagedFileError, make_folder
from evolution.study.measures import RunMeasures, sampled_best

FILE: Final = Path("measures") / "transitions.npz"
CLASSES: Final = tuple(AgentClass)
TESTS: Final = ("action", "object")


def passed_transitions(
    folder: RunFolder, measures: RunMeasures, tests: BothTests = both_tests
) -> NDArray[np.int32]:
    """How many agents of each class pass each test, [3, 2]; kept beside the run.

    Args:
        folder: A finished run.
        measures: Of this run; they say which agents belong to a class.
        tests: Carries them out.

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
    passed = _test(folder, measures, tests)
    make_folder(path.parent)
    folder.write_arrays(path, {"passed": passed})
    return passed


def are_tested(path: Path) -> bool:
    """Whether a run's folder has the result."""
    return (path / FILE).exists()


def _test(folder: RunFolder, measures: RunMeasures, tests: BothTests) -> NDArray[np.int32]:
    """Test the classed agents of the sampled generations."""
    candidates, classes = [], []
    for (generation, best), successes in zip(
        sampled_best(folder), measures.successes.sum(axis=-1), strict=True
    ):
        members = np.stack(list(classify(successes, folder.config.papers_condition).values()))  # [3, 5]
        ranks = np.flatnonzero(members.any(axis=0))
        candidates.append(Candidates(generation, best, ranks))
        classes.append(members[:, ranks])
    passed = np.zeros((len(CLASSES), len(TESTS)), np.int32)
    for members, successes in zip(classes, tests(folder.config, candidates), strict=True):
        for test, found in enumerate(map(passes, successes)):
            passed[:, test] += (members & found).sum(axis=1).astype(np.int32)
    return passed
