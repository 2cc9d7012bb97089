"""Commands with `--device`: the files that they write without it, and one sentence where there is none."""

import pytest

from arm2d.device import opening
from evolution.cli import main
from tests.evolution.experiments.dask_processes import DaskProcesses
from tests.evolution.small_runs import contents

FILE = """
seeds = "1-3"
post_evaluate = true
[settings]
population = 10
elites = 2
parents = 5
generations = 12
"""


@pytest.fixture
def experiment(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "small.toml").write_text(FILE)
    return tmp_path


def files(folder):
    """All that determines the runs of an experiment, or follows from it; their tests included."""
    runs = sorted(folder.glob("with-*/seed-*"))
    tests = {str(each.relative_to(folder)): each.read_bytes() for each in folder.glob("with-*/*/*/*.npz")}
    return [contents(run) for run in runs], tests


def test_an_experiment_on_a_device_writes_the_files_it_writes_without(experiment, capsys):
    assert main(["experiment", "small.toml", "--output=plain", "--jobs=1"]) == 0
    assert main(["experiment", "small.toml", "--output=device", "--jobs=2", "--device=warp-cpu"]) == 0
    assert "3 of 3 runs are done" in capsys.readouterr().out
    plain, device = files(experiment / "plain"), files(experiment / "device")
    assert len(plain[0]) == 3
    assert any("transitions" in name for name in plain[1])
    assert plain == device
    log = next((experiment / "device" / "logs").glob("batch-001-of-002.log")).read_text()
    assert "runs together on warp-cpu (processor): 1" in log
    # Tests alone, of runs that were evolved on the processor.
    for name in ("postevaluation", "transitions"):
        for path in (experiment / "plain").glob(f"with-*/*/{name}/*.npz"):
            path.unlink()
    assert main(["postevaluate", "plain", "--device=warp-cpu"]) == 0
    assert files(experiment / "plain") == device


@pytest.mark.parametrize(
    "command",
    [
        ["experiment", "small.toml", "--output=new"],
        ["reproduce", "--output=new"],
        ["study", "readings", "--output=new"],
        ["study", "readings", "--part=factorial", "--output=new"],
        ["postevaluate", "new"],
    ],
    ids=lambda command: " ".join(command[:3]),
)
@pytest.mark.parametrize(
    ("device", "sentence"),
    [
        ("gpu", "unknown device 'gpu'; give cpu, cuda, or one of several such as cuda:1"),
        ("cuda", "no CUDA device is found on this machine, so cuda is not there"),
    ],
)
def test_a_device_that_is_not_there_gets_one_sentence_and_nothing_is_written(
    experiment, monkeypatch, capsys, command, device, sentence
):
    monkeypatch.setattr(opening, "_has_driver", lambda: False)
    assert main([*command, f"--device={device}"]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"wordarm: {sentence}")
    assert error.count("\n") == 1
    assert [each.name for each in experiment.iterdir()] == ["small.toml"]


@pytest.mark.slow
def test_workers_of_a_cluster_use_the_devices_they_have(experiment):
    dask = DaskProcesses(experiment)
    try:
        dask.start_scheduler()
        dask.start_worker()
        arguments = ["small.toml", "--seeds=1", "--device=warp-cpu"]
        assert main(["experiment", *arguments, f"--scheduler={dask.address}", "--output=there"]) == 0
    finally:
        dask.close()
    assert main(["experiment", "small.toml", "--seeds=1", "--output=plain", "--jobs=1"]) == 0
    assert files(experiment / "there") == files(experiment / "plain")


def test_a_task_that_devices_do_not_know_is_refused_before_anything_is_written(experiment, capsys):
    task = FILE.replace("post_evaluate = true", 'conditions = ["with-both"]\npost_evaluate = false')
    (experiment / "both.toml").write_text(task)
    assert main(["experiment", "both.toml", "--output=new", "--device=warp-cpu"]) == 2
    said = capsys.readouterr().err
    assert "not with-both; leave --device away" in said
    assert not (experiment / "new").exists()
