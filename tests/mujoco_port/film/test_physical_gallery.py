"""Nine trials of an acting robot side by side: two verdicts in each cell."""

from dataclasses import replace

import pytest

from evolution.agents.recording import record_instruction
from evolution.runs.sources import find_agent
from mujoco_port.film.gallery import CELL_WIDTH, CLOCK, STRIP, VIEW_HEIGHT, cell_pictures
from mujoco_port.film.physical_port import port_physical_gallery, start_of
from mujoco_port.film.quality import QUALITIES
from mujoco_port.film.stage import Stage
from mujoco_port.film.take import physical_take


@pytest.fixture(scope="module")
def agent():
    return find_agent("best-generaliser")


@pytest.fixture(scope="module")
def record(agent):
    move_blue = next(each for each in agent.condition.instructions if str(each) == "MOVE Blue")
    return record_instruction(agent, move_blue, "right", 0)


@pytest.fixture(scope="module")
def stage(robot):
    with Stage(robot, CELL_WIDTH, VIEW_HEIGHT, QUALITIES["draft"]) as stage:
        yield stage


def last_clock(take, stage):
    """The corner of a cell in which time and verdicts stand, when the trial has ended."""
    moments = [0, len(take.steps) - 1]
    short = replace(
        take,
        steps=take.steps[moments],
        angles=take.angles[moments],
        objects=take.objects[moments],
        touched=take.touched[moments],
        planar=take.planar[moments],
        head=None if take.head is None else take.head[moments],
    )
    *_, cell = cell_pictures(short, stage)
    return cell[4 : STRIP - 4, CELL_WIDTH - CLOCK : -4].astype(int)


def test_a_cell_ends_with_the_verdicts_of_both_worlds(agent, record, stage, lab):
    physical, verdict = lab.open_loop(agent.genotype, start_of(record), record.readings)
    take = physical_take(record, physical, verdict)
    both = last_clock(take, stage)
    one = last_clock(replace(take, verdicts=take.verdicts[:1]), stage)
    other = last_clock(replace(take, verdicts=(*take.verdicts[:1], ("robot", not verdict.success))), stage)
    assert (both < 128).all(axis=-1).sum() > (one < 128).all(axis=-1).sum()
    assert (both != other).any()
    assert (both[:, :2] > 200).all()  # nothing is cut off


def test_too_few_trials_are_refused_before_any_is_carried_out(agent, record, tmp_path):
    with pytest.raises(ValueError, match="a gallery has 9 trials, not 1; give one per instruction"):
        port_physical_gallery([record], agent.genotype, "one", tmp_path / "gallery.mp4")
    assert not any(tmp_path.iterdir())
