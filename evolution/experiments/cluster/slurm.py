"""Workers from SLURM: what is asked of it, and the cluster that dask-jobqueue makes of the answer."""

from __future__ import annotations

import re
import shutil
import sys
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any, Final

import dask.config
import psutil
from dask.utils import parse_bytes
from dask_jobqueue.slurm import SLURMCluster, SLURMJob
from distributed import Client

from evolution.experiments.cluster.connection import Connection
from evolution.experiments.cluster.keys import key_folder, own_keys
from evolution.runs.storage import make_folder

# What a run holds at most, and a worker that watches over runs [MB], with room to spare; see docs/cluster.md.
MEMORY_OF_A_RUN: Final = 300
MEMORY_OF_A_WORKER: Final = 500
LOOPBACK: Final = "lo"
DEATH_TIMEOUT: Final = 300  # [s] a worker looks for a scheduler
LARGEST_FILE: Final = 1_000_000  # [bytes]
# Every local user could ask these processes over HTTP what they do, TLS or not: they answer nothing.
NO_PAGES: Final = {"distributed.scheduler.http.routes": []}
NO_PAGES_OF_WORKERS: Final = "export DASK_DISTRIBUTED__WORKER__HTTP__ROUTES='[]'"
WALLTIME: Final = re.compile(r"(\d+-)?\d+(:\d+){0,2}")
DIRECTIVE: Final = re.compile(r"-|[a-z][a-z-]+(=|$)")
NAME: Final = re.compile(r"[\w.,@%+-]+")
MOST_CORES: Final = 10_000
MOST_JOBS: Final = 10_000


@dataclass(frozen=True)
class SlurmOptions:
    """What every SLURM job asks for, and how many there are."""

    jobs: int = 1
    """SLURM jobs at most at a time; each is one worker."""

    cores: int = 16
    """Processors of each SLURM job, and runs at a time in it."""

    memory: str | None = None
    """Memory of each SLURM job, such as 8GB. By default 300 MB for each core and 500 MB."""

    walltime: str = "04:00:00"
    """Longest time of each SLURM job; what it leaves unfinished, the next one goes on with."""

    queue: str | None = None
    """Partition."""

    account: str | None = None
    """Whom the time is charged to."""

    interface: str = LOOPBACK
    """Network interface by which the nodes reach this machine, such as ib0. lo is for this machine alone."""

    directives: tuple[str, ...] = ()
    """More directives of sbatch, such as constraint=rome."""

    prologue: tuple[str, ...] = ()
    """Lines of the job script before the worker, such as 'module load python'."""

    tls: bool = True
    """Encrypt, and let nobody in but this command and its workers, by keys made for this one time. Without,
    whoever reaches the scheduler can run programs as you: with lo every user of this machine."""

    def __post_init__(self) -> None:
        for name, most in (("cores", MOST_CORES), ("jobs", MOST_JOBS)):
            value = getattr(self, name)
            if not isinstance(value, int) or isinstance(value, bool) or not 1 <= value <= most:
                raise ValueError(f"slurm {name} = {value!r} must be a whole number from 1 to {most}")
        for name in ("queue", "account", "interface", "walltime", "memory"):
            if (value := getattr(self, name)) is not None and not isinstance(value, str):
                raise ValueError(f"slurm {name} = {value!r} must be text")
        if not isinstance(self.tls, bool):
            raise ValueError(f"slurm tls = {self.tls!r} must be true or false")
        if not WALLTIME.fullmatch(self.walltime):
            raise ValueError(f"slurm walltime = {self.walltime!r} must be like 04:00:00, or 2-00:00:00")
        for name in ("queue", "account"):
            if (value := getattr(self, name)) is not None and not NAME.fullmatch(value):
                raise ValueError(f"slurm {name} = {value!r} must be one word, as sbatch takes it")
        for name in ("directives", "prologue"):
            self._check_lines(name)
        self._check_memory()

    def _check_lines(self, name: str) -> None:
        lines = getattr(self, name)
        if not isinstance(lines, tuple) or not all(isinstance(x, str) and x.isprintable() for x in lines):
            raise ValueError(f"slurm {name} = {lines!r} must be a list of single lines")
        for each in lines if name == "directives" else ():
            if not DIRECTIVE.match(each):
                raise ValueError(f"slurm directive {each!r} must be an option of sbatch, such as nice=100")

    def _check_memory(self) -> None:
        if self.memory is not None:
            try:
                parse_bytes(self.memory)
            except ValueError:
                raise ValueError(f"slurm memory = {self.memory!r} must be like 8GB or 500MB") from None

    @property
    def memory_of_a_job(self) -> str:
        """As asked for, or enough for as many runs as there are cores."""
        return self.memory or f"{MEMORY_OF_A_WORKER + self.cores * MEMORY_OF_A_RUN}MB"

    def with_values(self, values: Mapping[str, Any]) -> SlurmOptions:
        """The same with some options otherwise.

        Raises:
            ValueError: If a name is unknown or a value impossible.
        """
        known = [each.name for each in fields(self)]
        for name in values:
            if name not in known:
                raise ValueError(f"unknown slurm option {name!r}; there are {', '.join(known)}")
        return replace(self, **{k: tuple(v) if isinstance(v, list) else v for k, v in values.items()})


def read_options(path: Path) -> SlurmOptions:
    """The options in the table [slurm] of a TOML file.

    Raises:
        ValueError: With one sentence, if there is none or it cannot be understood.
    """
    if not path.is_file():
        raise ValueError(f"{path} is not a file; give a TOML file with a table [slurm]")
    if path.stat().st_size > LARGEST_FILE:
        raise ValueError(f"{path} is larger than {LARGEST_FILE:,} bytes; a table [slurm] is short")
    try:
        values = tomllib.loads(path.read_bytes().decode())
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{path} is not TOML: {error}") from None
    table = values.get("slurm")
    if not isinstance(table, dict):
        raise ValueError(f"{path} has no table [slurm]; its keys may be {', '.join(asdict(SlurmOptions()))}")
    try:
        return SlurmOptions().with_values(table)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def job_script(options: SlurmOptions) -> str:
    """The script of every SLURM job; the scheduler's address and keys are known only when it runs."""
    # The job alone, without a cluster: nothing is listened to, nothing written.
    address = "tls://ADDRESS" if options.tls else "tcp://ADDRESS"
    return SLURMJob(address, name="NAME", **_job_options(options)).job_script()


@contextmanager
def slurm_cluster(options: SlurmOptions, folder: Path) -> Iterator[Connection]:
    """While open, a scheduler in this process and as many SLURM jobs as there is work for.

    Args:
        options: What is asked of SLURM.
        folder: Of the experiment; the jobs' output and, while open, their keys are kept in its `logs/slurm`.

    Raises:
        ValueError: If SLURM is not here, or the interface does not exist.
        OSError: If nothing can be written, or listened to.
    """
    if shutil.which("sbatch") is None:
        raise ValueError("there is no sbatch on this machine; --slurm works where jobs are submitted")
    if options.interface not in (known := psutil.net_if_addrs()):
        raise ValueError(f"slurm interface {options.interface!r} is not here; there are {', '.join(known)}")
    logs = folder.resolve() / "logs" / "slurm"
    make_folder(logs)
    cluster: Any
    with (
        key_folder(logs) as keys,
        dask.config.set(NO_PAGES),
        SLURMCluster(
            **_job_options(options),
            log_directory=str(logs),
            security=own_keys(keys) if options.tls else None,
            # The scheduler's pages about itself: for this machine only, whatever the interface.
            scheduler_options={"dashboard": False, "dashboard_address": "127.0.0.1:0"},
        ) as cluster,
    ):
        cluster.adapt(minimum_jobs=0, maximum_jobs=options.jobs, interval="10s", wait_count=6)
        with Connection(
            lambda seconds: Client(cluster, timeout=seconds, set_as_default=False),
            f"{cluster.scheduler_address} (SLURM)",
            folder,
            "SLURM has been asked for some; look at squeue" + _loopback_note(options, logs),
        ) as connection:
            yield connection


def _loopback_note(options: SlurmOptions, logs: Path) -> str:
    note = f", and at {logs} for those that ended"
    if options.interface == LOOPBACK:
        note += "; by --slurm.interface lo only workers on this machine reach the scheduler"
    return note


def _job_options(options: SlurmOptions) -> dict[str, Any]:
    """What dask-jobqueue calls the options."""
    return {
        "cores": options.cores,
        # One worker process, with a thread for each job it watches over.
        "processes": 1,
        "memory": options.memory_of_a_job,
        "walltime": options.walltime,
        "queue": options.queue,
        "account": options.account,
        "interface": options.interface,
        "job_extra_directives": [x if x.startswith("-") else f"--{x}" for x in options.directives],
        "job_script_prologue": [NO_PAGES_OF_WORKERS, *options.prologue],
        "job_name": "wordarm",
        "python": sys.executable,
        "death_timeout": DEATH_TIMEOUT,
        "worker_extra_args": ["--no-dashboard", "--dashboard-address", "127.0.0.1:0"],
    }
