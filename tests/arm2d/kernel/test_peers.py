"""The peers that the kernel's speed is measured against carry out the same trials."""

import numpy as np
import pytest

from arm2d import Condition, draw_trials, run_trials
from arm2d.readings import PLAIN
from benchmarks import numpy_peer
from benchmarks.kernel import alike


@pytest.fixture(scope="module")
def generation(evolved_plain):
    """Six evolved_plain genotypes and all instructions of a condition, one trial each from either area."""
    trials = draw_trials(Condition.WITH_IGNORE.instructions, 1, PLAIN, np.random.default_rng(4))
    return evolved_plain[::10], trials, PLAIN


@pytest.mark.parametrize("sparse", [False, True])
def test_numpy_peer_and_kernel_agree(generation, sparse):
    assert alike(numpy_peer.run_trials(*generation, sparse=sparse), run_trials(*generation)) == 1.0


def test_jax_peer_and_kernel_agree(generation):
    pytest.importorskip("jax", reason="jax is not installed; only the benchmark's JAX peer needs it")
    from benchmarks import jax_peer

    assert alike(jax_peer.prepare(*generation)(), run_trials(*generation)) == 1.0


def test_a_trial_that_ends_otherwise_is_not_alike(generation):
    genotypes, trials, readings = generation
    other = run_trials(genotypes[::-1], trials, readings)
    assert alike(other, run_trials(*generation)) < 1.0
