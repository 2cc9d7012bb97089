"""The same bits however many processes share the runs; other processors are in test_golden.py."""

import pytest

from arm2d import Condition
from evolution.experiments.plan import Plan
from evolution.experiments.plan_runner import run_plan
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from tests.evolution.small_runs import contents

TINY = Settings(population=8, elites=2, parents=4, generations=12, trials_per_area=1)


@pytest.mark.slow
def test_an_experiment_gives_the_same_bytes_in_one_process_two_and_four(tmp_path):
    found = []
    for at_once in (1, 2, 4):
        configs = tuple(RunConfig(condition, seed, TINY) for condition in Condition for seed in (1, 2))
        plan = Plan(tmp_path / str(at_once), configs, post_evaluate=False)
        assert run_plan(plan, at_once) == ()
        found.append([contents(plan.path(config)) for config in configs])
    assert found[0] == found[1] == found[2]
    assert len({each["champions.npz"] for each in found[0]}) == 4
