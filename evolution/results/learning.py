"""Learning curves of whatever learns the seven instructions, so that they can stand side by side.

The table has a row for every test of a learner: what it had seen and spent by then, and how many trials of
each of the nine instructions it carried out.

Axes: E tests, 9 instructions.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import Condition, Instruction
from arm2d.records import alike, brief
from evolution.runs.storage import write_atomically
from evolution.search.evaluation import TRIALS_PER_AREA

TRIALS: Final = 2 * TRIALS_PER_AREA  # of each instruction, in a test
_OWN: Final = ("learner", "condition", "seed", "steps", "cpu [s]")


@dataclass(frozen=True)
class LearningCurve:
    """How one learner came along.

    Attributes:
        learner: Its name, such as "evolution".
        condition: Whose seven instructions it learnt from.
        seed: Of its random numbers.
        steps: [E], steps of trials it had learnt from, 0.1 s each.
        cpu: [E], processor time it had taken [s], tests not counted.
        successes: [E, 9], successful trials of 80, in the order of the condition's instructions.
    """

    learner: str
    condition: Condition
    seed: int
    steps: NDArray[np.int64]
    cpu: NDArray[np.float64]
    successes: NDArray[np.int64]

    __repr__ = brief
    __eq__ = alike

    def __len__(self) -> int:
        return len(self.steps)

    @classmethod
    def empty(cls, learner: str, condition: Condition, seed: int) -> LearningCurve:
        """Of a learner that was not tested yet."""
        whole = np.int64
        return cls(learner, condition, seed, np.zeros(0, whole), np.zeros(0), np.zeros((0, 9), whole))

    def longer(self, steps: int, cpu: float, successes: ArrayLike) -> LearningCurve:
        """With one more test."""
        return replace(
            self,
            steps=np.append(self.steps, steps),
            cpu=np.append(self.cpu, cpu),
            successes=np.vstack([self.successes, np.asarray(successes, np.int64)]),
        )

    @property
    def experienced(self) -> NDArray[np.float64]:
        """[E], share of successful trials of the seven instructions it learnt from."""
        return self._of(self.condition.experienced).mean(axis=1) / TRIALS

    @property
    def held_out(self) -> NDArray[np.float64]:
        """[E, 2], the same of each instruction it never met."""
        return self._of(self.condition.held_out) / TRIALS

    @property
    def worst(self) -> NDArray[np.float64]:
        """[E], the same of the experienced instruction it is worst at."""
        return self._of(self.condition.experienced).min(axis=1) / TRIALS

    def _of(self, instructions: Sequence[Instruction]) -> NDArray[np.int64]:
        return self.successes[:, [self.condition.instructions.index(each) for each in instructions]]


def write_curves(path: Path, curves: Sequence[LearningCurve]) -> None:
    """Store curves as a table.

    Raises:
        OSError: If it cannot be written; then what was there stays.
    """
    file = io.StringIO()
    out = csv.writer(file, lineterminator="\n")
    out.writerow([*_OWN, *curves[0].condition.instructions])
    for curve in curves:
        for steps, cpu, successes in zip(curve.steps, curve.cpu, curve.successes, strict=True):
            row = (curve.learner, curve.condition, curve.seed, steps, f"{cpu:.1f}", *successes)
            out.writerow(row)
    write_atomically(path, file.getvalue().encode())


def read_curves(path: Path) -> list[LearningCurve]:
    """Curves as they were stored, times to a tenth of a second.

    Raises:
        ValueError: If it is no such table.
        OSError: If it cannot be read.
    """
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    try:
        found = groupby(rows, lambda row: (row["learner"], Condition(row["condition"]), int(row["seed"])))
        return [_from_rows(*own, list(tests)) for own, tests in found]
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(
            f"{path} is no table of learning curves ({error!r} is amiss); its columns are {', '.join(_OWN)} "
            "and the nine instructions"
        ) from None


def _from_rows(
    learner: str, condition: Condition, seed: int, rows: Sequence[dict[str, str]]
) -> LearningCurve:
    return LearningCurve(
        learner,
        condition,
        seed,
        np.array([int(row["steps"]) for row in rows]),
        np.array([float(row["cpu [s]"]) for row in rows]),
        np.array([[int(row[str(each)]) for each in condition.instructions] for row in rows]),
    )
