"""Which agents of an experiment are worth keeping, on successes placed by hand."""

import numpy as np

from arm2d import NON_EXPERIENCED, Condition
from evolution.results.notable import best_agent, best_specialist
from tests.evolution.made_up import condition_results

INDICATE = Condition.WITH_INDICATE
NEVER_MET = [INDICATE.instructions.index(word) for word in NON_EXPERIENCED]


def test_the_specialist_never_carries_out_what_it_never_met_and_the_generaliser_is_good_at_all():
    successes = np.full((2, 3, 5, 9), 20)
    successes[0, 1, 2] = 70  # the best at all nine
    successes[1, 2, 4] = 60
    successes[1, 2, 4, NEVER_MET] = 0  # the best of those that never do
    successes[0, 0, 0] = 50
    successes[0, 0, 0, NEVER_MET] = 0
    results = condition_results(INDICATE, successes)
    best, specialist = best_agent(results), best_specialist(results)
    assert (best.run.config.seed, best.generation, best.rank) == (1, 101, 2)
    assert (specialist.run.config.seed, specialist.generation, specialist.rank) == (2, 102, 4)
    assert specialist.successes.tolist() == successes[1, 2, 4].tolist()
