"""A run's row against plain loops, in tasks that are not the paper's; rows read back, or refused."""

import csv

import numpy as np
import pytest

from arm2d import Task, draw_trials, run_trials
from evolution.runs.folder import RunFolder
from evolution.runs.run import evolve
from evolution.runs.sources import find_agent
from evolution.search.config import RunConfig
from evolution.search.randomness import Purpose, generator
from evolution.search.settings import Settings
from evolution.study.beyond.cells import CELLS, cell_of
from evolution.study.beyond.rows import measured_run, read_rows, write_rows
from evolution.study.measures import measure
from tests.evolution.study.beyond.made_up import CONFIGS, made_study

SETTINGS = Settings(population=12, elites=2, parents=6, generations=40)
SAMPLED = 30  # the only late generation that is a multiple of ten
TASKS = [
    Task(third="ignore"),
    Task(third="both"),
    Task(third="ignore", places="dealt"),
    Task(third="ignore", words="action-first"),
    Task(third="ignore", held_out=("move blue",)),
    Task(third="ignore", held_out=("move blue", "move green", "touch blue", "touch green")),
]


@pytest.fixture(scope="module", params=TASKS, ids=str)
def run(request, tmp_path_factory, evolved):
    """A short run of a task into whose late generation a shipped agent is put, twice, among others."""
    source = find_agent("with-ignore")
    folder = tmp_path_factory.mktemp("rows") / "run"
    evolve(folder, RunConfig(request.param, 3, SETTINGS, source.readings))
    run = RunFolder.open(folder)
    (span,) = run.spans
    arrays = run.read_arrays(run.part_path(span))
    arrays["best_genotypes"][SAMPLED] = [source.genotype, *evolved[:2], source.genotype, evolved[15]]
    run.write_arrays(run.part_path(span), arrays)
    return run


def counted(run):
    """Successes [5][instruction] of the sampled agents, trial by trial, as the task says them."""
    config = run.config
    rng = generator(config.seed, Purpose.POST_EVALUATION, SAMPLED)
    (span,) = run.spans
    agents = []
    for genotype in run.read_part(span).best_genotypes[SAMPLED]:
        trials = draw_trials(config.task.instructions, 40, config.readings, rng, config.task)
        success = run_trials(genotype, trials, config.readings).success[0]
        asked = list(zip(trials.instructions, success, strict=True))
        agents.append({w: sum(bool(s) for each, s in asked if each == w) for w in config.task.instructions})
    return agents


def test_a_row_holds_what_plain_loops_count(run):
    agents, task, row = counted(run), run.config.task, measured_run(run)
    obeying = [own for own in agents if all(own[word] > 60 for word in task.experienced)]
    assert row.agents == len(agents) == 5
    assert row.obeying == len(obeying)
    assert row.understood == {word: sum(own[word] > 60 for own in obeying) for word in task.held_out}
    assert row.all_understood == sum(all(own[word] > 60 for word in task.held_out) for own in obeying)
    for word in task.instructions:
        assert row.successes[word] == pytest.approx(np.mean([own[word] / 80 for own in agents]), abs=5.1e-5)


def test_the_shipped_agent_understands_what_it_can(run):
    """It carries out all nine; words said once, and a code it has never heard, are beyond it."""
    row, task = measured_run(run), run.config.task
    if task.third == "ignore" and not task.in_sequence and task.places == "own":
        assert row.all_understood >= 2
        assert all(count >= 2 for count in row.understood.values())
    if task.third == "both" or task.in_sequence:
        assert row.obeying == 0


def test_plateaus_are_told_as_a_share_of_the_task_s_largest_fitness(run):
    row, task = measured_run(run), run.config.task
    largest = np.mean([3 if word.action <= 1 else 2 for word in task.experienced])
    assert row.relative_plateau == pytest.approx(row.plateau / largest)
    assert row.at_limit == measure(run).at_limit == (row.plateau >= largest - 0.02)


def test_rows_are_read_back_as_they_were_written(tmp_path):
    runs = made_study(range(201, 203))
    write_rows(runs, tmp_path / "rows.csv")
    back = read_rows(tmp_path / "rows.csv")
    assert [each.config for each in back] == [each.config for each in runs]
    for one, other in zip(back, runs, strict=True):
        assert (one.understood, one.all_understood, one.first_solved) == (
            other.understood, other.all_understood, other.first_solved,
        )  # fmt: skip
        assert one.successes == other.successes
    write_rows(back, tmp_path / "again.csv")
    assert (tmp_path / "again.csv").read_bytes() == (tmp_path / "rows.csv").read_bytes()


def changed(tmp_path, **values):
    """A file of one row of the paper's task in which columns have these values."""
    write_rows(made_study(range(201, 202))[:1], path := tmp_path / "rows.csv")
    lines = list(csv.reader(path.read_text(encoding="utf-8").splitlines()))
    for name, value in values.items():
        lines[1][lines[0].index(name.replace("_", " "))] = value
    path.write_text("\n".join(",".join(f'"{v}"' for v in line) for line in lines), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"cell": "dealt"}, "line 2, .*: a run of with-indicate with 3 inter-neurons is of the cell paper"),
        ({"places": "dealt"}, "with-indicate.places-dealt with 3 inter-neurons is of the cell dealt"),
        ({"words": "sung"}, "line 2, .*: task words = 'sung'; choose together or object-first"),
        ({"held_out": "TOUCH Green, MOVE Red"}, "line 2, .*: no cell has the task with-indicate.held-out"),
        ({"obey_all_experienced": ""}, "line 2, cannot be understood"),
    ],
)
def test_rows_of_another_cell_and_of_none_are_refused(tmp_path, values, message):
    with pytest.raises(ValueError, match=message):
        read_rows(changed(tmp_path, **values))


def test_every_run_belongs_to_one_cell():
    for config in CONFIGS:
        (cell,) = [
            cell
            for cell in CELLS
            if config.condition in cell.tasks and cell.inter_neurons == config.settings.inter_neurons
        ]
        assert cell_of(config) == cell
