"""One malformed input of each kind: what must read it, and answer in one sentence or not mind."""

import io
import json
import random
from collections.abc import Callable
from pathlib import Path

import numpy as np

from evolution.answers import answer
from evolution.cli import main
from evolution.experiments.grid import read_experiment
from evolution.experiments.plan_file import plan_text, read_plan
from evolution.experiments.stage_times import stage_times
from evolution.runs.lock import locked
from evolution.runs.meta import read_meta
from evolution.runs.storage import read_arrays
from tests.fuzz import mutations
from tests.fuzz.mutations import HOSTILE_TEXTS, mangled, mistaken_arrays, npy, sealed, toml_text
from tests.fuzz.places import EXPERIMENT, FLAGS, Place

# Reads one input; its exit code.
Reader = Callable[[], int]

# A number of trials that is refused after everything has been read.
NONE = "--trials-per-area=0"
COMMANDS = (
    "evolve", "evaluate", "lineage", "behaviour", "verify", "status", "reproduce", "analyse",
    "report", "postevaluate", "experiment", "port", "doctor",
)  # fmt: skip
NAMES = (
    "seed", "condition", "population", "elites", "parents", "generations", "trials-per-area", "preset",
    "rank", "experiment", "generation", "trial-seed", "readings.object-radius", "readings.turn", "jobs",
    "runs", "readings.sector-centres", "readings.mutation-sd", "kills", "nothing", "help",
)  # fmt: skip


def config(rng: random.Random, place: Place) -> Reader:
    """config.toml."""
    run = place.copy("finished")
    _write_text(run / "config.toml", toml_text(rng, place.config))
    return _command("status", run)


def experiment(rng: random.Random, place: Place) -> Reader:
    """An experiment file; what is sound is planned, not run."""
    path = place.file("experiment.toml", b"")
    _write_text(path, toml_text(rng, EXPERIMENT))

    def read() -> int:
        folder = read_experiment(path).plan().folder
        assert not folder.is_absolute()
        assert ".." not in folder.parts
        return 0

    return lambda: answer(read)


def plan(rng: random.Random, place: Place) -> Reader:
    """plan.toml."""
    path = place.file("plan.toml", b"")
    _write_text(path, toml_text(rng, plan_text(place.plan)))

    def read() -> int:
        found = read_plan(path.parent)
        for each in found.configs if found else ():
            assert found.path(each).is_relative_to(path.parent)
        return 0

    return lambda: answer(read)


def part(rng: random.Random, place: Place) -> Reader:
    """A part: read with what comes before it, or gone on from."""
    run = place.copy("finished")
    _spoil(rng, place, run / "parts" / rng.choice(("gen-000000-000099.npz", "gen-000100-000103.npz")))
    if rng.random() < 0.3:
        return _command("evolve", *FLAGS, f"--output={run}")
    if rng.random() < 0.3:
        return _command("status", run)
    return _command("evaluate", run, f"--generation={rng.randrange(104)}", f"--rank={rng.randrange(6)}", NONE)


def checkpoint(rng: random.Random, place: Place) -> Reader:
    """The checkpoint of a run that was only begun."""
    run = place.copy("begun")
    _spoil(rng, place, run / "checkpoint.npz")
    return _command("evaluate", run, f"--generation={rng.randrange(51)}", f"--rank={rng.randrange(6)}", NONE)


def champions(rng: random.Random, place: Place) -> Reader:
    """champions.npz."""
    run = place.copy("finished")
    _spoil(rng, place, run / "champions.npz")
    return _command("evaluate", run, f"--rank={rng.randrange(-1, 6)}", NONE)


def tests(rng: random.Random, place: Place) -> Reader:
    """The results of one of the paper's tests."""
    run = place.copy("finished")
    files = sorted([*run.glob("postevaluation/*.npz"), *run.glob("transitions/*.npz")])
    _spoil(rng, place, rng.choice(files))
    return _command("postevaluate", run)


def genotypes(rng: random.Random, place: Place) -> Reader:
    """A genotype file of anyone's."""
    champions = place.home / "finished" / "champions.npz"
    data = rng.choice(
        (
            lambda: npy(rng, place.genotypes, place.trap),
            lambda: mutations.archive(rng, place.genotypes, place.trap),
            lambda: mangled(rng, champions.read_bytes()),
            lambda: mistaken_arrays(rng, read_arrays(champions), place.trap),
            lambda: _with_config(rng, place),
            mutations.bomb,
        )
    )()
    path = place.file(rng.choice(("mine.npz", "mine.npy", "mine.csv", "mine")), data)
    return _command("evaluate", path, f"--rank={rng.randrange(-1, 3)}", NONE)


def notes(rng: random.Random, place: Place) -> Reader:
    """What no result depends on: meta.json, times.csv, the number in a lock. It is passed over."""
    sound = (
        json.dumps({"starts": [{"started": "now"}] * 3}).encode() + b'\n"a, b",1\nevolving,x,0,1.5,2.5,100\n'
    )
    data = rng.choice((mangled(rng, sound), b"[" * 100_000, b'{"starts": [1]}', b'"' + b"x" * 200_000, sound))
    path = place.file("meta.json", data)
    for name in ("times.csv", "lock", "lease"):
        (path.parent / name).write_bytes(data)

    def read() -> int:
        assert all(isinstance(each, dict) for each in read_meta(path)["starts"])
        stage_times(path.parent)
        with locked(path.parent):
            return 0

    return lambda: answer(read)


def instruction(rng: random.Random, place: Place) -> Reader:
    """An instruction; the robot is refused where the instruction is not."""
    words = ["move", "touch", "indicate", "ignore", "blue", "green", "red", *HOSTILE_TEXTS]
    text = rng.choice((" ", "  ", "\t", "-", "")).join(rng.choices(words, k=rng.randrange(4)))
    return _command("port", place.home / "finished", text, "--robot=nobody")


def flags(rng: random.Random, place: Place) -> Reader:
    """A command line. Whatever is sound in it, it comes to nothing: its output would lie below a file."""
    file = place.file("a-file", b"")
    names, values = (*NAMES, *HOSTILE_TEXTS), ("1", "-1", "0", "with-ignore", "30 90 150", *HOSTILE_TEXTS)
    given = [f"--{rng.choice(names)}={rng.choice(values)}" for _ in range(rng.randrange(4))]
    positional = rng.choices((str(file), str(place.home / "none"), *HOSTILE_TEXTS), k=rng.randrange(3))
    command = rng.choice((*COMMANDS, *HOSTILE_TEXTS))
    return _command(command, *positional, *given, f"--output={file}/below")


def _command(*arguments: object) -> Reader:
    """The command line, with arguments as an operating system would pass them on."""
    return lambda: main([str(each).replace("\0", "") for each in arguments])


def _write_text(path: Path, text: str) -> None:
    path.write_bytes(text.encode("utf-8", "surrogatepass"))


def _spoil(rng: random.Random, place: Place, path: Path) -> None:
    """Damage a file of a run, with a checksum that fits in most cases."""
    kind = rng.randrange(4)
    if kind == 0:
        path.write_bytes(mangled(rng, path.read_bytes()))
    elif kind == 1:
        path.write_bytes(sealed(mangled(rng, path.read_bytes())))
    else:
        path.write_bytes(mistaken_arrays(rng, read_arrays(path), place.trap))


def _with_config(rng: random.Random, place: Place) -> bytes:
    """An archive of sound genotypes with a malformed config."""
    buffer = io.BytesIO()
    text = toml_text(rng, place.config).encode(errors="replace").decode()
    np.savez(buffer, genotypes=place.genotypes, config=np.array(text))
    return buffer.getvalue()


KINDS = {
    "config.toml": config,
    "experiment file": experiment,
    "plan.toml": plan,
    "part": part,
    "checkpoint": checkpoint,
    "champions": champions,
    "results of the tests": tests,
    "genotype file": genotypes,
    "meta.json, times.csv, lock": notes,
    "instruction": instruction,
    "flags": flags,
}
