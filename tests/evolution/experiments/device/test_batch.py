"""Runs of one batch against single runs, file by file; and a device that fails in mid-run."""

from dataclasses import replace

import pytest
import warp as wp

from arm2d import Condition
from arm2d.device.errors import DeviceLostError, DeviceMemoryError
from arm2d.readings import PLAIN
from evolution.experiments.device.batch import evolve_together
from evolution.experiments.device.scoring import DeviceScoring
from evolution.experiments.device.stages import evolve_batch
from evolution.runs.checkpoint import load_checkpoint
from evolution.runs.folder import RunFolder
from evolution.runs.run import Watcher, evolve
from tests.evolution.small_runs import SMALL, contents

# Two conditions, four seeds, four worlds, three lengths; in one, every genotype meets trials of its own.
BASE = replace(SMALL, readings=PLAIN)
CONFIGS = {
    "a": BASE,
    "b": replace(BASE, seed=1, condition=Condition.WITH_IGNORE),
    "c": replace(BASE, seed=2, readings=replace(PLAIN, camera_origin="end", crossover=0.3)),
    "d": replace(BASE, seed=3, readings=replace(PLAIN, starts_shared="genotype")),
    "e": replace(BASE, readings=replace(PLAIN, turn="radians", ties="children")),
}
CONFIGS = {
    name: replace(config, settings=replace(config.settings, generations=length))
    for (name, config), length in zip(CONFIGS.items(), (120, 105, 120, 101, 120), strict=True)
}


@pytest.fixture(scope="module")
def single(tmp_path_factory):
    """The files of the same runs, each evolved alone, on the processor."""
    folder = tmp_path_factory.mktemp("single")
    for name, config in CONFIGS.items():
        evolve(folder / name, config)
    return {name: contents(folder / name) for name in CONFIGS}


def stop_after(n):
    """A watcher that stops all runs when so many generations are scored, whosever they are."""
    told = []
    return Watcher(on_generation=told.append, wants_stop=lambda: len(told) >= n)


def test_runs_of_a_batch_are_single_runs_file_by_file_after_interruption_and_resumption(
    single, laboratory, tmp_path
):
    runs = {tmp_path / name: config for name, config in CONFIGS.items()}
    score = DeviceScoring(laboratory).fitness
    evolve(tmp_path / "b", CONFIGS["b"], stop_after(17))  # one was begun alone before
    stopped = evolve_together(runs, score, stop_after(300))
    assert stopped.generations[tmp_path / "a"] < 101 < stopped.generations[tmp_path / "b"] + 30
    done = evolve_together(runs, score)
    assert done.generations == {path: config.settings.generations for path, config in runs.items()}
    assert done.troubles == {}
    assert {name: contents(tmp_path / name) for name in CONFIGS} == single


def test_a_run_that_cannot_go_on_does_not_hold_up_the_others(single, laboratory, tmp_path):
    names = ("a", "e")
    runs = {tmp_path / name: CONFIGS[name] for name in names}
    evolve(tmp_path / "a", CONFIGS["a"], stop_after(110))
    part = next((tmp_path / "a" / "parts").iterdir())
    part.write_bytes(part.read_bytes()[:-1] + b"x")
    result = evolve_together(runs, DeviceScoring(laboratory).fitness)
    assert set(result.generations) == {tmp_path / "e"}
    assert "is damaged" in result.troubles[tmp_path / "a"]
    assert contents(tmp_path / "e") == single["e"]


@pytest.mark.parametrize(
    ("said", "kind"),
    [
        ("Error launching kernel: unspecified launch failure", DeviceLostError),
        ("Failed to allocate 8 bytes on device 'cuda:0'", DeviceMemoryError),
    ],
)
def test_a_device_that_fails_in_mid_run_costs_not_a_generation(
    single, laboratory, tmp_path, monkeypatch, said, kind
):
    launch, launches = wp.launch, []

    def fail_later(kernel, **options):
        launches.append(kernel)
        if len(launches) > 40:
            raise RuntimeError(said)
        launch(kernel, **options)

    names = ("a", "e")
    runs = {tmp_path / name: CONFIGS[name] for name in names}
    scoring = DeviceScoring(laboratory)
    watcher = Watcher(wants_stop=lambda: scoring.failure is not None)
    with monkeypatch.context() as patch:
        patch.setattr(wp, "launch", fail_later)
        result = evolve_together(runs, scoring.fitness, watcher)
    assert isinstance(scoring.failure, kind)
    # Four launches for each generation; the one that was asked for when the device failed is there, too.
    assert result.generations == dict.fromkeys(runs, 11)
    for path, config in runs.items():
        checkpoint = load_checkpoint(RunFolder(path, config))
        assert checkpoint is not None
        assert checkpoint.population.generation == 11
    evolve_together(runs, DeviceScoring(laboratory).fitness)
    assert {name: contents(tmp_path / name) for name in names} == {name: single[name] for name in names}


def test_a_process_that_lost_its_device_asks_to_be_started_again(tmp_path, monkeypatch, capfd):
    def fail(kernel, **options):
        raise RuntimeError("Error launching kernel: unspecified launch failure")

    monkeypatch.setattr(wp, "launch", fail)
    runs = [(str(tmp_path / "a"), CONFIGS["a"].to_mapping())]
    assert evolve_batch("warp-cpu", runs) == 3
    error = capfd.readouterr().err.splitlines()[-1]
    assert error.startswith("warp-cpu was lost (Error launching kernel: unspecified launch failure); nothing")
