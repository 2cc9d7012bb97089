"""A scheduler of our own: nobody else gets in, nothing is told to others, and no keys stay behind."""

import os
import signal
import stat
import subprocess
import sys
from urllib.error import HTTPError
from urllib.request import urlopen

import pytest

from evolution.experiments.cluster.keys import clear_keys, folder_for_keys
from evolution.experiments.cluster.options import SlurmOptions
from evolution.experiments.cluster.slurm import slurm_cluster

HOLDER = """
import sys, time
from pathlib import Path
from evolution.experiments.cluster.keys import folder_for_keys
with folder_for_keys(Path(sys.argv[1])) as folder:
    (folder / "key.pem").write_text("secret")
    print(folder, flush=True)
    time.sleep(1000)
"""
PAGES = ("health", "json/counts.json", "info/main/workers.html", "metrics", "status", "")


@pytest.fixture
def holder(tmp_path):
    """A command that holds keys, and their folder."""
    process = subprocess.Popen(
        [sys.executable, "-c", HOLDER, str(tmp_path)], stdout=subprocess.PIPE, text=True
    )
    folder = type(tmp_path)(process.stdout.readline().strip())
    yield process, folder
    process.kill()
    process.wait()


def test_keys_lie_where_only_we_can_go_and_are_gone_afterwards(tmp_path):
    before = os.umask(0)
    try:
        with folder_for_keys(tmp_path) as folder:
            assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    finally:
        os.umask(before)
    assert list(tmp_path.iterdir()) == []


def test_keys_of_a_command_that_was_killed_are_cleared_and_those_of_a_living_one_are_not(holder, tmp_path):
    process, folder = holder
    with folder_for_keys(tmp_path) as own:
        assert (folder / "key.pem").exists()
        process.send_signal(signal.SIGKILL)
        process.wait()
        clear_keys(tmp_path)
        assert list(tmp_path.iterdir()) == [own]


def test_what_was_not_made_here_is_left_alone(tmp_path):
    for name in ("home", "keys-of-the-house"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "lock").mkdir()
        (tmp_path / name / "thesis").touch()
    (tmp_path / "keys-of-the-house" / "lock").rmdir()
    (tmp_path / "keys-planted").symlink_to("home")
    (tmp_path / "keys-pipe").mkdir()
    os.mkfifo(tmp_path / "keys-pipe" / "lock")
    before = sorted(tmp_path.rglob("*"))
    clear_keys(tmp_path)
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.slow
def test_a_scheduler_for_slurm_keeps_to_this_machine_with_tls_and_answers_no_questions(tmp_path, monkeypatch):
    sbatch = tmp_path / "bin" / "sbatch"
    sbatch.parent.mkdir()
    sbatch.write_text("#!/bin/sh\n")
    sbatch.chmod(0o755)
    monkeypatch.setenv("PATH", f"{sbatch.parent}:{os.environ['PATH']}")
    with slurm_cluster(SlurmOptions().complete(), tmp_path / "experiment") as connection:
        assert connection.where.startswith("tls://127.0.0.1:")
        server = connection._client.cluster.scheduler.http_server
        assert server.address == "127.0.0.1"
        for page in PAGES:
            with pytest.raises(HTTPError, match="404"):
                urlopen(f"http://127.0.0.1:{server.port}/{page}")
        (keys,) = (tmp_path / "experiment" / "logs" / "slurm").glob("keys-*")
        files = [*keys.glob("*.pem")]
        assert len(files) == 3
        assert {stat.S_IMODE(each.stat().st_mode) for each in files} == {0o600}
        script = connection._client.cluster.job_script()
        assert f"--tls-key {keys}/tls_worker_key.pem" in script
        assert "ROUTES='[]'" in script
    assert not keys.exists()
