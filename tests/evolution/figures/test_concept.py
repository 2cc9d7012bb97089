"""The picture on the front page shows the network and the words as they are."""

from matplotlib.colors import to_hex
from matplotlib.patches import Circle, FancyBboxPatch

from arm2d import ObjectWord
from arm2d.constants import N_INPUTS
from arm2d.drawing import OBJECT_COLOURS
from evolution.figures.concept import AGENT, INSTRUCTION, SENSES, concept_figure, example
from evolution.runs.sources import find_agent


def drawn():
    agent = find_agent(AGENT)
    return concept_figure(example(agent.genotype, agent.readings))


def test_there_is_a_circle_for_every_neuron():
    network = drawn().axes[1]
    circles = [patch for patch in network.patches if isinstance(patch, Circle)]
    assert sum(sense.inputs for sense in SENSES) == N_INPUTS
    assert len(circles) == N_INPUTS + 3 + 4


def test_the_words_of_the_instruction_are_lit_and_no_other():
    network = drawn().axes[1]
    boxes = [patch for patch in network.patches if isinstance(patch, FancyBboxPatch)]
    lit = [to_hex(box.get_facecolor()) for box in boxes if to_hex(box.get_facecolor()) != "#ffffff"]
    assert len(boxes) == 6
    assert len(lit) == 2
    assert INSTRUCTION == "touch green"
    assert lit[1] == to_hex(OBJECT_COLOURS[ObjectWord.GREEN])


def test_the_target_is_not_touched_yet_where_the_arm_is_shown():
    agent = find_agent(AGENT)
    record = example(agent.genotype, agent.readings)
    assert (record.contact[:, ObjectWord.GREEN] != 0).any()
    assert not record.contact[0].any()
