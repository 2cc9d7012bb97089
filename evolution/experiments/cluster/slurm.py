"""Workers from SLURM: what is asked of it, and the cluster that dask-jobqueue makes of the answer."""

from __future__ import annotations

import re
import shlex
import shutil
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

import dask.config
import psutil
from distributed import Client
from distributed.security import Security

from evolution.child import python
from evolution.experiments.cluster.connection import Connection
from evolution.experiments.cluster.keys import folder_for_keys, own_keys
from evolution.experiments.cluster.options import LOOPBACK, SlurmOptions
from evolution.runs.storage import make_folder

# The package takes Ctrl-C for itself when it is imported, and would end us with exit code 0.
_CTRL_C = signal.getsignal(signal.SIGINT)
from dask_jobqueue.slurm import SLURMCluster, SLURMJob  # noqa: E402

signal.signal(signal.SIGINT, _CTRL_C)

DEATH_TIMEOUT: Final = 300  # [s] a worker looks for a scheduler
# Every local user could ask these processes over HTTP what they do, TLS or not: they answer nothing.
NO_PAGES: Final = {"distributed.scheduler.http.routes": []}
NO_PAGES_OF_WORKERS: Final = "export DASK_DISTRIBUTED__WORKER__HTTP__ROUTES='[]'"
# What sbatch would take for something else in a name of a file, even in quotes.
NOT_IN_A_NAME: Final = re.compile(r"""["'\\]""")


class QuotedJob(SLURMJob):
    """A job whose script names the files of its keys as words that no shell takes apart."""

    def __init__(self, *arguments: Any, security: Security | None = None, **options: Any) -> None:
        super().__init__(*arguments, security=security and _QuotedFiles(security), **options)


class _QuotedFiles:
    """The keys of a worker, by the names of their files in quotes."""

    def __init__(self, security: Security) -> None:
        self._security = security

    def get_tls_config_for_role(self, role: str) -> dict[str, str | None]:
        named = self._security.get_tls_config_for_role(role)
        return {key: shlex.quote(value) if value else value for key, value in named.items()}


def job_script(options: SlurmOptions, folder: Path) -> str:
    """The script of every SLURM job; the scheduler's address and keys are known only when it runs.

    Args:
        options: What is asked of SLURM, complete.
        folder: Of the experiment.

    Raises:
        ValueError: If the folder's name cannot stand in the script.
    """
    # The job alone, without a cluster: nothing is listened to, nothing written.
    address = "tls://ADDRESS" if options.tls else "tcp://ADDRESS"
    return QuotedJob(address, name="NAME", **_job_options(options, _logs(folder))).job_script()


@contextmanager
def slurm_cluster(options: SlurmOptions, folder: Path) -> Iterator[Connection]:
    """While open, a scheduler in this process and as many SLURM jobs as there is work for.

    Args:
        options: What is asked of SLURM, complete.
        folder: Of the experiment; the jobs' output and, while open, their keys are kept in its `logs/slurm`.

    Raises:
        ValueError: If SLURM is not here, the interface does not exist, or the folder's name cannot stand in
            the script.
        OSError: If nothing can be written, or listened to.
    """
    if shutil.which("sbatch") is None:
        raise ValueError("there is no sbatch on this machine; --slurm works where jobs are submitted")
    if options.interface not in (known := psutil.net_if_addrs()):
        raise ValueError(f"slurm interface {options.interface!r} is not here; there are {', '.join(known)}")
    logs = _logs(folder)
    job_options = _job_options(options, logs)
    make_folder(logs)
    cluster: Any
    with (
        folder_for_keys(logs) as keys,
        dask.config.set(NO_PAGES),
        SLURMCluster(
            **job_options,
            job_cls=QuotedJob,  # pyright: ignore - a class is meant
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


def _logs(folder: Path) -> Path:
    """Where the jobs' output goes, and while they run their keys."""
    return folder.resolve() / "logs" / "slurm"


def _job_options(options: SlurmOptions, logs: Path) -> dict[str, Any]:
    """What dask-jobqueue calls the options."""
    directives = [x if x.startswith("-") else f"--{x}" for x in options.directives or ()]
    return {
        "cores": options.cores,
        # One worker process, with a thread for each job it watches over.
        "processes": 1,
        "memory": options.memory,
        "walltime": options.walltime,
        "queue": options.queue,
        "account": options.account,
        "interface": options.interface,
        "job_extra_directives": [
            f"--error={_word_for_sbatch(logs / 'wordarm-%J.err')}",
            f"--output={_word_for_sbatch(logs / 'wordarm-%J.out')}",
            *directives,
        ],
        "job_script_prologue": [NO_PAGES_OF_WORKERS, *(options.prologue or ())],
        "job_name": "wordarm",
        # Followed by -m and the module of a Dask worker.
        "python": shlex.join(python()),
        "death_timeout": DEATH_TIMEOUT,
        "worker_extra_args": ["--no-dashboard", "--dashboard-address", "127.0.0.1:0"],
    }


def _word_for_sbatch(file: Path) -> str:
    """The name of a file as one word of a directive; in its folders a percent sign means itself."""
    name = str(file)
    if not name.isprintable() or NOT_IN_A_NAME.search(name):
        raise ValueError(
            f"{str(file.parent)!r} cannot be named in a job script; choose an --output without quotes, "
            "backslashes and characters that cannot be printed"
        )
    return shlex.quote(f"{str(file.parent).replace('%', '%%')}/{file.name}")
