"""Too little memory, a device that is lost, and names that mean none."""

import subprocess
import sys

import numpy as np
import pytest
import warp as wp

from arm2d import Condition, draw_trials, run_trials
from arm2d.device import opening
from arm2d.device.errors import DeviceLostError, DeviceMemoryError
from arm2d.device.groups import Group, Laboratory
from arm2d.device.opening import CHECK, check_name, open_device
from arm2d.readings import PLAIN
from evolution.search.algorithm import mean_in_order

LARGEST = 4 * 7 * 2 * 3  # trials of three groups of four genotypes


@pytest.fixture
def fresh(laboratory):
    """A laboratory whose memory has not been found too small yet."""
    return Laboratory(laboratory.device)


@pytest.fixture
def groups(evolved_plain):
    rng, readings = np.random.default_rng(4), PLAIN
    return [
        Group(
            evolved_plain[n : n + 4],
            draw_trials(Condition.WITH_IGNORE.experienced, 1, readings, rng),
            readings,
        )
        for n in range(7)
    ]


def limit_memory(monkeypatch, largest):
    """Let the device have no room for larger arrays, and tell so as CUDA does; returns what is asked for."""
    zeros, asked = wp.zeros, []

    def limited(shape, **options):
        asked.append(shape)
        if np.prod(shape) > largest and options["dtype"] is wp.float64:
            raise RuntimeError(f"Failed to allocate {8 * np.prod(shape)} bytes on device 'cuda:0'")
        return zeros(shape, **options)

    monkeypatch.setattr(wp, "zeros", limited)
    return asked


def test_a_batch_that_does_not_fit_into_the_memory_is_made_smaller(fresh, groups, monkeypatch):
    asked = limit_memory(monkeypatch, LARGEST)
    expected = [mean_in_order(run_trials(*group[:3]).fitness) for group in groups]
    np.testing.assert_array_equal(fresh.fitness(groups), expected)
    assert fresh.most_trials == 7 * 4 * 14 // 2
    asked.clear()
    np.testing.assert_array_equal(fresh.fitness(groups), expected)
    assert 7 * 4 * 14 not in asked  # what did not fit is not asked for again


def test_a_device_without_memory_for_one_group_says_so(fresh, groups, monkeypatch):
    limit_memory(monkeypatch, 10)
    with pytest.raises(DeviceMemoryError, match=r"^warp-cpu has too little memory left for even one group"):
        fresh.fitness(groups)


def test_a_device_that_no_longer_answers_is_lost(fresh, groups, monkeypatch):
    def fail(kernel, **options):
        raise RuntimeError("Error launching kernel: unspecified\nlaunch failure on device cuda:0")

    monkeypatch.setattr(wp, "launch", fail)
    with pytest.raises(DeviceLostError, match=r"lost \(Error launching kernel: unspecified launch failure"):
        fresh.fitness(groups)


def test_zeros_from_trials_that_never_ran_are_not_taken_for_scores(fresh, groups, monkeypatch):
    launch = wp.launch

    def skip_trials(kernel, **options):
        if kernel.key != "run_trials":
            launch(kernel, **options)

    monkeypatch.setattr(wp, "launch", skip_trials)
    with pytest.raises(DeviceLostError, match="392 of 392 trials did not end within 250 steps"):
        fresh.fitness(groups)


@pytest.mark.parametrize("name", ["gpu", "cuda:", "cuda:1234", "CUDA", "warp", ""])
def test_a_name_that_means_no_device_is_refused(name):
    with pytest.raises(
        ValueError, match=r"unknown device .*; give cpu, cuda, or one of several such as cuda"
    ):
        check_name(name)


def test_without_the_package_the_extra_is_named(monkeypatch):
    monkeypatch.setattr(opening, "find_spec", lambda name: None)
    for name in (CHECK, "cuda"):
        with pytest.raises(ValueError, match=r"warp-lang; install it with: pip install 'wordarm\[gpu\]'"):
            open_device(name)


def test_a_machine_without_a_graphics_card_says_so(monkeypatch):
    monkeypatch.setattr(opening, "_has_driver", lambda: False)
    with pytest.raises(ValueError, match="no CUDA device is found on this machine, so cuda:2 is not there"):
        open_device("cuda:2")


def test_whoever_stays_on_the_processor_does_not_wait_for_warp():
    script = (
        "import sys, arm2d, numpy as np, evolution.experiments.plan_runner\n"
        "import evolution.experiments.device.stages, evolution.experiments.device.jobs\n"
        "trials = arm2d.draw_trials('touch red', 1, arm2d.Readings(), np.random.default_rng(1))\n"
        "arm2d.run_trials(np.zeros(84), trials)\n"
        "print(sorted(each for each in sys.modules if each == 'warp' or each.startswith('arm2d.device')))\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout == "['arm2d.device', 'arm2d.device.errors', 'arm2d.device.opening']\n"
