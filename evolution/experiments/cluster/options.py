"""What is asked of SLURM: flags, then a file, then the defaults."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, Final

from evolution.search.toml import check_keys, read_toml_file, table_of

# What a run holds at most, and a worker that watches over runs [MB], with room to spare; see docs/cluster.md.
MEMORY_OF_A_RUN: Final = 300
MEMORY_OF_A_WORKER: Final = 500
LOOPBACK: Final = "lo"
MOST_CORES: Final = 10_000
MOST_JOBS: Final = 10_000
WALLTIME: Final = re.compile(r"(\d{1,4}-)?\d{1,6}(:\d{1,2}){0,2}")
DIRECTIVE: Final = re.compile(r"-|[a-z][a-z-]+(=|$)")
NAME: Final = re.compile(r"[\w.,@%+-]+")
INTERFACE: Final = re.compile(r"[\w.:@-]{1,15}", re.ASCII)
MEMORY: Final = re.compile(r"\d{1,6}(\.\d{1,3})? ?[kMGT]i?B", re.IGNORECASE)


@dataclass(frozen=True)
class SlurmOptions:
    """What every SLURM job asks for, and how many there are; see docs/cluster.md for what is not given."""

    jobs: int | None = None
    """SLURM jobs at most at a time; each is one worker. By default 1."""

    cores: int | None = None
    """Processors of each SLURM job, and runs at a time in it. By default 16."""

    memory: str | None = None
    """Memory of each SLURM job, such as 8GB. By default 300 MB for each core and 500 MB."""

    walltime: str | None = None
    """Longest time of each SLURM job; the next one goes on with what it leaves. By default 04:00:00."""

    queue: str | None = None
    """Partition."""

    account: str | None = None
    """Whom the time is charged to."""

    interface: str | None = None
    """Network interface by which nodes reach this machine, such as ib0. By default lo: this machine alone."""

    directives: tuple[str, ...] | None = None
    """More directives of sbatch, such as constraint=rome."""

    prologue: tuple[str, ...] | None = None
    """Lines of the job script before the worker, such as 'module load python'."""

    tls: bool | None = None
    """Encrypt, and let nobody in but this command and its workers. By default yes, by keys made anew.
    Without, whoever reaches the scheduler can run programs as you: with lo every user of this machine."""

    def complete(self, file: Path | None = None) -> SlurmOptions:
        """The same with what a file says, then with the defaults, where nothing is said.

        Args:
            file: A TOML file with a table [slurm].

        Raises:
            ValueError: With one sentence, if the file cannot be understood or a value is impossible.
        """
        self.check()
        said = replace(read_options(file), **self._given()) if file else self
        options = replace(DEFAULTS, **said._given())
        memory = f"{MEMORY_OF_A_WORKER + (options.cores or 1) * MEMORY_OF_A_RUN}MB"
        return options if options.memory else replace(options, memory=memory)

    def check(self) -> None:
        """Refuse impossible values.

        Raises:
            ValueError: With the first of them.
        """
        for name, most in (("cores", MOST_CORES), ("jobs", MOST_JOBS)):
            value = getattr(self, name)
            if value is not None and (type(value) is not int or not 1 <= value <= most):
                raise ValueError(f"slurm {name} = {value!r} must be a whole number from 1 to {most}")
        for name, (pattern, what) in PATTERNS.items():
            value = getattr(self, name)
            if value is not None and not (isinstance(value, str) and pattern.fullmatch(value)):
                raise ValueError(f"slurm {name} = {value!r} must be {what}")
        if not isinstance(self.tls, bool | None):
            raise ValueError(f"slurm tls = {self.tls!r} must be true or false")
        for name in ("directives", "prologue"):
            self._check_lines(name)

    def _check_lines(self, name: str) -> None:
        lines = getattr(self, name) or ()
        if not isinstance(lines, tuple) or not all(isinstance(x, str) and x.isprintable() for x in lines):
            raise ValueError(f"slurm {name} = {lines!r} must be a list of single lines")
        for line in lines if name == "directives" else ():
            if not DIRECTIVE.match(line):
                raise ValueError(f"slurm directive {line!r} must be an option of sbatch, such as nice=100")

    def _given(self) -> dict[str, Any]:
        """What is said."""
        values = {each.name: getattr(self, each.name) for each in fields(self)}
        return {name: value for name, value in values.items() if value is not None}


DEFAULTS: Final = SlurmOptions(
    jobs=1, cores=16, walltime="04:00:00", interface=LOOPBACK, directives=(), prologue=(), tls=True
)
PATTERNS: Final = {
    "queue": (NAME, "one word, as sbatch takes it"),
    "account": (NAME, "one word, as sbatch takes it"),
    "interface": (INTERFACE, "the name of a network interface, such as ib0"),
    "walltime": (WALLTIME, "like 04:00:00, or 2-00:00:00"),
    "memory": (MEMORY, "like 8GB or 500MB"),
}


def read_options(path: Path) -> SlurmOptions:
    """The options in the table [slurm] of a TOML file.

    Raises:
        ValueError: With one sentence, if there is none or it cannot be understood.
    """
    if not path.is_file():
        raise ValueError(f"{path} is not a file; give a TOML file with a table [slurm]")
    try:
        return _options_of(read_toml_file(path))
    except UnicodeDecodeError:
        raise ValueError(f"{path}: it is not text in UTF-8") from None
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _options_of(values: Mapping[str, Any]) -> SlurmOptions:
    """The options in the values of a file."""
    known = [each.name for each in fields(SlurmOptions)]
    if "slurm" not in values:
        raise ValueError(f"there is no table [slurm]; its keys may be {', '.join(known)}")
    table = table_of("slurm", values["slurm"])
    check_keys("slurm option", table, known)
    given: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else value for name, value in table.items()
    }
    options = SlurmOptions(**given)
    options.check()
    return options
