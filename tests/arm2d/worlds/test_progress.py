"""A trial's score as it grows: its end is the score."""

import numpy as np
import pytest

from arm2d import ActionWord, Condition, Readings, draw_trials, record_trial
from arm2d.worlds.progress import progress_of


@pytest.mark.parametrize("condition", Condition)
@pytest.mark.parametrize("readings", [Readings(), Readings(f3_time="best", run_counting="cumulative")])
def test_progress_ends_with_the_scores_of_the_kernel(evolved_agent, condition, readings):
    trials = draw_trials(condition.instructions, 2, readings, np.random.default_rng(8))
    for index in range(len(trials)):
        record = record_trial(evolved_agent, trials[index], readings)
        progress = progress_of(record)
        assert progress.score[-1] == pytest.approx(record.fitness, abs=1e-9)
        assert len(progress.share) == record.steps + 1
        if record.success:
            assert progress.share[-1] == pytest.approx(1.0)


def test_a_run_that_breaks_begins_anew(evolved_agent):
    trials = draw_trials(Condition.WITH_INDICATE.instructions, 3, Readings(), np.random.default_rng(1))
    falls = 0
    for index in range(len(trials)):
        record = record_trial(evolved_agent, trials[index])
        share = progress_of(record).share
        falls += int((np.diff(share) < 0).sum())
        if record.instruction.action is not ActionWord.MOVE:
            assert set(np.round(share[1:][np.diff(share) < 0], 9)) <= {0.0}
    assert falls > 0
