"""`wordarm evolve`: one run, or the rest of it."""

from __future__ import annotations

import sys
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Annotated, Self

from tyro.conf import arg

from arm2d import Readings
from arm2d.constants import N_INTER
from arm2d.network.genes import counted
from arm2d.tasks.task import AnyTask, read_task
from evolution.answers import INTERRUPTED
from evolution.search.config import RunConfig
from evolution.search.settings import Settings


@dataclass(frozen=True)
class UncheckedReadings(Readings):
    """How what the paper leaves open is understood (docs/ledger.md)."""

    # The option parser would wrap the message of an impossible value; `checked` raises it plainly.
    def __post_init__(self) -> None:
        pass

    def checked(self) -> Readings:
        """The same readings, refused if impossible."""
        return Readings.from_mapping(asdict(self))


@dataclass(frozen=True)
class TaskOptions:
    """What is asked and how it is said, where it is not as in the paper (docs/how-to/task.md)."""

    held_out: tuple[str, ...] | None = None
    """Instructions never met in evolution. By default "move blue" and "touch green", as in the paper."""

    codes: tuple[str, ...] = ()
    """How words are heard if not as in the paper: a word and three bits, such as "ignore 111"."""

    words: str = "together"
    """together throughout the trial, or one after the other, then silence: object-first, action-first."""

    word_steps: int = 10
    """Steps of 0.1 s that each word takes if they come one after the other."""

    places: str = "own"
    """own: every colour has a sector of its own; dealt: they are dealt anew to the sectors in each trial."""

    def with_condition(self, condition: str) -> AnyTask:
        """The task that is asked for; raises `ValueError` if it makes no sense."""
        given = {name: value for name, value in vars(self).items() if value != getattr(TaskOptions, name)}
        return read_task(condition, given)


@dataclass(frozen=True, kw_only=True)
class FromPreset:
    """Options of commands that evolve in a world of the user's choice."""

    preset: str = "default"
    """Readings to start from: default (nearest to the paper), plain (its numbers) or printed (the paper at
    its word); single ones can be set below."""

    readings: UncheckedReadings = field(default_factory=UncheckedReadings)

    def preset_default(self) -> Self | None:
        """The command without options, but in the world of the preset; None if that is the usual one."""
        if self.preset == "default":
            return None
        return type(self)(readings=UncheckedReadings(**vars(Readings.preset(self.preset))))


@dataclass(frozen=True, kw_only=True)
class Evolve(FromPreset):
    """Evolve controllers from random genotypes; repeat the command to go on with a stopped run.

    Ctrl-C stops after the generation at hand, and nothing is lost.
    """

    condition: str = "with-indicate"
    """Which third action is met beside MOVE and TOUCH: with-indicate, with-ignore or with-both."""

    task: TaskOptions = TaskOptions()

    seed: int = 1
    """All random numbers of the run follow from it."""

    settings: Annotated[Settings, arg(name="")] = Settings()  # noqa: RUF009 - frozen

    experiment: str = "default"
    """Folder of runs that belong together, under runs/."""

    output: Path | None = None
    """Run folder. By default runs/<experiment>/<condition>/seed-<seed>."""

    @property
    def config(self) -> RunConfig:
        """The run that is asked for."""
        task = self.task.with_condition(self.condition)
        return RunConfig(task, self.seed, self.settings, self.readings.checked())

    def run(self) -> int:
        """Evolve; the exit code is 130 if the run was stopped before its end."""
        from rich.console import Console

        from evolution.commands.progress import shown_progress
        from evolution.runs.interrupt import StopRequest
        from evolution.runs.run import Watcher, evolve

        config = self.config
        path = self.output or default_folder(self.experiment, config)
        console = Console()
        total = config.settings.generations
        with StopRequest() as stop, shown_progress(console, total) as show:
            watcher = Watcher(
                on_start=lambda generation: _announce(path, config, generation),
                on_generation=show,
                on_note=lambda note: print(note, file=sys.stderr),
                wants_stop=lambda: stop.requested,
            )
            done = evolve(path, config, watcher)
        if done < total:
            print(f"stopped after {done} of {total} generations; go on with the same command")
            return INTERRUPTED
        print(f"finished: {path}\nlook at it with: wordarm evaluate {path}")
        return 0


def _announce(path: Path, config: RunConfig, generation: int) -> None:
    """Say where the run starts, and what the user is waiting for if that will take a while."""
    from arm2d.cache import cache_folder

    print(f"{path}: from generation {generation} on")
    compiled = cache_folder()
    if compiled is None or not any(Path(compiled).iterdir()):
        print("the arm is being compiled first, once on this machine; that takes some seconds", flush=True)
    elif generation == 0 and config.settings.inter_neurons != N_INTER:
        size = counted(config.settings.inter_neurons)
        print(f"networks of {size} are compiled when this machine first meets them; that takes some seconds")


def default_folder(experiment: str, config: RunConfig) -> Path:
    """Where a run is kept unless told otherwise.

    Raises:
        ValueError: If the experiment's name leads out of runs/.
    """
    if Path(experiment).is_absolute() or ".." in Path(experiment).parts:
        raise ValueError(
            f"experiment {experiment!r} would lie outside runs/; give a name, or any folder with --output"
        )
    return Path("runs") / experiment / str(config.condition) / f"seed-{config.seed:04d}"
