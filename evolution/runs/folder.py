"""The folder of one run: which files it holds, and how they are read and written (docs/file-formats.md).

Parts are written once. Each `.npz` names the config.toml it
belongs to, so that a file of another run is not taken for one of this.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from reprlib import repr as shortened
from typing import Final, Self

import numpy as np
from numpy.typing import NDArray

from arm2d.files import is_temporary, read_file
from evolution.runs.history import History, history_from_arrays
from evolution.runs.storage import (
    DamagedFileError,
    make_folder,
    read_arrays,
    verified_bytes,
    write_arrays,
    write_atomically,
)
from evolution.search.config import RunConfig
from evolution.search.toml import read_toml_file

GENERATIONS_PER_PART: Final = 100
CONFIG: Final = "config.toml"
LARGEST_CONFIG: Final = 1_000_000  # [bytes]
META: Final = "meta.json"
PARTS: Final = "parts"
CHECKPOINT: Final = "checkpoint.npz"
CHAMPIONS: Final = "champions.npz"
LOCK: Final = "lock"
LEASE: Final = "lease"
ANALYSES: Final = ("postevaluation", "transitions", "evaluation", "lineage", "behaviour", "measures")
OWN_FILES: Final = {CONFIG, META, PARTS, CHECKPOINT, CHAMPIONS, LOCK, LEASE, *ANALYSES}
# What commands put beside them unless they are given another place.
BESIDE: Final = {"videos", "results", "report.html"}
# Where runs are: in an experiment; in one with variants.
LAYOUTS: Final = ("*/*", "*/*/*")


@dataclass(frozen=True)
class RunFolder:
    """The files of one run.

    Attributes:
        path: The folder.
        config: The run.
    """

    path: Path
    config: RunConfig

    @classmethod
    def open(cls, path: RunFolder | Path | str) -> Self:
        """The folder of a run that was started before, by its path; a run that is open already as it is.

        Raises:
            ValueError: If there is none, or its config.toml cannot be understood.
        """
        if isinstance(path, RunFolder):
            return path if isinstance(path, cls) else cls(path.path, path.config)
        if not isinstance(path, (str, PathLike)):
            raise ValueError(f"{shortened(path)} is no run; give a run, or the path of its folder")
        path = Path(path)
        config = path / CONFIG
        if not path.is_dir():
            raise ValueError(f"{path} is not a folder; give the folder of a run, with its {CONFIG}")
        _refuse_links(path)
        if not config.is_file():
            # In the folder of a condition, too.
            runs = (found for layout in ("*", *LAYOUTS) for found in sorted(path.glob(f"{layout}/{CONFIG}")))
            if below := next(runs, None):
                raise ValueError(f"{path} is no run but holds some; give one of them, such as {below.parent}")
            raise ValueError(f"{path} holds no run: {CONFIG} is missing; start one with: wordarm evolve")
        try:
            return cls(path, RunConfig.from_mapping(read_toml_file(config)))
        except ValueError as error:
            raise ValueError(
                f"{config} cannot be read: {error}; remove it and repeat the command that started the run"
            ) from None

    @classmethod
    def create(cls, path: Path, config: RunConfig) -> Self:
        """The folder of this run, with its config.toml.

        Raises:
            ValueError: If the folder holds another run, or other things.
            OSError: If it cannot be written.
        """
        refuse_other(path, config)
        make_folder(path / PARTS)
        if not (path / CONFIG).exists():
            write_atomically(path / CONFIG, config.to_toml().encode())
        return cls(path, config)

    @property
    def identity(self) -> str:
        """SHA-256 of config.toml, which every array file of the run carries."""
        return hashlib.sha256(read_file(self.path / CONFIG, LARGEST_CONFIG)).hexdigest()

    @property
    def spans(self) -> list[range]:
        """The generations of each part of the finished run."""
        end = self.config.settings.generations
        return [range(i, min(i + GENERATIONS_PER_PART, end)) for i in range(0, end, GENERATIONS_PER_PART)]

    def part_path(self, span: range) -> Path:
        """Where the generations of `span` are kept."""
        return self.path / PARTS / f"gen-{span.start:06d}-{span.stop - 1:06d}.npz"

    def finished_spans(self) -> list[range]:
        """The spans whose parts are there, from generation 0 on without a gap.

        Raises:
            DamagedFileError: If a part is missing although later ones are there.
        """
        present = [self.part_path(span).exists() for span in self.spans]
        n = present.index(False) if False in present else len(present)
        if any(present[n:]):
            raise self.damaged(self.spans[n], "it is missing")
        return self.spans[:n]

    def check_part(self, span: range) -> None:
        """Verify a part's checksum only; raises as `read_part`."""
        try:
            verified_bytes(self.part_path(span))
        except DamagedFileError as error:
            raise self.damaged(span, error.found) from None

    def read_part(self, span: range) -> History:
        """The generations of `span`.

        Raises:
            DamagedFileError: If the part is not what was written.
        """
        path = self.part_path(span)
        try:
            return history_from_arrays(path, self.read_arrays(path), span, self.config)
        except DamagedFileError as error:
            raise self.damaged(span, error.found) from None

    def write_part(self, span: range, history: History) -> None:
        """Keep the generations of `span` for good."""
        self.write_arrays(self.part_path(span), history.arrays())

    def read_arrays(self, path: Path) -> dict[str, NDArray]:
        """The arrays of one of this run's files.

        Raises:
            DamagedFileError: If the file is not what was written, or is another run's.
        """
        with self.repairable(path):
            arrays = read_arrays(path)
            if str(arrays.pop("config_sha256", "")) != self.identity:
                raise DamagedFileError(path, f"it does not belong to this {CONFIG}")
        return arrays

    @contextmanager
    def repairable(self, path: Path) -> Iterator[None]:
        """While open, errors of a damaged file tell how to repair it."""
        try:
            yield
        except DamagedFileError as error:
            next_move = f"put it right with: wordarm verify {self.path} --repair"
            raise DamagedFileError(path, error.found, next_move) from None

    def write_arrays(self, path: Path, arrays: dict[str, NDArray]) -> None:
        """Write arrays to one of this run's files."""
        write_arrays(path, {"config_sha256": np.array(self.identity), **arrays})

    def damaged(self, span: range, found: str) -> DamagedFileError:
        """The error of a part, with the way to repair it."""
        return DamagedFileError(
            self.part_path(span),
            found,
            f"recompute generations {span.start} to {span.stop - 1} with: "
            f"wordarm verify {self.path} --repair",
        )


# How a run is given to whatever needs its files.
AnyRun = RunFolder | Path | str


def refuse_other(path: Path, config: RunConfig) -> None:
    """Refuse, before anything is written, a folder of another run or of other things.

    Raises:
        ValueError: With the difference.
    """
    _refuse_links(path)
    if (path / CONFIG).exists():
        if differences := RunFolder.open(path).config.differences(config):
            raise ValueError(f"{path} was started with {'; '.join(differences)}; choose a new directory")
    elif path.is_dir():
        names = {each.name for each in path.iterdir() if not is_temporary(each.name)}
        if strangers := sorted(names - OWN_FILES - BESIDE):
            raise ValueError(f"{path} holds {strangers[0]} but no run; choose a new directory")


def _refuse_links(path: Path) -> None:
    """Refuse a run whose own files or folders lie elsewhere, for there would be written."""
    for name in sorted(OWN_FILES):
        if (path / name).is_symlink():
            raise ValueError(
                f"{path / name} is a symbolic link, but a run's files lie in its folder; "
                "remove the link, or put there what it leads to"
            )
