"""docs/ledger.md against arm2d.Readings: it cannot drift."""

import json
import re
from dataclasses import fields, replace
from pathlib import Path

import pytest

from arm2d import Readings
from arm2d.readings import PLAIN, choices
from tests.evolution.runs.golden import ALTERNATIVES

PAGE = (Path(__file__).parents[1] / "docs" / "ledger.md").read_text(encoding="utf-8")
ROWS = {
    name: values
    for name, _, values, _ in re.findall(r"^\| `(\w+)` \| (.*?) \| (.*?) \| (.*?) \|$", PAGE, re.MULTILINE)
}


def test_every_reading_has_one_row_in_the_order_of_the_record():
    assert list(ROWS) == [each.name for each in fields(Readings)]


def values_of(name):
    """The values that a row lists, in their order, as they would stand in a config."""
    texts = [bold or other for bold, other in re.findall(r"\*\*(.+?)\*\*|`([^`]+)`", ROWS[name])]
    if name in choices():
        return texts
    numbers = [[float(part) for part in text.split(",")] for text in texts]
    return [each if len(each) > 1 else each[0] for each in numbers]


def in_config(readings, name):
    return readings.to_mapping()[name]


@pytest.mark.parametrize("name", list(ROWS))
def test_bold_value_is_the_default(name):
    (bold,) = re.findall(r"\*\*(.*?)\*\*", ROWS[name])
    default = getattr(Readings(), name)
    shown = ", ".join(map(str, default)) if isinstance(default, tuple) else str(default)
    assert bold == shown


@pytest.mark.parametrize("name", list(ROWS))
def test_first_value_is_the_plain_one(name):
    assert values_of(name)[0] == in_config(PLAIN, name)


@pytest.mark.parametrize("name", list(ROWS))
def test_every_listed_value_can_be_chosen(name):
    assert len(values_of(name)) > 1
    for value in values_of(name):
        assert in_config(Readings.from_mapping({name: value}), name) == value


def test_page_names_what_the_printed_preset_changes():
    printed = Readings.preset("printed")
    assert replace(printed, ignore_stops=PLAIN.ignore_stops) == PLAIN
    assert "differs from the plain readings in `ignore_stops` alone" in " ".join(PAGE.split())


@pytest.mark.parametrize("name", list(choices()))
def test_words_listed_are_the_words_that_can_be_chosen(name):
    assert values_of(name) == list(choices()[name])


def test_every_row_gives_words_of_the_article_and_a_reason():
    for row in re.findall(r"^\| `\w+` \|.*$", PAGE, re.MULTILINE):
        cells = [cell.strip() for cell in row.strip("|").split("|")]
        assert len(cells) == 4
        assert all(cells), row


@pytest.mark.parametrize("name", list(ROWS))
def test_every_alternative_to_the_plain_one_is_in_the_golden_record(name):
    recorded = json.loads(json.dumps(ALTERNATIVES))
    assert recorded[name] == values_of(name)[1:]
