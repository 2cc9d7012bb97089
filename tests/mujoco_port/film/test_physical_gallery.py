"""Nine trials of an acting robot side by side: two verdicts in each cell."""

from dataclasses import replace

import numpy as np
import pytest

from arm2d import Instruction, Readings, draw_trials, run_trials
from evolution.agents.recording import record_instruction
from evolution.commands.port import headline
from evolution.runs.sources import find_agent
from evolution.search.randomness import Purpose, generator
from mujoco_port.acting.lab import Lab
from mujoco_port.film import gallery
from mujoco_port.film.gallery import CELL_WIDTH, CLOCK, RATE_BAR, STRIP, VIEW_HEIGHT, cell_pictures, strip
from mujoco_port.film.physical_port import port_physical_gallery, start_of
from mujoco_port.film.quality import QUALITIES
from mujoco_port.film.stage import Stage
from mujoco_port.film.take import kinematic_take, physical_take


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


def test_a_cell_ends_with_the_verdicts_of_both_worlds(agent, record, stage, robot):
    lab = Lab(robot, record.readings)
    physical, verdict = lab.open_loop(agent.genotype, start_of(record), record.readings)
    take = physical_take(record, physical, verdict)
    both = last_clock(take, stage)
    one = last_clock(replace(take, verdicts=take.verdicts[:1]), stage)
    other = last_clock(replace(take, verdicts=(*take.verdicts[:1], ("robot", not verdict.success))), stage)
    assert (both < 128).all(axis=-1).sum() > (one < 128).all(axis=-1).sum()
    assert (both != other).any()
    assert (both[:, :2] > 200).all()  # nothing is cut off


@pytest.mark.parametrize("draw", [lambda *told: next(gallery.frames(*told)), gallery.last_moments])
def test_a_gallery_shines_with_the_world_of_its_trials(draw, record, robot, monkeypatch):
    world = replace(record.readings, start_half_width=6.0, camera_origin="end")
    assert world != Readings()
    take = kinematic_take(replace(record, readings=world), robot, 0.1)
    built = []

    class Draft(Stage):
        def __init__(self, *told):
            built.append(told[4])
            super().__init__(*told[:3], QUALITIES["draft"], *told[4:])

    monkeypatch.setattr(gallery, "Stage", Draft)
    draw([take], robot, "one")
    assert built == [world]


@pytest.mark.parametrize("rate", [0.0, 0.4625, 1.0])
def test_the_bar_of_a_cell_is_as_long_as_its_rate(rate):
    left, width = (round(share * (CELL_WIDTH - CLOCK)) for share in RATE_BAR)
    told = strip(Instruction.parse("touch green"), rate)
    bar = (told[STRIP // 2, left : left + width] < 128).all(axis=-1)
    assert bar.sum() == pytest.approx(rate * width, abs=2)
    assert bar[: int(bar.sum())].all()


def test_a_gallery_counts_trials_from_both_areas_not_those_shown():
    agent = find_agent("best-specialist")  # which fails two instructions
    title, rates = headline(agent, agent.condition)
    trials = draw_trials(agent.condition.instructions, 40, agent.readings, generator(0, Purpose.EVALUATION))
    success = run_trials(agent.genotype, trials, agent.readings).success.reshape(9, 80)
    np.testing.assert_array_equal(rates, success.mean(axis=1))
    number = sum(int(row.sum()) > 60 for row in success)
    assert 0 < number < 9
    assert f": {number} of nine instructions succeed in more than 75 % of 80 trials" in title


@pytest.mark.parametrize("rates", [[1.0] * 8, [1.0] * 8 + [1.01], [1.0] * 8 + [float("nan")]])
def test_rates_that_are_none_are_refused(agent, record, rates, tmp_path):
    with pytest.raises(ValueError, match="are not 9 shares from 0 to 1; give one per instruction"):
        port_physical_gallery([record] * 9, agent.genotype, "nine", tmp_path / "gallery.mp4", rates=rates)
    assert not any(tmp_path.iterdir())


def test_too_few_trials_are_refused_before_any_is_carried_out(agent, record, tmp_path):
    with pytest.raises(ValueError, match="a gallery has 9 trials, not 1; give one per instruction"):
        port_physical_gallery([record], agent.genotype, "one", tmp_path / "gallery.mp4")
    assert not any(tmp_path.iterdir())
