"""What was declared: cells that differ from the paper's task in one thing, runs that nobody has run."""

from dataclasses import fields
from itertools import pairwise

import pytest

from arm2d import ActionWord, Condition, Instruction, ObjectWord, Readings, Task
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from evolution.study.beyond.cells import BY_NAME, CELLS, FOUR, GENERATIONS, PAPER, SEEDS, beyond, cell_of
from evolution.study.declared.confirmation.worlds import FRESH_SEEDS, HUNDRED_SEEDS
from evolution.study.declared.parts import factorial
from tests.docs.pages import DOCS

PAGE = (DOCS / "beyond.md").read_text(encoding="utf-8")


def differences(config, paper):
    """What is another value in a run than in one of the paper's task."""
    task = [
        each.name for each in fields(Task) if getattr(config.task, each.name) != getattr(paper, each.name)
    ]
    size = ["inter_neurons"] if config.settings.inter_neurons != 3 else []
    return task + size


@pytest.mark.parametrize("cell", CELLS, ids=lambda cell: cell.name)
def test_a_cell_differs_from_the_paper_s_task_in_one_thing(cell):
    for config in beyond().configs:
        if cell_of(config) == cell:
            paper = Task(third="ignore" if config.task.third == "ignore" else "indicate")
            assert len(differences(config, paper)) == (0 if cell == PAPER else 1)


def test_every_cell_has_twenty_runs_in_both_conditions_but_twelve_instructions():
    configs = beyond().configs
    assert len(configs) == len(set(configs)) == 20 * (9 * 2 + 1)
    for cell in CELLS:
        own = [config for config in configs if cell_of(config) == cell]
        thirds = ["both"] if cell.name == "twelve" else ["indicate", "ignore"]
        assert [sum(config.task.third == third for config in own) for third in thirds] == [20] * len(thirds)
        assert len(own) == 20 * len(thirds)
    assert {config.readings for config in configs} == {Readings()}
    assert {config.settings.generations for config in configs} == {6000}


def test_nobody_has_run_its_seeds():
    used = {*FRESH_SEEDS, *HUNDRED_SEEDS, *(config.seed for config in factorial().configs)}
    assert not used & set(SEEDS)


def test_runs_are_evolved_seed_by_seed():
    seeds = [config.seed for config in beyond().configs]
    assert all(one <= other for one, other in pairwise(seeds))
    assert len(set(seeds[: len(seeds) // 20])) == 1


def test_of_four_held_out_all_words_are_met_and_move_and_touch_with_red_alone():
    for task in BY_NAME["without-four"].tasks:
        assert {str(word).lower() for word in task.held_out} == set(FOUR)
        met = task.experienced
        assert {word.action for word in met} == {*task.actions}
        assert {word.object for word in met} == {*ObjectWord}
        moved = [word for word in met if word.action in (ActionWord.MOVE, ActionWord.TOUCH)]
        assert {word.object for word in moved} == {ObjectWord.RED}


def test_single_instructions_held_out_are_the_paper_s():
    alone = [BY_NAME[name].tasks[0].held_out for name in ("without-move-blue", "without-touch-green")]
    assert sorted(word for (word,) in alone) == sorted(Condition.WITH_INDICATE.held_out)
    assert alone[0] == (Instruction.parse("move blue"),)


def test_the_page_declares_every_cell_and_the_seeds():
    for cell in CELLS:
        assert f"| `{cell.name}` |" in PAGE
    assert f"Seeds {SEEDS[0]} to {SEEDS[-1]}" in PAGE
    assert f"{GENERATIONS} generations" in PAGE
    assert f"**{len(beyond().configs)} runs**" in PAGE


@pytest.mark.parametrize(
    ("task", "size"), [(Task(word_steps=20, words="object-first"), 3), (Condition.WITH_IGNORE, 4)]
)
def test_a_run_of_no_cell_is_named(task, size):
    with pytest.raises(
        ValueError, match=f"no cell has the task {task}.* and {size} inter-neurons".replace("+", ".")
    ):
        cell_of(RunConfig(task, 201, Settings(inter_neurons=size)))
