"""What genotypes are run with: codes of words and readings, refused before the kernel reads them."""

import numpy as np
import pytest

from arm2d import Condition, Task, draw_trials, record_trial, run_trials
from arm2d.kernel.world import WORD_CODES
from arm2d.readings import PLAIN

TRIALS = draw_trials(Condition.WITH_INDICATE.instructions, 1, PLAIN, np.random.default_rng(1))


@pytest.mark.parametrize(
    ("codes", "found"),
    [
        (np.zeros((6, 3), int), r"these are \[6, 3\]"),
        (np.zeros((7, 3, 1), int), r"these are \[7, 3, 1\]"),
        ([[0, 1, 1]] * 6 + [[0, 1]], r"these are \[7\]"),
        (5, r"these are \[\]"),
        (np.full((7, 3), 0.5), "one is 0.5"),
        (np.full((7, 3), np.nan), "one is nan"),
        (np.where(WORD_CODES, 5, 0), "one is 5"),
        (WORD_CODES.astype(str), "one is '1'"),
    ],
)
def test_codes_of_words_are_seven_rows_of_three_bits(codes, found, evolved_agent):
    with pytest.raises(ValueError, match=rf"word_codes must be \[7, 3\] of 0 and 1, .*; {found}"):
        run_trials(evolved_agent, TRIALS, PLAIN, word_codes=codes)


@pytest.mark.parametrize("kind", [np.ndarray.tolist, np.asfortranarray, np.float64, np.int8, np.bool_])
def test_codes_of_words_are_taken_in_any_form(kind, evolved_plain):
    codes = Task(codes=("touch 111",)).word_codes
    expected = run_trials(evolved_plain, TRIALS, PLAIN, word_codes=codes).fitness
    given = run_trials(evolved_plain, TRIALS, PLAIN, word_codes=kind(codes)).fitness
    assert np.array_equal(given, expected)
    assert not np.array_equal(expected, run_trials(evolved_plain, TRIALS, PLAIN).fitness)


@pytest.mark.parametrize("run", [run_trials, record_trial])
def test_readings_of_another_kind_are_refused(run, evolved_agent):
    with pytest.raises(ValueError, match="readings = 'plain' must be a record"):
        run(evolved_agent, TRIALS[0], "plain")
