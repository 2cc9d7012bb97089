"""A run in a folder where others may write: it writes nowhere else, and waits for no pipe."""

import json
import os
import subprocess
import sys

import pytest

from evolution.cli import main
from evolution.experiments.stage_times import FILE, note_time, stage_times
from evolution.experiments.workers import Ended, Job, Worker
from evolution.runs import meta
from evolution.runs.folder import OWN_FILES, RunFolder
from evolution.runs.lease import held_elsewhere
from evolution.runs.storage import DamagedFileError
from tests.evolution.small_runs import SMALL_FLAGS

# Ends a command that waits for a pipe.
LONGEST = 120  # [s]


@pytest.fixture
def thesis(tmp_path):
    path = tmp_path / "thesis.txt"
    path.write_text("three years of work")
    return path


@pytest.mark.parametrize("name", sorted(OWN_FILES))
def test_a_run_with_a_link_in_the_place_of_something_of_its_own_is_refused(name, tmp_path, thesis, capsys):
    run = tmp_path / "run"
    run.mkdir()
    (run / name).symlink_to(thesis)
    assert main(["evolve", *SMALL_FLAGS, f"--output={run}"]) == 2
    assert f"{run / name} is a symbolic link, but a run's files lie in its folder" in capsys.readouterr().err
    assert thesis.read_text() == "three years of work"
    assert list(run.iterdir()) == [run / name]


@pytest.mark.parametrize("name", ["lock", "lease", "parts", "checkpoint.npz", "postevaluation"])
@pytest.mark.parametrize("command", ["verify --repair", "postevaluate", "evaluate", "status"])
def test_so_is_every_other_command_on_such_a_run(command, name, run_copy, tmp_path, capsys):
    home = tmp_path / "home"
    if (run_copy / name).exists():
        (run_copy / name).rename(home)
    else:
        home.mkdir()
    before = sorted(tmp_path.rglob("*"))
    (run_copy / name).symlink_to(home)
    assert main([*command.split(), str(run_copy)]) == 2
    assert f"{run_copy / name} is a symbolic link" in capsys.readouterr().err
    (run_copy / name).unlink()
    assert sorted(tmp_path.rglob("*")) == before


def test_a_folder_of_runs_that_somebody_else_linked_is_not_written(tmp_path, other_user, capsys):
    (tmp_path / "home").mkdir()
    (tmp_path / "with-indicate").symlink_to(tmp_path / "home")
    os.lchown(tmp_path / "with-indicate", other_user, other_user)
    assert main(["evolve", *SMALL_FLAGS, f"--output={tmp_path / 'with-indicate' / 'seed-0011'}"]) == 2
    assert "is a symbolic link that belongs to another user" in capsys.readouterr().err
    assert list((tmp_path / "home").iterdir()) == []


def test_what_workers_say_and_what_they_took_is_added_to_no_link(tmp_path, thesis):
    (tmp_path / "run.log").symlink_to(thesis)
    (tmp_path / FILE).symlink_to(thesis)
    job = Job("a run", "evolving", "builtins:print", {}, tmp_path, tmp_path / "run.log")
    with pytest.raises(OSError, match=r"run\.log is a symbolic link"):
        Worker(job)
    with pytest.raises(OSError, match=rf"{FILE} is a symbolic link"):
        note_time(tmp_path, Ended(job, 0, 1.0, 1.0, 1.0))
    assert stage_times(tmp_path) == []
    assert thesis.read_text() == "three years of work"


@pytest.mark.parametrize("name", ["checkpoint.npz", "config.toml", "meta.json", "lock", "lease"])
def test_a_pipe_in_the_place_of_a_file_holds_nobody_up(name, run_copy):
    (run_copy / name).unlink(missing_ok=True)
    os.mkfifo(run_copy / name)
    for command in (["status", run_copy], ["evolve", *SMALL_FLAGS, f"--output={run_copy}"]):
        done = subprocess.run(
            [sys.executable, "-m", "evolution", *map(str, command)],
            capture_output=True,
            text=True,
            timeout=LONGEST,
        )
        assert done.returncode in (0, 2)
        assert "Traceback" not in done.stderr


def test_a_device_is_no_file_of_a_run(run_copy):
    """It would give zeros for ever."""
    part = run_copy / "parts" / "gen-000000-000099.npz"
    part.unlink()
    part.symlink_to("/dev/zero")
    with pytest.raises(DamagedFileError, match="no regular file"):
        RunFolder.open(run_copy).read_part(range(100))


def test_a_lease_that_is_none_is_held_by_nobody(tmp_path):
    os.mkfifo(tmp_path / "lease")
    assert not held_elsewhere(tmp_path)


@pytest.mark.parametrize(
    "start", [{"versions": 5}, {"versions": None}, {"machine": ["x"]}, {"revision": {"a": 1}}, 5, "x" * 10**6]
)
def test_a_note_of_a_start_that_is_none_is_passed_over(start, tmp_path):
    (tmp_path / "meta.json").write_text(json.dumps({"starts": [start]}))
    assert meta.read_meta(tmp_path / "meta.json") == {"starts": []}
    meta.note_start(tmp_path / "meta.json", 0)
    assert len(meta.read_meta(tmp_path / "meta.json")["starts"]) == 1


def repository(path, script):
    """One that would run a script in every way that looking at it offers, and how it is told from others."""

    def git(*arguments):
        subprocess.run(["git", "-C", path, *arguments], check=True, capture_output=True)

    (path / "runs").mkdir(parents=True)
    (path / "runs" / "run.py").write_text("run = 1\n")
    (path / ".gitattributes").write_text("*.py filter=planted\n")
    git("init", "-q")
    git("add", ".")
    git("-c", "user.name=a", "-c", "user.email=a@b.c", "commit", "-qm", "one")
    (path / ".git" / "hooks").mkdir(exist_ok=True)
    for hook in ("post-index-change", "fsmonitor-watchman"):
        (path / ".git" / "hooks" / hook).write_bytes(script.read_bytes())
        (path / ".git" / "hooks" / hook).chmod(0o755)
    for name in ("core.fsmonitor", "filter.planted.clean", "filter.planted.process", "core.pager"):
        git("config", name, str(script))
    git("config", "filter.planted.required", "true")
    os.utime(path / "runs" / "run.py", (1, 1))  # so that git looks at it again
    return subprocess.run(
        ["git", "-C", path, "rev-parse", "--short=12", "HEAD"], capture_output=True, text=True
    ).stdout.strip()


@pytest.fixture
def planted(tmp_path):
    script = tmp_path / "planted.sh"
    script.write_text(f"#!/bin/sh\ntouch {tmp_path / 'executed'}\ncat\n")
    script.chmod(0o755)
    return script


@pytest.mark.usefixtures("git")
def test_asking_git_for_the_revision_runs_nothing_of_the_repository(tmp_path, planted, monkeypatch):
    revision = repository(tmp_path / "theirs", planted)
    monkeypatch.setattr(meta, "__file__", str(tmp_path / "theirs" / "runs" / "meta.py"))
    assert meta.revision() == revision
    assert not (tmp_path / "executed").exists()
    (tmp_path / "theirs" / "runs" / "run.py").write_text("run = 2\n")
    assert meta.revision() == f"{revision}-dirty"
    assert not (tmp_path / "executed").exists()


@pytest.mark.usefixtures("git")
def test_no_variable_leads_git_to_another_repository(tmp_path, planted, monkeypatch):
    here = meta.revision()
    repository(tmp_path / "theirs", planted)
    monkeypatch.setenv("GIT_DIR", str(tmp_path / "theirs" / ".git"))
    monkeypatch.setenv("GIT_WORK_TREE", str(tmp_path / "theirs"))
    assert meta.revision() == here


def test_a_repository_of_another_user_is_not_asked(tmp_path, planted, monkeypatch, other_user):
    repository(tmp_path / "theirs", planted)
    for each in [tmp_path / "theirs", *(tmp_path / "theirs").rglob("*")]:
        os.lchown(each, other_user, other_user)
    monkeypatch.setattr(meta, "__file__", str(tmp_path / "theirs" / "runs" / "meta.py"))
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", os.devnull)
    assert meta.revision() == "unknown"
    assert not (tmp_path / "executed").exists()
