"""What a viewer sends: orders are understood, all else is answered in a sentence."""

import json
import re
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm2d import ActionWord, Instruction, ObjectWord
from mujoco_port.live.orders import KINDS, Again, Loop, Place, Reset, Run, Say, Speed, read_order

ORDERS = {
    '{"do": "say", "words": "Touch GREEN"}': Say.both(Instruction.parse("touch green")),
    '{"do": "say", "words": "MOVE"}': Say(ActionWord.MOVE, None),
    '{"do": "say", "words": " red "}': Say(None, ObjectWord.RED),
    '{"do": "place", "object": "red", "x": -120, "y": 90.5}': Place(ObjectWord.RED, -120.0, 90.5),
    '{"do": "reset", "area": "left", "seed": 12}': Reset("left", 12),
    '{"do": "reset", "area": "left"}': Reset("left", None),
    '{"do": "reset", "seed": 0}': Reset(None, 0),
    '{"do": "loop", "closed": true}': Loop(True),
    '{"do": "run", "on": false}': Run(False),
    '{"do": "again"}': Again(),
    '{"do": "speed", "factor": 0.25}': Speed(0.25),
}


@pytest.mark.parametrize(("text", "order"), ORDERS.items())
def test_an_order_is_understood(text, order):
    assert read_order(text) == order


def test_every_kind_of_order_is_tried_here():
    assert {json.loads(text)["do"] for text in ORDERS} == set(KINDS)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (b"\x00\xff", "an order is text of at most 1000 characters"),
        ("x" * 1001, "an order is text of at most 1000 characters"),
        ("hello", "an order is a JSON object"),
        ("[" * 1000, "an order is a JSON object"),
        ("[1]", "an order is a JSON object"),
        ("{}", "an order does one of: say, place, reset, loop, run, again, speed"),
        ('{"do": ["say"]}', "an order does one of: say, place, reset, loop, run, again, speed"),
        ('{"do": "say", "words": 3}', 'words are text, such as "touch green"'),
        ('{"do": "say", "words": "eat green"}', "unknown action word 'eat'; this world knows"),
        ('{"do": "place", "object": "table", "x": 0, "y": 0}', "an object is blue, green or red"),
        ('{"do": "place", "object": "red", "x": NaN, "y": 0}', "x is a number"),
        ('{"do": "place", "object": "red", "x": 1, "y": true}', "y is a number"),
        (f'{{"do": "place", "object": "red", "x": {"9" * 400}, "y": 0}}', "x is a number"),
        ('{"do": "reset", "area": "middle", "seed": 0}', "an area is right or left"),
        ('{"do": "reset", "area": ["right"], "seed": 0}', "an area is right or left"),
        ('{"do": "reset", "area": "right", "seed": -1}', "a seed is a whole number from 0 to 4294967295"),
        ('{"do": "reset", "area": "right", "seed": 1.5}', "a seed is a whole number from 0 to 4294967295"),
        ('{"do": "speed", "factor": 100}', "a speed is one of 0.25, 0.5, 1, 2, 4"),
        ('{"do": "run"}', "on is true or false"),
        ('{"do": "loop", "closed": 1}', "closed is true or false"),
    ],
)
def test_what_is_no_order_is_answered_in_a_sentence(text, sentence):
    with pytest.raises(ValueError, match=re.escape(sentence)) as refusal:
        read_order(text)
    assert str(refusal.value).startswith(sentence)


ANYTHING = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=9),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)
FIELDS = st.sampled_from(["words", "object", "x", "y", "area", "seed", "closed", "on", "factor"])


@given(st.text() | st.binary(), st.sampled_from(list(KINDS)), st.dictionaries(FIELDS, ANYTHING))
def test_nonsense_ends_in_nothing_but_a_refusal(nonsense, kind, fields):
    for text in (nonsense, json.dumps({**fields, "do": kind})):
        with suppress(ValueError):
            assert type(read_order(text)).__module__ == "mujoco_port.live.orders"
