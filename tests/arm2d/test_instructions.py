"""Words, instructions and conditions."""

import pytest

from arm2d import NON_EXPERIENCED, ActionWord, Condition, Instruction, ObjectWord


@pytest.mark.parametrize("text", ["touch green", "TOUCH Green", "  Touch   GREEN "])
def test_instruction_is_read_in_any_case(text):
    assert Instruction.parse(text) == Instruction(ActionWord.TOUCH, ObjectWord.GREEN)


def test_printed_instruction_reads_back():
    for condition in Condition:
        for instruction in condition.instructions:
            assert Instruction.parse(str(instruction)) == instruction


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("grasp green", "unknown action word 'grasp'; this world knows move, touch, indicate, ignore"),
        ("touch yellow", "unknown object word 'yellow'; this world knows blue, green, red"),
        ("touch", "instruction 'touch' has 1 words, not two"),
        ("", "instruction '' has 0 words, not two"),
    ],
)
def test_unknown_words_list_the_known_ones(text, message):
    with pytest.raises(ValueError, match=message):
        Instruction.parse(text)


def test_each_condition_has_nine_instructions_of_which_two_are_never_met():
    for condition in Condition:
        assert len(set(condition.instructions)) == 9
        assert set(condition.instructions) - set(condition.experienced) == set(NON_EXPERIENCED)


def test_third_action_is_experienced_with_all_three_objects():
    for condition in Condition:
        third = [each for each in condition.experienced if each.action is condition.third_action]
        assert len(third) == 3


@pytest.mark.parametrize("text", ["With-Indicate", "with_indicate", "WITH INDICATE"])
def test_condition_is_read_in_any_case(text):
    assert Condition.parse(text) is Condition.WITH_INDICATE


def test_unknown_condition_lists_the_known_ones():
    with pytest.raises(
        ValueError, match="unknown condition 'with-grasp'; there are with-indicate, with-ignore"
    ):
        Condition.parse("with-grasp")
