"""docs/ledger.md against arm2d.Readings: it cannot drift."""

import json
import re
from dataclasses import fields, replace
from pathlib import Path

import pytest

from arm2d import Readings
from arm2d.readings import choices
from tests.evolution.runs.golden import ALTERNATIVES

PAGE = (Path(__file__).parents[1] / "docs" / "ledger.md").read_text(encoding="utf-8")
ROWS = {
    name: values
    for name, _, values, _ in re.findall(r"^\| `(\w+)` \| (.*?) \| (.*?) \| (.*?) \|$", PAGE, re.MULTILINE)
}


def test_every_reading_has_one_row_in_the_order_of_the_record():
    assert list(ROWS) == [each.name for each in fields(Readings)]


@pytest.mark.parametrize("name", list(ROWS))
def test_bold_value_is_the_default(name):
    (bold,) = re.findall(r"\*\*(.*?)\*\*", ROWS[name])
    default = getattr(Readings(), name)
    shown = ", ".join(map(str, default)) if isinstance(default, tuple) else str(default)
    assert bold == shown


@pytest.mark.parametrize("name", sorted(set(ROWS) - set(choices())))
def test_every_listed_number_can_be_chosen(name):
    alternatives = re.findall(r"`([^`]+)`", ROWS[name])
    assert alternatives
    for text in alternatives:
        numbers = [float(part) for part in text.split(",")]
        Readings.from_mapping({name: numbers if name == "sector_centres" else numbers[0]})


def test_page_names_what_the_printed_preset_changes():
    default, printed = Readings(), Readings.preset("printed")
    assert replace(printed, ignore_stops=default.ignore_stops) == default
    assert "differs from the default in `ignore_stops` alone" in " ".join(PAGE.split())


@pytest.mark.parametrize("name", list(choices()))
def test_words_listed_are_the_words_that_can_be_chosen(name):
    listed = re.findall(r"\*\*(\w+)\*\*|`(\w+)`", ROWS[name])
    assert {bold or plain for bold, plain in listed} == set(choices()[name])


def test_every_row_gives_words_of_the_article_and_a_reason():
    for row in re.findall(r"^\| `\w+` \|.*$", PAGE, re.MULTILINE):
        cells = [cell.strip() for cell in row.strip("|").split("|")]
        assert len(cells) == 4
        assert all(cells), row


def test_every_listed_alternative_is_in_the_golden_record():
    recorded = json.loads(json.dumps(ALTERNATIVES))
    for name, values in ROWS.items():
        texts = re.findall(r"`([^`]+)`", values)
        numbers = [[float(part) for part in text.split(",")] for text in texts if name not in choices()]
        listed = texts if name in choices() else [each if len(each) > 1 else each[0] for each in numbers]
        assert recorded[name] == listed, name
