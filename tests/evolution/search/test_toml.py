"""Values read from a file: refused in one sentence unless they are of the kind that is asked for."""

import pytest

from evolution.search.toml import (
    DEEPEST,
    KINDS,
    LONGEST_TEXT,
    MOST_POINTS,
    check_keys,
    one_of_kind,
    read_toml,
    table_of,
)

EXAMPLES = {bool: True, int: 7, str: "seven"}


def test_every_kind_has_an_example_here():
    assert KINDS.keys() == EXAMPLES.keys()


@pytest.mark.parametrize("kind", EXAMPLES)
@pytest.mark.parametrize("value", [*EXAMPLES.values(), 7.0, None, [7], {}], ids=repr)
def test_a_value_of_its_kind_is_given_back_and_any_other_refused(kind, value):
    """True is a whole number to Python, not to us."""
    if type(value) is kind:
        assert one_of_kind("runs", value, kind) is value
    else:
        with pytest.raises(ValueError, match=r"^runs = .* must be ") as refused:
            one_of_kind("runs", value, kind)
        assert str(refused.value) == f"runs = {value!r} must be {KINDS[kind]}"


def test_an_unknown_key_is_told_with_the_nearest_and_with_all_that_are_known():
    check_keys("key", {"seed": 1}, ["seed", "runs"], " in [grid]")
    with pytest.raises(
        ValueError, match=r"^unknown key 'sead' in \[grid\]; did you mean seed\? there are seed, runs$"
    ):
        check_keys("key", {"seed": 1, "sead": 1}, ["seed", "runs"], " in [grid]")
    with pytest.raises(ValueError, match=r"^unknown key 'xyz'; there are seed, runs$"):
        check_keys("key", {"xyz": 1}, ["seed", "runs"])


def test_a_text_just_within_every_bound_is_read():
    deepest = "x = " + "[" * (DEEPEST - 1) + "]" * (DEEPEST - 1)
    assert read_toml(deepest) == {"x": brackets(DEEPEST - 1)}
    points = "# " + "." * MOST_POINTS
    assert read_toml(points) == {}
    assert read_toml("#".ljust(LONGEST_TEXT)) == {}


def brackets(n):
    """A list in a list in a list, n of them."""
    return [] if n == 1 else [brackets(n - 1)]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("x = " + "[" * DEEPEST + "]" * DEEPEST, "its values are nested deeper than 8 levels"),
        ("x = " + "[" * 9_000, "its values are nested deeper than 8 levels"),
        ("# " + "." * (MOST_POINTS + 1), "a line has more than 2,000 points; break it up"),
        ("#".ljust(LONGEST_TEXT + 1), "it is longer than 32,768 characters"),
        ("x =", "this is not TOML: Invalid value"),
    ],
    ids=["deep", "too deep for the parser", "points", "long", "not TOML"],
)
def test_a_text_beyond_a_bound_is_refused_in_one_sentence(text, sentence):
    with pytest.raises(ValueError, match=f"^{sentence}"):
        read_toml(text)


def test_a_table_is_given_back_and_anything_else_refused():
    assert table_of("grid", {"seed": 1}) == {"seed": 1}
    for value in (1, "text", [1]):
        with pytest.raises(ValueError, match=r"must be a table, such as \[grid\]"):
            table_of("grid", value)
