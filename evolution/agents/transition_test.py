"""The transition tests of a run's classed agents, kept beside the run (section VII, Fig. 4).

`transitions/gen-004000-004099.npz` holds the agents of those generations that belong to a class.
Axes: A agents, X transitions of a test.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d.records import brief
from evolution.agents import postevaluation
from evolution.agents.postevaluation import TRIALS, best_genotypes, late_spans
from evolution.agents.subtasks import AgentClass, classify
from evolution.agents.transitions import action_transitions, object_transitions, transition_successes
from evolution.runs.folder import RunFolder
from evolution.runs.history import check_array, check_range
from evolution.runs.storage import make_folder
from evolution.search.randomness import Purpose, generator
from evolution.search.settings import N_BEST

FOLDER: Final = "transitions"
CLASSES: Final = tuple(AgentClass)
NAMES: Final = ("generations", "ranks", "classes", "action", "object")


@dataclass(frozen=True)
class TransitionTest:
    """Successful trials, of 80, in every transition.

    Attributes:
        generations: [A] and
        ranks: [A], which agents.
        classes: [A], index into `CLASSES`.
        action: [A, X], in the order of `action_transitions`.
        object: [A, X], in the order of `object_transitions`.
    """

    generations: NDArray[np.int32]
    ranks: NDArray[np.int8]
    classes: NDArray[np.int8]
    action: NDArray[np.int16]
    object: NDArray[np.int16]

    __repr__ = brief

    @classmethod
    def join(cls, parts: list[TransitionTest]) -> TransitionTest:
        """Several tests as one."""
        return cls(*(np.concatenate([getattr(each, name) for each in parts]) for name in NAMES))


def run_transition_test(
    folder: RunFolder, report: Callable[[int, int], None] | None = None
) -> TransitionTest:
    """Test a post-evaluated run, or go on where it was left.

    Args:
        folder: The run.
        report: Told after every part how many of how many are done.

    Raises:
        ValueError: If the run is not post-evaluated.
        DamagedFileError: If a file is damaged.
    """
    make_folder(folder.path / FOLDER)
    spans = late_spans(folder)
    for done, span in enumerate(spans, 1):
        if not part_path(folder, span).exists():
            write_part(folder, span)
        if report:
            report(done, len(spans))
    return read_transition_test(folder)


def read_transition_test(folder: RunFolder) -> TransitionTest:
    """The results of a run that was tested.

    Raises:
        ValueError: If it was not, or not to the end.
        DamagedFileError: If a part is damaged.
    """
    return TransitionTest.join([read_part(folder, span) for span in late_spans(folder)])


def part_path(folder: RunFolder, span: range) -> Path:
    """Where the results of some generations are kept."""
    return folder.path / FOLDER / f"gen-{span.start:06d}-{span.stop - 1:06d}.npz"


def write_part(folder: RunFolder, span: range) -> None:
    """Test the classed agents of some generations and keep the results."""
    folder.write_arrays(part_path(folder, span), vars(_test_agents(folder, span)))


def _test_agents(folder: RunFolder, span: range) -> TransitionTest:
    """The classed agents of some generations; those of a generation meet the same trials."""
    config, successes = folder.config, postevaluation.read_part(folder, span).successes
    actions, objects = action_transitions(config.condition), object_transitions(config.condition)
    tests = []
    for (generation, genotypes), scored in zip(best_genotypes(folder, span), successes, strict=True):
        classes = np.full(len(genotypes), -1, np.int8)
        for index, members in enumerate(classify(scored, config.condition).values()):
            classes[members] = index
        ranks = np.flatnonzero(classes >= 0)
        rng = generator(config.seed, Purpose.TRANSITIONS, generation)
        tests.append(
            TransitionTest(
                generations=np.full(len(ranks), generation, np.int32),
                ranks=ranks.astype(np.int8),
                classes=classes[ranks],
                action=transition_successes(genotypes[ranks], actions, config.readings, rng).astype(np.int16),
                object=transition_successes(genotypes[ranks], objects, config.readings, rng).astype(np.int16),
            )
        )
    return TransitionTest.join(tests)


def read_part(folder: RunFolder, span: range) -> TransitionTest:
    """The results of some generations; raises as `read_transition_test`."""
    path = part_path(folder, span)
    if not path.exists():
        raise ValueError(f"{path} is missing; go on with: wordarm postevaluate {folder.path}")
    condition = folder.config.condition
    with folder.repairable(path):
        arrays = folder.read_arrays(path)
        n = np.size(arrays.get("generations", ()))
        for name, dtype in (("generations", np.int32), ("ranks", np.int8), ("classes", np.int8)):
            check_array(path, arrays, name, (n,), np.dtype(dtype))
        n_action, n_object = len(action_transitions(condition)), len(object_transitions(condition))
        check_array(path, arrays, "action", (n, n_action), np.dtype(np.int16))
        check_array(path, arrays, "object", (n, n_object), np.dtype(np.int16))
        check_range(path, arrays, "generations", span.start, span.stop - 1)
        check_range(path, arrays, "ranks", 0, N_BEST - 1)
        check_range(path, arrays, "classes", 0, len(CLASSES) - 1)
        for name in ("action", "object"):
            check_range(path, arrays, name, 0, TRIALS)
    return TransitionTest(*(arrays[name] for name in NAMES))
