"""What is said of the agent's mind: it is the mind that acted."""

from dataclasses import replace

import numpy as np
import pytest

from arm2d import ActionWord, Condition, Instruction, LabelChanges, ObjectWord, Readings, Task, draw_trials
from arm2d import record_trial as record_one
from arm2d.network.controller import decode
from mujoco_port.film.panel import MindPanel
from mujoco_port.film.take import mind_of, task_heard

CHANGE = 3
TASK = Task()


@pytest.fixture(scope="module")
def records(champion_records):
    return champion_records


def test_motors_shown_turn_the_joints_as_the_record_has_it(records, evolved_agent):
    """But where a joint rests at its bound, or the display's arithmetic is a rounding off the kernel's."""
    for record in records:
        mind = mind_of(record, evolved_agent)
        for joint in range(2):
            go, way = mind.motors[:, 2 * joint], mind.motors[:, 2 * joint + 1]
            turn = np.where(go > 0.5, np.sign(0.5 - way), 0.0)
            moved = np.sign(record.turns[:, joint])
            free = moved != 0.0
            # In some trials S2 never turns.
            assert (turn[free] != moved[free]).sum() < 0.01 * max(free.sum(), 1)
    assert all(any(record.turns[:, joint].any() for record in records) for joint in range(2))


def test_states_shown_are_those_of_the_kernel(records, evolved_agent):
    for record in records[:4]:
        mind = mind_of(record, evolved_agent)
        biases = decode(evolved_agent, record.readings).inter_biases[0]
        kernel = 1.0 / (1.0 + np.exp(-(record.states + biases)))
        assert np.abs(mind.rates - kernel)[:20].max() < 1e-6


def test_words_heard_are_the_instruction(records, evolved_agent):
    for record in records:
        mind = mind_of(record, evolved_agent)
        assert Instruction(*mind.heard(0, TASK)) == record.instruction


def test_without_a_genotype_motors_are_what_they_brought_about(records):
    record = records[0]
    mind = mind_of(record, None)
    assert ((mind.motors[:, 0] > 0.5) == (record.turns[:, 0] != 0.0)).all()


def panel(record, genotype, verdicts=(("planar world", True),)):
    return MindPanel(mind_of(record, genotype), record.instruction, "robot", verdicts, record.steps)


def test_the_words_change_visibly_in_a_transition_trial(evolved_agent):
    asked = Instruction(ActionWord.TOUCH, ObjectWord.RED)
    trials = draw_trials([asked], 1, Readings(), np.random.default_rng(3))
    two = np.full(2, 1)
    changes = LabelChanges(
        first_actions=two * ActionWord.INDICATE,
        first_objects=two * ObjectWord.RED,
        later_actions=two * ActionWord.TOUCH,
        later_objects=two * ObjectWord.RED,
        delays=two * CHANGE,
    )
    record = record_one(evolved_agent, replace(trials, changes=changes)[0])
    mind = mind_of(record, evolved_agent)
    heard = [mind.heard(step, TASK)[0] for step in range(mind.steps)]
    assert heard[0] is ActionWord.INDICATE
    assert heard[-1] is ActionWord.TOUCH
    when = heard.index(ActionWord.TOUCH)
    shown = panel(record, evolved_agent)
    before, after = shown.frame(when - 1)[26:62].astype(int), shown.frame(when)[26:62].astype(int)
    changed = (np.abs(before - after).max(axis=-1) > 100).any(axis=0)
    assert changed[176:304].mean() > 0.9  # TOUCH lights up
    assert changed[316:444].mean() > 0.9  # INDICATE goes out
    assert not changed[36:164].any()  # MOVE stays dark


def test_the_ring_is_full_when_the_instruction_is_carried_out(records, evolved_agent):
    record = next(each for each in records if each.success)
    mind = mind_of(record, evolved_agent)
    assert mind.share[0] == 0.0
    assert mind.share[-1] == pytest.approx(1.0)


def test_verdicts_stand_in_the_last_frame_only(records, evolved_agent):
    record = records[0]
    shown = panel(record, evolved_agent)
    place = slice(640, 700), slice(180, 440)
    running, ended = shown.frame(record.steps - 0.6)[place], shown.frame(record.steps)[place]
    assert (running < 80).all(axis=-1).sum() == 0  # no ink
    assert (ended < 80).all(axis=-1).sum() > 100


def test_what_was_never_met_is_marked(evolved_agent):
    badge = slice(120, 152), slice(130, 350)
    for asked, marked in ((("TOUCH", "GREEN"), True), (("TOUCH", "RED"), False)):
        instruction = Instruction(ActionWord[asked[0]], ObjectWord[asked[1]])
        assert instruction in Condition.WITH_INDICATE.instructions
        trials = draw_trials([instruction], 1, Readings(), np.random.default_rng(5))
        picture = panel(record_one(evolved_agent, trials[0]), evolved_agent).frame(0)[badge]
        assert ((picture < 60).all(axis=-1).mean() > 0.3) == marked


def test_the_words_of_a_task_are_shown_one_after_the_other_and_then_none(evolved_agent):
    task = Task(third="both", words="object-first", word_steps=5, held_out=("ignore red",))
    trials = draw_trials(["ignore red"], 1, Readings(), np.random.default_rng(3), task)
    record = record_one(evolved_agent, trials[0])
    mind = mind_of(record, evolved_agent)
    assert [mind.heard(step, task) for step in (0, 4, 5, 9, 10)] == [
        (None, ObjectWord.RED),
        (None, ObjectWord.RED),
        (ActionWord.IGNORE, None),
        (ActionWord.IGNORE, None),
        (None, None),
    ]
    shown = MindPanel(mind, record.instruction, "robot", (), record.steps, task_heard(record))
    action_row = [shown.frame(step)[26:62].astype(int) for step in (2, 7, 12)]
    changed = [(np.abs(one - action_row[0]).max(axis=-1) > 100).any(axis=0) for one in action_row]
    assert changed[1][350:440].mean() > 0.8  # IGNORE, the fourth, lights up
    assert not changed[1][36:300].any()
    assert not changed[2].any()  # and goes out
