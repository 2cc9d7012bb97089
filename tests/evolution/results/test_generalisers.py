"""Where fully compositional agents stand and how long they last, on members placed by hand."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from evolution.agents.parts import late_spans
from evolution.figures.generalisers import draw_density, draw_marks
from evolution.results.generalisers import (
    generalisers_of,
    longest_line,
    mean_rank_against_chance,
    spell_lengths,
)
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_history
from evolution.search.algorithm import rank


@pytest.fixture(scope="module")
def run(finished_run):
    return RunFolder.open(finished_run)


@pytest.fixture(scope="module")
def late(run):
    first = late_spans(run)[0].start
    return recorded_history(run)[first:]


def members_at(late, *agents):
    members = np.zeros((len(late), 5), bool)
    for row, place in agents:
        members[row, place] = True
    return members


def test_spells_are_stretches_of_generations_in_a_row():
    held = np.array([0, 1, 1, 0, 1, 0, 0, 1, 1, 1], bool)
    assert spell_lengths(held).tolist() == [2, 1, 3]
    assert spell_lengths(np.zeros(4, bool)).tolist() == []


def test_agents_are_counted_by_rank_and_generation(run, late):
    found = generalisers_of(run, late.generations, members_at(late, (0, 4), (3, 0), (3, 2), (4, 0)))
    assert found.by_rank.tolist() == [2, 0, 1, 0, 1]
    assert found.generations.tolist() == [late.generations[row] for row in (0, 3, 3, 4)]
    assert found.counts[:5].tolist() == [1, 0, 0, 2, 1]
    assert found.spells.tolist() == [1, 2]


def test_a_stay_is_every_generation_in_which_the_genotype_is_among_the_five_best(run, late):
    """Checked against a plain search through the record, whatever the verdicts were."""
    row = 20
    genotype = late.best_genotypes[row, 0]
    there = [g for g in range(len(late)) if (late.best_genotypes[g] == genotype).all(axis=1).any()]
    found = generalisers_of(run, late.generations, members_at(late, (row, 0)))
    assert found.stays.tolist() == [len(there)]
    assert found.first.tolist() == [late.generations[there[0]]]
    assert found.verdicts.tolist() == [1]


def test_a_line_goes_from_parent_to_child_and_ends_where_one_is_no_member():
    indices = np.array([[0, 1], [2, 3], [4, 0], [1, 2]])
    parents = np.full((4, 5), 4)
    parents[1, 2] = 1  # the child at 2 descends from the second best of the generation before
    parents[2, 4] = 2
    parents[3, 1] = 4
    members = np.array([[0, 1], [1, 0], [1, 0], [1, 0]], bool)
    assert longest_line(indices, parents, members) == 4
    members[1, 0] = False
    assert longest_line(indices, parents, members) == 2
    assert longest_line(indices, parents, np.zeros((4, 2), bool)) == 0


def test_an_elite_that_is_always_a_member_is_a_line_of_its_stay(run, late):
    indices = np.stack([rank(fitness, run.config.readings)[:5] for fitness in late.fitness])
    # The best is the first elite again: the copy of the best before, not a child without a mutation.
    start = int(np.flatnonzero(indices[1:, 0] == 0)[0])
    assert np.array_equal(late.best_genotypes[start + 1, 0], late.best_genotypes[start, 0])
    members = members_at(late, (start, 0), (start + 1, 0))
    assert longest_line(indices, late.parents, members) == 2


def test_chance_is_the_middle_rank_and_the_run_is_the_unit(run, late):
    above = generalisers_of(run, late.generations, members_at(late, *((row, 0) for row in range(30))))
    none = generalisers_of(run, late.generations, members_at(late))
    mean, p = mean_rank_against_chance([above] * 8 + [none])
    assert mean == 0
    assert p == pytest.approx(2 / 2**8)
    mean, p = mean_rank_against_chance([above])
    assert p == 1  # thirty agents of one run prove nothing
    assert np.isnan(mean_rank_against_chance([none])).all()


def test_every_fully_compositional_agent_is_a_mark_above_the_partial_ones(run, late):
    agents = [(row, row % 5) for row in range(0, 40, 5)]
    found = generalisers_of(run, late.generations, members_at(late, *agents))
    axes = Figure().add_subplot()
    draw_density(axes, late.generations, np.ones((len(late), 5), bool), 0.0, -0.5)
    draw_marks(axes, found, 0.0, -0.5)
    (marks,) = axes.lines
    assert np.asarray(marks.get_xdata()).tolist() == [late.generations[row] for row, _ in agents]
    lanes = np.round(-np.asarray(marks.get_ydata()) / 0.1 - 0.5).astype(int)
    assert lanes.tolist() == [place for _, place in agents]
    assert marks.get_zorder() > axes.images[0].get_zorder()
