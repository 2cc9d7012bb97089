"""A run's row against the whole post-evaluation, in a run whose late agents master all nine instructions."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from arm2d.device.opening import CHECK
from evolution.agents.postevaluation import post_evaluate
from evolution.agents.solving import file_path
from evolution.agents.subtasks import AgentClass, categories, classify
from evolution.agents.transitions import passes, run_transition_test
from evolution.runs.folder import RunFolder
from evolution.runs.run import evolve
from evolution.runs.sources import find_agent
from evolution.runs.storage import DamagedFileError
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from evolution.study import late_transitions, measures
from evolution.study.declared.rows import measured_run, post_evaluated_run
from evolution.study.device_measures import measure_on

SETTINGS = Settings(population=12, elites=2, parents=6, generations=40)
SAMPLED = 30  # the only late generation that is a multiple of ten


@pytest.fixture(scope="module")
def run(tmp_path_factory, evolved):
    """A short run into whose last generations shipped agents are put, among others."""
    source = find_agent("with-ignore")
    folder = tmp_path_factory.mktemp("rows") / "run"
    evolve(folder, RunConfig(source.condition, 3, SETTINGS, source.readings))
    run = RunFolder.open(folder)
    (span,) = run.spans
    arrays = run.read_arrays(run.part_path(span))
    arrays["best_genotypes"][SAMPLED:] = [source.genotype, *evolved[:2], source.genotype, evolved[15]]
    run.write_arrays(run.part_path(span), arrays)
    post_evaluate(run)
    run_transition_test(run)
    return run


def test_sampled_agents_pass_the_transitions_they_pass_in_the_whole_test(run):
    whole, evaluation = run_transition_test(run), post_evaluate(run)
    (row,) = np.flatnonzero(evaluation.generations == SAMPLED)
    condition, own = run.config.condition, whole.generations == SAMPLED
    counts = measured_run(run).counts
    members = classify(evaluation.successes[row], condition)
    assert counts["fully compositional"] == members[AgentClass.FULL].sum() == 2
    for test in ("action", "object"):
        for place, kind in enumerate(AgentClass):
            passed = passes(getattr(whole, test)[own & (whole.classes == place)]).sum()
            assert counts[f"{kind}, pass {test} transitions"] == passed


def test_counts_are_those_of_the_categories(run):
    evaluation, condition = post_evaluate(run), run.config.condition
    (row,) = np.flatnonzero(evaluation.generations == SAMPLED)
    counts = measured_run(run).counts
    for place, name in enumerate(("I", "II", "III", "IV")):
        for category in (5, 10):
            own = categories(evaluation.successes[row], condition)[:, place] == category
            assert counts[f"category {category} of {name}"] == own.sum()
    assert counts["agents"] == 5
    assert counts["masters"] >= counts["masters that understand MOVE Blue"] >= 2


def test_whole_test_counts_every_late_agent(run):
    evaluation, found = post_evaluate(run), post_evaluated_run(run)
    assert found.counts["agents"] == evaluation.successes[..., 0].size
    full = classify(evaluation.agents, run.config.condition)[AgentClass.FULL]
    assert found.counts["fully compositional"] == full.sum() >= 2 * 10
    assert found.plateau == measured_run(run).plateau
    np.testing.assert_allclose(found.successes[:, 0], evaluation.agents.mean(axis=0) / 80, atol=1e-4)


def test_damaged_transitions_are_named(run):
    path = run.path / late_transitions.FILE
    measured_run(run)
    before = path.read_bytes()
    path.write_bytes(before[:-20])
    with pytest.raises(DamagedFileError, match="remove it and repeat the command"):
        measured_run(run)
    for value in (-1, 6):  # of the 5 agents that were sampled
        path.write_bytes(before)
        arrays = run.read_arrays(path)
        arrays["passed"][-1, -1] = value
        run.write_arrays(path, arrays)
        with pytest.raises(DamagedFileError, match=r"its passed are not all in \[0, 5\]"):
            measured_run(run)
    path.write_bytes(before)


def test_a_device_measures_what_the_processor_measures(run, tmp_path):
    pytest.importorskip("warp", reason="the extra gpu is not installed")
    measured_run(run)
    copy = RunFolder.open(Path(shutil.copytree(run.path, tmp_path / "copy")))
    solved = file_path(copy)
    solved.unlink()
    shutil.rmtree(copy.path / late_transitions.FILE.parent)
    assert measure_on(CHECK, [str(copy.path)]) == 0
    for path in (solved, copy.path / late_transitions.FILE, copy.path / measures.FILE):
        found, expected = copy.read_arrays(path), run.read_arrays(run.path / path.relative_to(copy.path))
        assert found.keys() == expected.keys()
        for name, values in expected.items():
            np.testing.assert_array_equal(found[name], values, name)
