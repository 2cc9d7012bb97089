from dataclasses import replace

import numpy as np
import pytest

from arm2d import NON_EXPERIENCED, Condition, Instruction, Readings, draw_trials, run_trials
from evolution.search import scoring
from evolution.search.algorithm import initial_genotypes, mean_in_order
from evolution.search.config import RunConfig
from evolution.search.population import Population, first_population
from evolution.search.randomness import Purpose, generator
from evolution.search.scoring import draw_evolution_trials, score_population
from evolution.search.settings import LARGEST_FITNESS, LARGEST_TRIAL_FITNESS, Settings

CONFIG = RunConfig(seed=5, settings=Settings(population=10, parents=5))
SHARED, OWN = (replace(CONFIG, readings=Readings(starts_shared=each)) for each in ("generation", "genotype"))


@pytest.mark.parametrize("condition", Condition)
def test_non_experienced_instructions_never_occur_in_evolution(condition, monkeypatch):
    drawn = []

    def spy(instructions, *rest):
        drawn.extend(instructions)
        return draw(instructions, *rest)

    draw = scoring.draw_trials
    monkeypatch.setattr(scoring, "draw_trials", spy)
    for readings in (SHARED.readings, OWN.readings):
        config = replace(CONFIG, condition=condition, readings=readings)
        score_population(first_population(config), config)
    assert set(drawn) == set(condition.experienced)
    assert not set(drawn) & set(NON_EXPERIENCED)


@pytest.mark.parametrize("words", ["move blue", "touch green", "ignore red"])
def test_drawing_a_non_experienced_instruction_for_evolution_is_an_error(words):
    instruction = Instruction.parse(words)
    sentence = (
        f"non-experienced instruction {words.upper()} was drawn for evolution; this would spoil the result"
    )
    with pytest.raises(ValueError, match=sentence):
        draw_evolution_trials([instruction], Condition.WITH_INDICATE, 2, Readings(), np.random.default_rng(0))


def test_fitness_is_the_mean_over_28_trials_of_the_generation():
    for config in (SHARED, OWN):
        population = first_population(config)
        rng = generator(config.seed, Purpose.TRIALS)

        def draw(config=config, rng=rng):
            return draw_trials(config.condition.experienced, 2, config.readings, rng)

        n = len(population.genotypes)
        trials = [draw() for _ in range(n)] if config is OWN else [draw()] * n
        scores = [
            run_trials(*each, config.readings) for each in zip(population.genotypes, trials, strict=True)
        ]
        assert {each.fitness.shape for each in scores} == {(1, 28)}
        expected = [float(mean_in_order(each.fitness)[0]) for each in scores]
        assert score_population(population, config).tolist() == expected


def test_trials_differ_between_generations_and_repeat_within_one():
    genotypes = initial_genotypes(CONFIG.settings, np.random.default_rng(0))
    parents = np.zeros(10, dtype=np.int64)

    def scored(generation, config):
        return score_population(Population(generation, genotypes, parents), config).tolist()

    for config in (SHARED, OWN):
        assert scored(3, config) == scored(3, config)
        assert scored(3, config) != scored(4, config)


def test_equal_genotypes_score_equally_only_if_starts_are_shared():
    genotypes = np.tile(initial_genotypes(CONFIG.settings, np.random.default_rng(3))[0], (10, 1))
    population = Population(0, genotypes, np.zeros(10, dtype=np.int64))
    assert len(set(score_population(population, SHARED).tolist())) == 1
    assert len(set(score_population(population, OWN).tolist())) > 1


@pytest.mark.parametrize("condition", Condition)
def test_the_largest_fitness_is_a_mean_of_three_points_and_two_for_the_third_action(condition):
    largest = [2.0 if word.action is condition.third_action else 3.0 for word in condition.experienced]
    assert np.mean(largest) == pytest.approx(LARGEST_FITNESS, rel=1e-15)
    assert max(largest) == LARGEST_TRIAL_FITNESS
