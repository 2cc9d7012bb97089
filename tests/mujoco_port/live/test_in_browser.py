"""The page in a real browser, in which the processor draws what a graphics card would."""

import json

import pytest

from tests.browser import NEEDS_BROWSER, Browser
from tests.mujoco_port.live.serving import Served

pytestmark = [NEEDS_BROWSER, pytest.mark.slow]

DRAWN = "window.wordarmLive && wordarmLive.drawn > 0"


@pytest.fixture(scope="module")
def served():
    with Served("--trial-seed=3") as served:
        yield served


@pytest.fixture(scope="module")
def started(tmp_path_factory):
    with Browser(tmp_path_factory.mktemp("chromium"), webgl=True) as browser:
        yield browser


@pytest.fixture
def browser(started, served):
    """The page just opened, and afterwards the proof that it said nothing and asked nobody else."""
    started.messages.clear()
    started.requests.clear()
    started.open(served.address, width=1000, height=600)
    started.wait_for(DRAWN)
    yield started
    started.click("#again")
    says(started, "Ready to")
    assert started.messages == []
    assert all(each.startswith((served.address, "data:")) for each in started.requests)


def choose(browser, selector, value):
    """Choose what a list offers, as a hand would."""
    browser.evaluate(
        f"(() => {{ const list = document.querySelector({json.dumps(selector)});"
        f"list.value = {json.dumps(value)};"
        "list.dispatchEvent(new Event('change')); })()"
    )


def says(browser, words):
    browser.wait_for(f"document.getElementById('now').textContent.includes({json.dumps(words)})")


def test_words_are_clicked_and_both_verdicts_are_read(browser):
    choose(browser, "#speed", "4")
    browser.click(".pill.move span")
    browser.click(".pill.red span")
    says(browser, "Ready to MOVE Red")
    browser.click("#run")
    says(browser, "MOVE Red is over")
    moved = "✓ Robot: carried out✓ Planar arm: carried out"
    assert browser.text("#judges") == moved
    assert float(browser.text("#clock").removesuffix(" s")) > 3.0
    # What becomes of the next word is open: the arm is amid the objects. To carry it out takes ten seconds.
    choose(browser, "#speed", "1")
    browser.click(".pill.indicate span")
    says(browser, "INDICATE Red")
    assert browser.text("#judges") != moved


def test_news_from_before_a_click_does_not_take_it_back(browser):
    browser.evaluate(
        "(() => { const word = (value) => document.querySelector(`input[value=${value}]`);"
        "word('MOVE').click(); word('TOUCH').checked = true; word('BLUE').click(); })()"
    )
    says(browser, "Ready to MOVE Blue")


def test_an_object_is_dragged_over_the_table(browser):
    drawn = browser.evaluate("wordarmLive.drawn")
    browser.click('[data-view="above"]')
    browser.wait_for(f"wordarmLive.drawn > {drawn}")
    before = browser.evaluate("wordarmLive.where('green')")
    x, y = browser.evaluate("wordarmLive.inWindow('green')")
    browser.drag((x, y), (x + 60, y - 10))
    browser.wait_for(f"Math.abs(wordarmLive.where('green')[0] - {before[0]}) > 0.01")
    after = browser.evaluate("wordarmLive.where('green')")
    assert after[0] < before[0]  # the robot's right is on the left


def test_what_stands_still_is_drawn_as_finely_as_the_screen_shows_it(browser):
    """While it moves a processor draws fewer pixels."""
    canvas = "document.getElementById('stage')"
    browser.click('[data-view="front"]')
    browser.wait_for(f"{canvas}.width === {canvas}.clientWidth")


def test_another_start_and_the_closed_loop_are_chosen(browser):
    clock = browser.evaluate("document.getElementById('seed').value")
    browser.click("#shuffle")
    browser.wait_for(f"document.getElementById('seed').value === '{int(clock) + 1}'")
    choose(browser, "#loop", "closed")
    browser.wait_for("document.getElementById('loop-note').textContent.includes('answered a tenth')")
    choose(browser, "#loop", "open")
    choose(browser, "#area", "left")
    browser.wait_for("document.getElementById('area').value === 'left'")
    browser.click("#run")
    browser.wait_for("parseFloat(document.getElementById('clock').textContent) > 0.2")


@pytest.mark.parametrize("width", [360, 1280])
def test_it_fits_and_everything_has_a_name_and_enough_contrast(browser, served, width):
    for scheme in ("light", "dark"):
        browser.open(served.address, width=width, height=740, scheme=scheme)
        browser.wait_for(DRAWN)
        assert browser.evaluate("document.documentElement.scrollWidth") <= width
        assert browser.faint_texts() == []
    nameless = [
        role for role, name in browser.named() if role in ("button", "radio", "combobox") and not name
    ]
    assert nameless == []
