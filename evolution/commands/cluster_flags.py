"""The flags by which runs go to other machines, shared by the commands that have runs to do."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field, replace
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from tyro.conf import arg

from evolution.experiments.cluster.options import SlurmOptions

if TYPE_CHECKING:
    from rich.console import Console

    from evolution.experiments.cluster.connection import Connection
    from evolution.experiments.cluster.running import RemoteStart
    from evolution.experiments.plan import Plan


@dataclass(frozen=True)
class ClusterFlags:
    """Where runs are done: here, if neither --scheduler nor --slurm is given."""

    scheduler: str | None = None
    """Address of a Dask scheduler, such as tls://10.0.0.1:8786; its workers do the runs. Whoever reaches one
    at tcp:// can run programs as you."""

    slurm: bool = False
    """Let SLURM start workers, and do the runs there."""

    slurm_file: Annotated[Path | None, arg(name="slurm.file")] = None
    """TOML file whose table [slurm] has any of the following; flags go before it."""

    slurm_options: Annotated[SlurmOptions, arg(name="slurm")] = field(default_factory=SlurmOptions)

    @property
    def given(self) -> bool:
        """Whether runs are done elsewhere."""
        return self.slurm or self.scheduler is not None

    def check(self) -> None:
        """Refuse flags that do not go together.

        Raises:
            ValueError: If they do not, or packages for a cluster are missing.
        """
        if self.slurm and self.scheduler is not None:
            raise ValueError("--scheduler and --slurm are two ways to get workers; give one of them")
        if not self.slurm and (self.slurm_file or self.slurm_options != SlurmOptions()):
            raise ValueError("--slurm.* need --slurm; give it too, or leave them out")
        if self.given:
            _require_dask()

    def placed(self, plan: Plan) -> Plan:
        """The same runs, in a folder whose name means the same on other machines."""
        return replace(plan, folder=plan.folder.resolve()) if self.given else plan

    def show_script(self, folder: Path) -> int:
        """What `--dry-run` does for an experiment in a folder; the exit code.

        Raises:
            ValueError: If no SLURM is asked for.
        """
        if not self.slurm:
            raise ValueError("--dry-run shows what SLURM would be given; it needs --slurm")
        from evolution.experiments.cluster.slurm import job_script

        print(job_script(self.slurm_options.complete(self.slurm_file), folder), end="")
        return 0

    @contextmanager
    def opened(self, folder: Path, console: Console) -> Iterator[RemoteStart | None]:
        """While open, the way to start jobs on the cluster asked for; None if runs are done here.

        Args:
            folder: Of the experiment.
            console: Gets a line when scheduler or workers come and go.

        Raises:
            ValueError, OSError: With one sentence, if there is no such cluster, or it cannot take part.
        """
        if not self.given:
            yield None
            return
        from evolution.experiments.cluster.running import RemoteStart

        with self._connection(folder) as connection:
            connection.on_note = lambda note: console.print(note, highlight=False, soft_wrap=True)
            yield RemoteStart(connection)

    def _connection(self, folder: Path) -> AbstractContextManager[Connection]:
        if self.scheduler is not None:
            from evolution.experiments.cluster.address import connected

            return connected(self.scheduler, folder)
        from evolution.experiments.cluster.slurm import slurm_cluster

        return slurm_cluster(self.slurm_options.complete(self.slurm_file), folder)


def _require_dask() -> None:
    """Refuse without the packages of the extra, before anything is begun."""
    for name in ("distributed", "dask_jobqueue"):
        if find_spec(name) is None:
            raise ValueError(
                f"a cluster needs the package {name}; install it with: pip install 'wordarm[cluster]'"
            )
