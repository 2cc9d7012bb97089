import numpy as np
import pytest

from arm2d import Condition, Readings, draw_trials, record_trial
from evolution.agents.innovations import innovations, lineage_arrays
from evolution.agents.lineage import ancestor_indices, trace_lineage
from evolution.agents.lineage_scores import Skills, longest_bent_stay, offsets, score_lineage
from evolution.cli import main
from evolution.figures.lineage import lineage_figure
from evolution.figures.page import LARGEST_DRAWING
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_history
from evolution.runs.replay import population_at
from evolution.runs.storage import DamagedFileError, read_arrays, write_arrays
from evolution.search.algorithm import rank as ranking
from evolution.search.evaluation import evaluate


@pytest.fixture(scope="module")
def folder(finished_run):
    return RunFolder.open(finished_run)


@pytest.fixture(scope="module")
def lineage(folder):
    return trace_lineage(folder)


@pytest.fixture(scope="module")
def scores(folder, lineage):
    return score_lineage(lineage, folder.config.condition, folder.config.readings, per_area=1)


def test_the_line_is_bit_by_bit_that_of_the_run(folder, lineage):
    for generation in (0, 1, 57, 100, 229):
        population = population_at(folder, generation)
        index = lineage.indices[generation]
        assert np.array_equal(population.genotypes[index], lineage.genotypes[generation])
        if generation:
            assert population.parents[index] == lineage.indices[generation - 1]


def test_ancestors_among_the_five_best_are_those_kept_in_the_parts(folder, lineage):
    history, n_kept = recorded_history(folder), 0
    for generation, index in enumerate(lineage.indices):
        place = ranking(history.fitness[generation], Readings()).tolist().index(index)
        if place < 5:
            assert np.array_equal(history.best_genotypes[generation, place], lineage.genotypes[generation])
            n_kept += 1
    assert n_kept > 100


def test_the_line_ends_with_the_agent(folder):
    history = recorded_history(folder)
    for generation, rank in ((229, 0), (130, 4), (0, 2)):
        line = trace_lineage(folder, generation, rank)
        assert len(line) == generation + 1
        assert np.array_equal(line.genotypes[-1], history.best_genotypes[generation, rank])
        assert line.fitness[-1] == history.fitness[generation, line.indices[-1]]


def test_ranks_beyond_the_five_best_have_ancestors_too(folder):
    line = trace_lineage(folder, 40, 9)
    assert line.fitness[-1] == recorded_history(folder).fitness[40].min()


def test_parents_are_followed_backwards():
    parents = np.array([[-1, -1, -1], [2, 0, 1], [0, 0, 1]])
    assert ancestor_indices(parents, 2).tolist() == [0, 1, 2]
    assert ancestor_indices(parents, 0).tolist() == [2, 0, 0]


def test_only_changed_genotypes_are_distinct_and_give_back_the_line(lineage):
    assert lineage.changed[0]
    assert 1 < len(lineage.distinct) < len(lineage)
    assert np.array_equal(lineage.distinct[lineage.versions], lineage.genotypes)


def test_generations_and_ranks_that_do_not_exist_are_named(folder):
    with pytest.raises(ValueError, match="has no generation 230; it has 230, numbered from 0"):
        trace_lineage(folder, 230)
    with pytest.raises(ValueError, match="rank 10 does not exist; the generation has ranks 0 to 9"):
        trace_lineage(folder, 5, 10)


def test_a_history_that_was_not_bred_is_refused(run_copy):
    folder = RunFolder.open(run_copy)
    path = folder.part_path(folder.spans[1])
    arrays = read_arrays(path)
    write_arrays(path, {**arrays, "parents": (arrays["parents"] + 1).astype(np.int16) % 10})
    with pytest.raises(
        DamagedFileError, match=r"recompute generations 100 to 199 with: wordarm verify .* --repair"
    ):
        trace_lineage(folder)


def test_a_skill_comes_with_25_generations_in_a_row():
    shares = np.zeros((200, 4))
    shares[10:34, 0] = 1.0  # 24 generations, then lost
    shares[60:, 0] = 0.8
    shares[10:35, 1] = 1.0  # 25, then lost
    shares[190:, 2] = 1.0  # as far as there are generations
    shares[:, 3] = 0.75  # not above
    skills = Skills.along(shares)
    assert skills.first.tolist() == [60, 10, 190, -1]
    assert skills.for_good.tolist() == [60, -1, 190, -1]


def test_a_few_unlucky_ancestors_do_not_undo_a_skill():
    shares = np.ones((200, 1))
    shares[60:66] = 0.0
    assert Skills.along(shares).for_good.tolist() == [0]
    shares[60:90] = 0.0
    assert Skills.along(shares).for_good.tolist() == [90]


def test_a_skill_the_agent_has_lost_did_not_come_for_good():
    """Lost at the very end of a long line, it is still had by nine tenths of the rest."""
    shares = np.zeros((6000, 2))
    shares[5121:5990, 0] = 1.0
    shares[5121:, 1] = 1.0
    skills = Skills.along(shares)
    assert skills.first.tolist() == [5121, 5121]
    assert skills.for_good.tolist() == [-1, 5121]


def test_whatever_came_for_good_the_agent_has():
    rng = np.random.default_rng(2)
    skills = Skills.along(rng.binomial(20, 0.78, (300, 400)) / 20)
    stayed = skills.for_good >= 0
    assert 10 < stayed.sum() < 390
    assert (skills.shares[-1, stayed] > 0.75).all()


def test_scores_of_the_line_are_those_of_its_agents(folder, lineage, scores):
    assert scores.success.shares.shape == (230, 9)
    assert np.array_equal(
        scores.success.shares[1:][~lineage.changed[1:]], scores.success.shares[:-1][~lineage.changed[1:]]
    )
    again = score_lineage(lineage, folder.config.condition, folder.config.readings, per_area=1)
    assert np.array_equal(again.success.shares, scores.success.shares)
    assert np.array_equal(again.held_bent.shares, scores.held_bent.shares)


def test_keeping_s1_on_the_target_implies_having_reached_it(scores):
    assert np.all(scores.held_bent.shares <= scores.reached_bent.shares)


def test_stay_on_the_target_is_measured_while_s2_is_bent(evolved_agent):
    condition, readings = Condition.WITH_INDICATE, Readings()
    trials = draw_trials(condition.instructions, 1, readings, np.random.default_rng(3))
    for i in range(len(trials)):
        record = record_trial(evolved_agent, trials[i], readings)
        target = record.discs[:, record.instruction.object]
        good = (offsets(record.alpha, target) < 4.6) & (record.beta > 45.0)
        best = run = 0
        for each in good:
            run = run + 1 if each else 0
            best = max(best, run)
        assert longest_bent_stay(record) == best


def test_offsets_go_the_short_way_round():
    centres = np.array([[0.0, 150.0], [-150.0, -1e-9], [150.0, 0.0]])
    assert offsets(np.array([85.0, 200.0, -30.0]), centres) == pytest.approx([5.0, 20.0, 30.0])


def test_innovations_stand_in_the_order_of_their_coming(scores):
    order = [each.first for each in innovations(scores)]
    came = [each for each in order if each >= 0]
    assert len(order) == 15
    assert order == sorted(came) + [-1] * (15 - len(came))


def test_an_innovation_tells_what_the_agent_at_the_end_of_the_line_can(scores):
    names = [str(word) for word in scores.condition.instructions]
    found = {innovation.skill: innovation for innovation in innovations(scores)}
    assert not np.array_equal(scores.success.shares[0], scores.success.shares[-1])
    for column, name in enumerate(names):
        assert found[name].agent == scores.success.shares[-1, column]
        assert found[name].first == scores.success.first[column]


def test_figure_shows_every_skill_and_marks_the_never_met(scores):
    figure = lineage_figure(scores, "agent")
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert labels[:3] == ["hearing MOVE", "hearing TOUCH", "hearing INDICATE"]
    assert labels[3:] == [
        "never met   Blue", "Green", "Red", "Blue", "never met   Green", "Red", "Blue", "Green", "Red",
    ]  # fmt: skip


def test_arrays_hold_the_line_and_its_scores(lineage, scores):
    arrays = lineage_arrays(lineage, scores, "agent")
    assert arrays["success_shares"].shape == (230, 9)
    assert arrays["held_bent_first"].shape == (3,)
    assert np.array_equal(arrays["distinct_genotypes"], lineage.distinct)


def test_command_writes_figure_and_arrays(finished_run, tmp_path, capsys):
    flags = ["--generation=60", "--rank=1", "--trials-per-area=1", f"--output={tmp_path}"]
    assert main(["lineage", str(finished_run), *flags]) == 0
    names = [f"generation-000060-rank-1.{suffix}" for suffix in ("npz", "png", "svg")]
    assert sorted(each.name for each in tmp_path.iterdir()) == names
    assert str(tmp_path / names[0]) in capsys.readouterr().out
    assert (tmp_path / names[2]).stat().st_size <= LARGEST_DRAWING
    assert str(read_arrays(tmp_path / names[0])["origin"]) == "with-indicate, seed 11, generation 60, rank 1"


def test_command_answers_bad_input_with_one_sentence(finished_run, capsys):
    for flags, found in (
        (["--generation=-1"], "has no generation -1"),
        (["--trials-per-area=0"], "asked for 0 trials per area"),
    ):
        assert main(["lineage", str(finished_run), *flags]) == 2
        errors = capsys.readouterr().err
        assert found in errors
        assert errors.count("\n") == 1


def test_lineage_scores_agree_with_an_evaluation_in_kind(folder, lineage):
    line = score_lineage(lineage, folder.config.condition, folder.config.readings, per_area=40)
    other = evaluate(lineage.genotypes[-1], folder.config.condition, folder.config.readings)
    shares = other.successes[0].sum(axis=-1) / other.trials
    # Two independent samples of 80 trials: five standard errors at most apart.
    assert np.all(np.abs(line.success.shares[-1] - shares) < 5 * np.sqrt(2 * 0.25 / 80))
