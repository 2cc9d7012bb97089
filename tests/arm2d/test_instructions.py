"""Words, instructions and conditions."""

import pytest

from arm2d import NON_EXPERIENCED, ActionWord, Condition, Instruction, ObjectWord
from arm2d.instructions import ACTION_CODES, OBJECT_CODES, instructions_of


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


@pytest.mark.parametrize("words", [("touch", "green"), (1, 1), (ObjectWord.GREEN, ActionWord.TOUCH)])
def test_an_instruction_is_made_of_the_words_themselves(words):
    with pytest.raises(
        ValueError, match=r"an ActionWord and an ObjectWord, not .*read by Instruction\.parse$"
    ):
        Instruction(*words)


def test_one_instruction_or_several_are_taken_as_text_or_as_records():
    touch, move = Instruction.parse("touch green"), Instruction.parse("move red")
    assert instructions_of("touch green") == instructions_of(touch) == [touch]
    assert instructions_of(("touch green", move)) == [touch, move]
    for wrong in (5, None, [5], ["touch green", 5], [["touch", "green"]]):
        with pytest.raises(ValueError, match="is no instruction; give text such as 'touch green'"):
            instructions_of(wrong)


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


def test_words_are_heard_as_the_paper_writes_them():
    """Spec section 4; two of three bits are on in each, and only INDICATE and IGNORE sound alike."""
    objects = {word.name: "".join(map(str, code)) for word, code in OBJECT_CODES.items()}
    actions = {word.name: "".join(map(str, code)) for word, code in ACTION_CODES.items()}
    assert objects == {"BLUE": "110", "GREEN": "101", "RED": "011"}
    assert actions == {"MOVE": "011", "TOUCH": "101", "INDICATE": "110", "IGNORE": "110"}


def test_codes_of_words_are_those_of_files_written_long_ago():
    assert [word.name for word in sorted(ActionWord)] == ["MOVE", "TOUCH", "INDICATE", "IGNORE"]
    assert [word.name for word in sorted(ObjectWord)] == ["BLUE", "GREEN", "RED"]
    assert [*map(int, ActionWord), *map(int, ObjectWord)] == [0, 1, 2, 3, 0, 1, 2]


def test_never_met_are_touch_green_and_move_blue_alone():
    assert {str(each) for each in NON_EXPERIENCED} == {"TOUCH Green", "MOVE Blue"}


def test_instructions_come_action_by_action_in_the_order_of_their_codes():
    for condition, third in ((Condition.WITH_INDICATE, "INDICATE"), (Condition.WITH_IGNORE, "IGNORE")):
        said = [str(each) for each in condition.instructions]
        assert said == [f"{a} {o}" for a in ("MOVE", "TOUCH", third) for o in ("Blue", "Green", "Red")]
        assert sorted(condition.instructions) == list(condition.instructions)


def test_instruction_shows_how_it_can_be_made():
    for instruction in Condition.WITH_IGNORE.instructions:
        assert repr(instruction) == f"Instruction.parse({str(instruction).lower()!r})"
