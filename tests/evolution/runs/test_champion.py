import numpy as np

from arm2d import NON_EXPERIENCED
from evolution.runs.champion import Candidates, choose_champions, find_candidates
from evolution.runs.folder import CHAMPIONS, RunFolder
from evolution.runs.recorded import recorded_history
from evolution.search import scoring
from evolution.search.evaluation import evaluate
from tests.evolution.small_runs import SMALL


def test_candidates_are_the_distinct_best_of_the_last_100_generations(finished_run):
    history = recorded_history(RunFolder.open(finished_run))[-100:]
    candidates = find_candidates(history)
    distinct = {each.tobytes() for each in history.best_genotypes.reshape(-1, 84)}
    assert {each.tobytes() for each in candidates.genotypes} == distinct
    assert len(candidates.genotypes) == len(distinct)
    for genotype, generation, rank in zip(
        candidates.genotypes, candidates.generations, candidates.ranks, strict=True
    ):
        assert np.array_equal(history.best_genotypes[generation - 130, rank], genotype)


def test_each_candidate_stands_where_it_was_seen_last(finished_run):
    history = recorded_history(RunFolder.open(finished_run))[-100:]
    candidates = find_candidates(history)
    last = history.best_genotypes[-1]
    assert np.array_equal(candidates.genotypes[: len(np.unique(last, axis=0))], last)
    assert (np.diff(candidates.generations) <= 0).all()


def test_never_met_instructions_take_no_part_in_the_choice(finished_run, monkeypatch):
    drawn = []

    def spy(instructions, *rest):
        drawn.extend(instructions)
        return draw(instructions, *rest)

    draw = scoring.draw_trials
    monkeypatch.setattr(scoring, "draw_trials", spy)
    choose_champions(find_candidates(recorded_history(RunFolder.open(finished_run))[-5:]), SMALL)
    assert len(drawn) == 7
    assert not set(drawn) & set(NON_EXPERIENCED)


def test_the_worst_instruction_counts_before_the_sum_and_the_sum_before_fitness():
    class Scores:
        # Four candidates, seven instructions of one trial for each of 80.
        success = np.zeros((4, 7, 80), dtype=bool)
        fitness = np.zeros((4, 560))

    Scores.success[0, :6] = True  # six instructions always, one never
    Scores.success[1, :, :10] = True  # every instruction sometimes
    Scores.success[2, :, :10] = True  # the same with higher fitness
    Scores.fitness[2] = 1.0
    Scores.success[3, :5] = True
    Scores.success = Scores.success.reshape(4, 560)
    candidates = Candidates(np.zeros((4, 84)), np.arange(4), np.zeros(4, dtype=np.int64))
    champions, successes = choose_champions(candidates, SMALL, lambda *_: Scores)
    assert champions.generations.tolist() == [2, 1, 0, 3]
    assert successes[0].tolist() == [10] * 7


def test_champions_are_kept_with_what_they_make_of_all_nine(finished_run):
    folder = RunFolder.open(finished_run)
    arrays = folder.read_arrays(finished_run / CHAMPIONS)
    result = evaluate(arrays["genotypes"], SMALL.condition, SMALL.readings)
    assert arrays["genotypes"].shape == (5, 84)
    assert np.array_equal(arrays["successes"], result.successes.sum(axis=-1))
    assert arrays["instructions"].tolist() == [str(each) for each in SMALL.condition.instructions]
    assert str(arrays["config"]) == SMALL.to_toml()
