"""How runs are shared out among processes and devices."""

import json
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest

from evolution.child import reference
from evolution.experiments.device import stages
from evolution.experiments.device.jobs import MOST_RUNS, DeviceShares, device_shares
from evolution.experiments.fork_server import LARGEST_MESSAGE
from evolution.experiments.plan import TESTING, Plan
from tests.evolution.small_runs import SMALL


def plan_of(n, folder):
    return Plan(folder, tuple(replace(SMALL, seed=seed) for seed in range(n)))


def batches(n, shares, folder):
    plan = plan_of(n, folder)
    jobs = [chain[0] for chain in shares.batches(plan.chains(), folder)]
    assert [name for job in jobs for name in job.runs] == [plan.run_name(each) for each in plan.configs]
    return jobs


def test_every_run_is_in_one_batch_and_the_batches_take_the_devices_in_turn(tmp_path):
    jobs = batches(11, DeviceShares(("cuda:0", "cuda:1"), 3), tmp_path)
    assert [len(job.runs) for job in jobs] == [3, 4, 4]
    assert [job.arguments["device"] for job in jobs] == ["cuda:0", "cuda:1", "cuda:0"]
    assert jobs[0].name == "with-indicate, seed 0 and 2 more"


def test_there_are_no_more_batches_than_runs(tmp_path):
    assert [len(job.runs) for job in batches(2, DeviceShares(("cuda",), 8), tmp_path)] == [1, 1]


def test_a_thousand_runs_fit_into_the_messages_of_a_few_processes(tmp_path):
    jobs = batches(1000, DeviceShares(("cuda",), 2), tmp_path)
    assert max(len(job.runs) for job in jobs) <= MOST_RUNS
    for job in jobs:
        assert len(json.dumps({"function": job.function, "arguments": job.arguments})) < LARGEST_MESSAGE


def test_a_batch_of_long_paths_can_be_handed_to_a_process_as_one_word():
    """Linux takes words of 128 KiB; a run's own is a kilobyte and its folder's path."""
    deep = Path("/" + "/".join(["a" * 200] * 15))
    jobs = batches(300, DeviceShares(("cuda",), 2), deep)
    assert len(jobs) > 300 / MOST_RUNS
    for job in jobs:
        word = json.dumps({"function": job.function, "arguments": job.arguments})
        subprocess.run(["true", word], check=True)


def test_what_follows_evolution_is_done_for_some_runs_in_each_process(tmp_path):
    plan, shares = plan_of(19, tmp_path), DeviceShares(("cuda:0", "cuda:1"), 2)
    evolved = [chain[1:] for chain in plan.chains()]
    jobs = [job for chain in shares.later(evolved, tmp_path) for job in chain]
    assert [len(job.runs) for job in jobs] == [6, 6, 7]
    assert [job.arguments["device"] for job in jobs] == ["cuda:0", "cuda:1", "cuda:0"]
    folders = [folder for job in jobs for folder in job.arguments["folders"]]
    assert folders == [str(plan.path(config)) for config in plan.configs]
    assert {(job.stage, job.function) for job in jobs} == {(TESTING, reference(stages.test_runs_on))}
    assert jobs[0].name == "with-indicate, seed 0 and 5 more"


def test_what_no_device_can_do_stays_on_the_processor(tmp_path):
    plan, shares = plan_of(2, tmp_path), DeviceShares(("cuda",), 2)
    alone = [[replace(chain[1], stage="measuring")] for chain in plan.chains()]
    assert shares.later(alone, tmp_path) == alone


def test_runs_come_in_waves_where_that_is_asked_for(tmp_path):
    chains = plan_of(7, tmp_path).chains()
    waves = replace(DeviceShares(("cuda",), 2), runs_at_once=3).waves(chains)
    assert [len(wave) for wave in waves] == [3, 3, 1]
    assert [chain for wave in waves for chain in wave] == chains
    assert DeviceShares(("cuda",), 2).waves(chains) == [chains]


def test_the_processor_is_shared_as_ever_and_a_cluster_by_its_workers():
    assert device_shares("cpu", 3) is None
    assert device_shares("cuda", None, 5) == DeviceShares(("cuda",), 5)
    assert device_shares("warp-cpu", 2) == DeviceShares(("warp-cpu",), 2)


@pytest.mark.parametrize("threads_there", [None, 4])
def test_a_name_that_means_no_device_is_refused_wherever_it_should_be(threads_there):
    with pytest.raises(ValueError, match="unknown device 'gpu'"):
        device_shares("gpu", None, threads_there)
