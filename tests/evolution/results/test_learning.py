"""Learning curves: what they count, how they are stored, and that evolution's is the run it says it is."""

import numpy as np
import pytest

from arm2d import Condition
from benchmarks.learning import evolution_curve, generations_tested
from evolution.results.learning import LearningCurve, read_curves, write_curves
from evolution.runs.sources import find_agent
from evolution.search import scoring
from evolution.search.evaluation import evaluate
from tests.evolution.small_runs import SMALL


def curve():
    """A learner that carries out MOVE Blue, never met, before anything else."""
    empty = LearningCurve.empty("pupil", Condition.WITH_IGNORE, 4)
    return empty.longer(0, 0.04, [0] * 9).longer(1000, 2.5, [80, 40, 40, 60, 20, 40, 80, 80, 80])


def test_shares_are_of_the_seven_and_of_the_two_never_met():
    found = curve()
    assert found.experienced.tolist() == [0.0, pytest.approx(420 / 560)]
    assert found.worst.tolist() == [0.0, 0.5]
    assert found.held_out.tolist() == [[0.0, 0.0], [0.25, 1.0]]  # TOUCH Green, MOVE Blue


def test_curves_are_read_as_they_were_written(tmp_path):
    curves = [curve(), LearningCurve.empty("other, one", Condition.WITH_IGNORE, 1).longer(1, 0.5, range(9))]
    write_curves(tmp_path / "curves.csv", curves)
    for found, written in zip(read_curves(tmp_path / "curves.csv"), curves, strict=True):
        assert (found.learner, found.condition, found.seed) == (
            written.learner,
            written.condition,
            written.seed,
        )
        assert np.array_equal(found.steps, written.steps)
        assert np.array_equal(found.successes, written.successes)
        np.testing.assert_allclose(found.cpu, written.cpu, atol=0.05)  # stored to a tenth of a second


def test_another_table_is_refused_with_what_would_be_right(tmp_path):
    (tmp_path / "runs.csv").write_text("variant,seed\ndefault,1\n")
    with pytest.raises(ValueError, match=r"runs.csv is no table of learning curves \(.*learner.*steps"):
        read_curves(tmp_path / "runs.csv")


def test_tests_lie_closer_together_at_first_and_include_both_ends():
    numbers = generations_tested(6000, 60)
    assert (numbers[0], numbers[-1]) == (0, 5999)
    assert (np.diff(numbers)[-10:] > 10 * np.diff(numbers)[:10]).all()


def test_the_curve_of_evolution_is_of_the_run_that_any_command_makes(tmp_path):
    plain = scoring.run_trials
    found = evolution_curve(SMALL, tmp_path / "run", tests=3)
    assert scoring.run_trials is plain
    generations = generations_tested(SMALL.settings.generations, 3)
    assert len(found) == len(generations)
    assert (np.diff(found.steps) > 0).all()
    assert found.steps[-1] <= SMALL.settings.generations * SMALL.settings.population * 28 * 250
    assert (np.diff(found.cpu) > 0).all()
    best = find_agent(str(tmp_path / "run"), generation=int(generations[-1]), rank=0)
    again = evaluate(
        best.genotype, best.condition, best.readings, per_area=40, trial_seed=int(generations[-1])
    )
    assert found.successes[-1].tolist() == again.successes[0].sum(axis=-1).tolist()
