"""A test of a run's late agents, kept beside the run part by part, each written once.

`postevaluation/gen-004000-004099.npz` holds what the agents of these generations made of one test. Late is
the last third of a run, generations 4000 to 5999 in the paper.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from arm2d.records import alike
from evolution.runs.folder import RunFolder
from evolution.runs.history import History
from evolution.runs.storage import make_folder

T = TypeVar("T")


@dataclass(frozen=True)
class LateTest(Generic[T]):
    """One test, whatever it asks.

    Attributes:
        folder: Name of its folder, in that of a run.
        result: The record of its results, all of whose fields are arrays with a first axis in common.
        test: Tests the agents of some generations of a run.
        check: Refuses arrays that it cannot have given; told where they come from, and of which generations
            of which run they should be.
    """

    folder: str
    result: type[T]
    test: Callable[[RunFolder, range], T]
    check: Callable[[Path, Mapping[str, NDArray], RunFolder, range], None]

    __eq__ = alike

    def path(self, run: RunFolder, span: range) -> Path:
        """Where the results of some generations are kept."""
        return run.path / self.folder / f"gen-{span.start:06d}-{span.stop - 1:06d}.npz"

    def complete(self, run: RunFolder, report: Callable[[int, int], None] | None = None) -> T:
        """Test a finished run, or go on where it was left; what is there already is read.

        Args:
            run: The run.
            report: Told after every part how many of how many are done.

        Raises:
            ValueError: If the run is not finished, is of another task than the paper's, or lacks another test
                that this one rests on.
            DamagedFileError: If a part of the run, or of the results, is damaged.
        """
        if len(run.finished_spans()) < len(run.spans):
            raise ValueError(f"{run.path} is not finished; go on with: wordarm evolve")
        _ = run.config.papers_condition  # refuses other tasks, before anything is written
        make_folder(run.path / self.folder)
        spans = late_spans(run)
        for done, span in enumerate(spans, 1):
            if not self.path(run, span).exists():
                self.write_part(run, span)
            if report:
                report(done, len(spans))
        return self.read(run)

    def read(self, run: RunFolder) -> T:
        """The results of a run that was tested.

        Raises:
            ValueError: If it was not, or not to the end.
            DamagedFileError: If a part of the results is damaged.
        """
        return joined(self.result, [self.read_part(run, span) for span in late_spans(run)])

    def read_part(self, run: RunFolder, span: range) -> T:
        """The results of some generations; raises as `read`."""
        path = self.path(run, span)
        if not path.exists():
            raise ValueError(f"{path} is missing; go on with: wordarm postevaluate {run.path}")
        with run.repairable(path):
            arrays = run.read_arrays(path)
            self.check(path, arrays, run, span)
        return self.result(**{name: arrays[name] for name in _names(self.result)})

    def write_part(self, run: RunFolder, span: range) -> None:
        """Test the agents of some generations and keep the results."""
        run.write_arrays(self.path(run, span), vars(self.test(run, span)))

    def progress(self, run: RunFolder) -> tuple[int, int]:
        """How many parts of how many are there."""
        spans = late_spans(run)
        return sum(self.path(run, span).exists() for span in spans), len(spans)


def joined(record: type[T], parts: list[T]) -> T:
    """Records of arrays put together along their first axis."""
    return record(
        **{name: np.concatenate([getattr(part, name) for part in parts]) for name in _names(record)}
    )


def late_spans(run: RunFolder) -> list[range]:
    """The late generations, part by part: the last third of a run."""
    first = run.config.settings.generations * 2 // 3
    return [range(max(span.start, first), span.stop) for span in run.spans if span.stop > first]


def late_history(run: RunFolder) -> History:
    """What is recorded of the late generations.

    Raises:
        DamagedFileError: If a part of the run is damaged.
    """
    first = late_spans(run)[0].start
    spans = [span for span in run.spans if span.stop > first]
    return History.join(run.read_part(span)[max(first - span.start, 0) :] for span in spans)


def best_genotypes(run: RunFolder, span: range) -> Iterator[tuple[int, NDArray[np.float64]]]:
    """(generation, its five best [5, 84]) of a span within one part of the run."""
    part = next(part for part in run.spans if span.start in part)
    history = run.read_part(part)
    for row in range(span.start - part.start, span.stop - part.start):
        yield int(history.generations[row]), history.best_genotypes[row]


def _names(record: Any) -> list[str]:
    """Of the fields of a record."""
    return [field.name for field in fields(record)]
