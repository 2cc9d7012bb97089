"""Tasks: the paper's two among them, those that make no sense refused, and what is heard in them."""

import re

import numpy as np
import pytest

import arm2d
from arm2d import Condition, Instruction, LabelChanges, Task, draw_trials, record_trial, run_trials
from arm2d.kernel.world import WORD_CODES
from arm2d.readings import PLAIN
from arm2d.reference import run_trial
from arm2d.tasks.task import as_paper, papers_condition, read_task, task_of

READINGS = PLAIN
TASKS = [
    Task(third="both"),
    Task(places="dealt"),
    Task(words="object-first", word_steps=3),
    Task(words="action-first", word_steps=125),
    Task(third="ignore", held_out=("ignore green", "touch red", "move blue")),
    Task(third="both", codes=("move 100", "red 111"), words="action-first", word_steps=20, places="dealt"),
]


@pytest.mark.parametrize("condition", Condition)
def test_the_conditions_of_the_paper_are_two_of_them(condition):
    task = task_of(condition)
    assert (task.instructions, task.experienced) == (condition.instructions, condition.experienced)
    assert as_paper(task) is condition
    assert task.to_mapping() == {}
    assert task.largest_fitness == 18 / 7


@pytest.mark.parametrize("condition", Condition)
def test_the_papers_words_sound_as_the_kernel_has_them(condition):
    assert np.array_equal(task_of(condition).word_codes, WORD_CODES)


def test_a_code_of_ones_own_is_the_words_and_no_others():
    changed = Task(codes=("blue 111", "touch 100")).word_codes
    assert np.flatnonzero((changed != WORD_CODES).any(axis=1)).tolist() == [0, 4]
    assert changed[[0, 4]].tolist() == [[1, 1, 1], [1, 0, 0]]


def test_a_task_that_is_the_papers_draws_its_trials_with_its_bits():
    drawn = [
        draw_trials(["touch green", "move red"], 3, READINGS, np.random.default_rng(5), task)
        for task in (None, Condition.WITH_INDICATE, Task(held_out=("touch green", "move blue")))
    ]
    assert all(trials.task is None for trials in drawn)
    assert len({trials.alpha.tobytes() + trials.discs.tobytes() for trials in drawn}) == 1


@pytest.mark.parametrize("task", TASKS, ids=str)
def test_plain_values_give_a_task_back(task):
    assert read_task(task.condition_name, task.to_mapping()) == task
    assert re.fullmatch(r"[a-z0-9+-]{1,120}", task.name)


def test_different_tasks_have_different_names_however_long():
    words = [
        "move blue",
        "move green",
        "touch green",
        "touch red",
        "indicate blue",
        "indicate red",
        "ignore blue",
    ]
    rest = {"third": "both", "places": "dealt"}
    long = [Task(held_out=(*words, last), **rest) for last in ("ignore red", "ignore green")]
    assert len({task.name for task in [*TASKS, *long]}) == len(TASKS) + 2
    assert max(len(task.name) for task in long) == 120


@pytest.mark.parametrize("task", TASKS, ids=str)
def test_kernel_and_reference_agree_on_it(task, evolved_plain):
    genotypes = np.concatenate([evolved_plain[::3], np.random.default_rng(1).random((3, 84))])
    trials = draw_trials(task.instructions, 1, READINGS, np.random.default_rng(2), task)
    scores = run_trials(genotypes, trials, READINGS)
    for p, genotype in enumerate(genotypes):
        for t, instruction in enumerate(trials.instructions):
            found = run_trial(genotype, instruction, trials.alpha[t], trials.discs[t], READINGS, task=task)
            assert (found.success, found.steps) == (scores.success[p, t], scores.steps[p, t])
            assert found.f1 + found.f2 + found.f3 == pytest.approx(scores.fitness[p, t], abs=1e-9)


def test_words_matter_where_they_are_all_that_differs(evolved_plain):
    """The same starts, said in four ways, end in four ways."""
    plain = draw_trials(Condition.WITH_INDICATE.instructions, 5, READINGS, np.random.default_rng(2))
    tasks = [None, TASKS[2], TASKS[3], Task(codes=("touch 111",))]
    ends = [
        run_trials(
            evolved_plain,
            arm2d.Trials(plain.actions, plain.objects, plain.alpha, plain.discs, task=task),
            READINGS,
        )
        for task in tasks
    ]
    assert len({each.fitness.tobytes() for each in ends}) == len(tasks)


def test_words_come_one_after_the_other_and_then_silence(evolved_plain):
    task = Task(words="action-first", word_steps=20)
    trials = draw_trials("indicate green", 1, READINGS, np.random.default_rng(2), task)
    heard = record_trial(evolved_plain[0], trials[0], READINGS).inputs[:, 12:].astype(int).tolist()
    assert len(heard) > 41
    assert all(bits == [0, 0, 0, 1, 1, 0] for bits in heard[:20])
    assert all(bits == [1, 0, 1, 0, 0, 0] for bits in heard[20:40])
    assert all(bits == [0, 0, 0, 0, 0, 0] for bits in heard[40:])


def test_both_third_actions_are_told_apart():
    codes = Task(third="both").word_codes.tolist()
    assert codes[3:] == [[0, 1, 1], [1, 0, 1], [1, 1, 0], [1, 1, 1]]
    assert len(Task(third="both").instructions) == 12
    assert Task(third="both").largest_fitness == pytest.approx((4 * 3 + 6 * 2) / 10)


def test_colours_are_dealt_to_the_sectors_so_that_all_six_orders_come_up():
    trials = draw_trials("touch red", 200, READINGS, np.random.default_rng(3), Task(places="dealt"))
    bearings = np.degrees(np.arctan2(trials.discs[..., 1], trials.discs[..., 0]))
    sectors = np.rint((bearings - 30.0) / 60.0).astype(int)
    assert (np.sort(sectors, axis=1) == [0, 1, 2]).all()
    assert (np.abs(bearings - (30.0 + 60.0 * sectors)) <= 10.0 + 1e-9).all()
    orders, counts = np.unique(sectors, axis=0, return_counts=True)
    assert len(orders) == 6
    assert counts.min() > 40  # of 400


@pytest.mark.parametrize("task", TASKS, ids=str)
def test_the_world_to_be_stepped_gives_what_the_kernel_senses(task, evolved_plain):
    trials = draw_trials(task.instructions[-4:], 1, READINGS, np.random.default_rng(4), task)
    records = [record_trial(evolved_plain[1], trials[t], READINGS) for t in range(len(trials))]
    worlds = arm2d.VectorWorld(trials, READINGS)
    for step in range(max(record.steps for record in records)):
        for t, record in enumerate(records):
            if step < record.steps:
                assert worlds.inputs[t].tolist() == record.inputs[step].tolist()
        turns = [np.sign(r.turns[step]) if step < r.steps else (0, 0) for r in records]
        worlds.step(np.array(turns, dtype=int))
    assert worlds.scores().success[0].tolist() == [record.success for record in records]


def test_one_world_takes_a_task():
    world = arm2d.World(task=TASKS[2])
    assert world.reset("touch green", seed=1)[12:].tolist() == [1, 0, 1, 0, 0, 0]
    for _ in range(3):
        inputs = world.step((0, 0))
    assert inputs[12:].tolist() == [0, 0, 0, 1, 0, 1]
    assert world.record().task == TASKS[2]
    with pytest.raises(ValueError, match="words come one after the other; they cannot be changed"):
        world.hear("move red")


@pytest.mark.parametrize(
    "task", [*Condition, "with-ignore", Task(), Task(third="ignore"), "with-both", *TASKS]
)
def test_a_world_takes_whatever_is_a_task_and_no_other_instructions(task):
    world, known = arm2d.World(task=task), task_of(task).instructions
    for instruction in known:
        world.reset(instruction, seed=1)
        world.step((0, 0))
        assert world.record().instruction == instruction
    absent = [each for each in Task(third="both").instructions if each not in known]
    start = draw_trials("move red", 1, READINGS, np.random.default_rng(4))[0]
    for instruction in absent:
        for begin in ({"seed": 1}, {"start": start}):
            with pytest.raises(ValueError, match=f"has no instruction {instruction}; it has MOVE Blue, "):
                world.reset(instruction, **begin)


def test_trials_of_a_condition_can_be_stepped():
    drawn = draw_trials("move red", 1, READINGS, np.random.default_rng(4))
    trials = arm2d.Trials(
        drawn.actions, drawn.objects, drawn.alpha, drawn.discs, task=Condition.WITH_INDICATE
    )
    worlds = arm2d.VectorWorld(trials)
    worlds.step(np.zeros((2, 2), int))
    worlds.restart([0], drawn[1])
    assert worlds.inputs[:, 12:].tolist() == [[0, 1, 1, 0, 1, 1]] * 2


def test_trials_begun_anew_begin_with_the_first_word():
    task = Task(words="object-first", word_steps=2)
    trials = draw_trials(["move red", "touch blue"], 1, READINGS, np.random.default_rng(4), task)
    worlds = arm2d.VectorWorld(trials)
    for _ in range(3):
        worlds.step(np.zeros((4, 2), int))
    worlds.restart([1], trials[3])
    assert worlds.inputs[:2, 12:].tolist() == [[0, 0, 0, 0, 1, 1], [1, 1, 0, 0, 0, 0]]
    with pytest.raises(ValueError, match="trials of one task cannot be begun anew as trials of another"):
        worlds.restart([1], draw_trials("move red", 1, READINGS, np.random.default_rng(4))[0])


def test_words_in_sequence_do_not_change_in_mid_trial():
    trials = draw_trials("move red", 1, READINGS, np.random.default_rng(4))
    two = np.zeros(2, int)
    changes = LabelChanges(two, two, two, two, two)
    with pytest.raises(ValueError, match="one after the other cannot change in mid-trial"):
        arm2d.Trials(trials.actions, trials.objects, trials.alpha, trials.discs, changes, TASKS[2])


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"held_out": ("move blue", "move green", "move red")}, "the word move would never be heard"),
        (
            {"held_out": ("move red", "touch red", "indicate red")},
            "with MOVE Red, TOUCH Red, INDICATE Red held out, the word red would never be heard; hold out",
        ),
        ({"held_out": Condition.WITH_INDICATE.instructions}, "the word move would never be heard"),
        ({"held_out": ("ignore red",)}, "with-indicate has no instruction IGNORE Red that could be held out"),
        ({"held_out": ("move red", "move red")}, "task held_out has an instruction twice"),
        ({"held_out": ("shout red",)}, "unknown action word 'shout'"),
        ({"codes": ("touch 011",)}, "move and touch have the same code 011; nobody could tell them apart"),
        ({"codes": ("blue 101",)}, "blue and green have the same code 101"),
        ({"codes": ("touch 000",)}, "the code of touch would be 000, which is what silence sounds like"),
        ({"codes": ("ignore 111",)}, "with-indicate has no word ignore that could have a code"),
        ({"codes": ("touch 111", "touch 100")}, "task codes has touch twice"),
        ({"codes": ("touch 12",)}, "code 'touch 12' is not understood; give a word and three bits"),
        ({"third": "both", "codes": ("ignore 110",)}, "indicate and ignore have the same code 110"),
        ({"third": "dance"}, "task third = 'dance'; choose indicate or ignore or both"),
        ({"words": "sung"}, "task words = 'sung'; choose together or object-first or action-first"),
        ({"places": "moon"}, "task places = 'moon'; choose own or dealt"),
        ({"word_steps": 5}, "task word_steps belongs to words that come one after the other"),
        ({"words": "object-first", "word_steps": 126}, "task word_steps = 126 must lie in [1, 125]"),
        ({"words": "object-first", "word_steps": 2.5}, "task word_steps = 2.5 must be a whole number"),
        (
            {"held_out": "touch green"},
            "task held_out = 'touch green' must be a list of texts, such as ['touch green']",
        ),
        ({"held_out": 5}, "task held_out = 5 must be a list of texts"),
        ({"held_out": [5]}, "task held_out = [5] must be a list of texts"),
        ({"held_out": Instruction.parse("touch green")}, "must be a list of texts"),
        ({"codes": "touch 111"}, "task codes = 'touch 111' must be a list of texts, such as ['touch 111']"),
        ({"codes": [111]}, "task codes = [111] must be a list of texts"),
    ],
)
def test_a_task_that_makes_no_sense_is_refused_with_the_reason(options, sentence):
    with pytest.raises(ValueError, match=re.escape(sentence)):
        Task(**options)


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        (
            {"colour": 1},
            "unknown part of a task 'colour'; there are held_out, codes, words, word_steps, places",
        ),
        ({"held_out": "touch red"}, "task held_out = 'touch red' must be a list of texts"),
        ({"codes": [3]}, "task codes = [3] must be a list of texts"),
        ({"word_steps": True}, "task word_steps = True must be a whole number"),
        ({"words": 3}, "task words = 3 must be text"),
    ],
)
def test_plain_values_that_are_no_task_are_refused(values, sentence):
    with pytest.raises(ValueError, match=re.escape(sentence)):
        read_task("with-indicate", values)


def test_what_is_made_for_the_paper_says_so():
    assert papers_condition(Task(third="ignore"), "this") is Condition.WITH_IGNORE
    with pytest.raises(
        ValueError, match=r"this is made for the paper's two conditions, .* not for with-both"
    ):
        papers_condition(Task(third="both"), "this")


def test_held_out_instructions_may_be_records_or_text():
    records = (Instruction.parse("move red"), Instruction.parse("touch blue"))
    assert Task(held_out=records) == Task(held_out=("TOUCH Blue", "move red"))
