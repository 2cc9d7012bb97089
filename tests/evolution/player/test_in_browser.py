"""The page in a real browser, opened from disk: with mouse, finger, keyboard and a screen reader's eyes."""

import re
from pathlib import Path

import pytest

from tests.browser import NEEDS_BROWSER, Browser

pytestmark = NEEDS_BROWSER

PAGE = Path(__file__).parents[3] / "docs" / "play" / "index.html"
VERDICT, CLOCK, STAGE = '[data-part="verdict"]', '[data-part="clock"]', ".wa-stage"
NOT_COUNTING = "!document.querySelector('[data-part=count]').disabled"


@pytest.fixture(scope="module")
def started(tmp_path_factory):
    with Browser(tmp_path_factory.mktemp("chromium")) as browser:
        yield browser


@pytest.fixture
def browser(started):
    """The page just opened, and afterwards the proof that it said nothing and asked for nothing."""
    started.messages.clear()
    started.requests.clear()
    started.open(PAGE)
    yield started
    assert started.messages == []
    assert all(each.startswith(("file://", "blob:null/", "data:")) for each in started.requests)


def word(text):
    """The selector of a word to be said."""
    return f".wa-pill.wa-{text.lower()} span"


def to_the_end(browser):
    """Let the trial run to its end at once."""
    browser.evaluate("document.querySelector('[data-part=time]').focus()")
    browser.press("End")


def seconds(browser):
    return float(browser.text(CLOCK).removesuffix(" s"))


def test_words_are_clicked_and_the_verdict_is_read(browser):
    browser.click(word("TOUCH"))
    browser.click(word("Red"))
    to_the_end(browser)
    assert browser.text(VERDICT).startswith("Done: TOUCH Red carried out in ")
    browser.click(word("INDICATE"))
    browser.click('[data-part="restart"]')
    assert browser.text(VERDICT) == "Ready to INDICATE Red."
    to_the_end(browser)
    assert browser.text(VERDICT).startswith("Done: INDICATE Red carried out in ")


def test_words_light_while_they_are_heard_and_change_in_mid_trial(browser):
    browser.evaluate(f"document.querySelector('{STAGE}').focus()")
    browser.press(" ")
    browser.wait_for(f"parseFloat(document.querySelector('{CLOCK}').textContent) > 1")
    browser.press("m")
    browser.press(" ")
    stopped = seconds(browser)
    assert stopped > 1
    assert browser.text(".wa-heard") == "MOVERed"
    assert (
        browser.evaluate("[...document.querySelectorAll('.wa-lit')].map((e) => e.textContent).join()")
        == "MOVE,Red"
    )
    browser.press("Home")
    browser.press("ArrowRight")
    assert seconds(browser) == 0.1
    to_the_end(browser)
    assert browser.text(VERDICT).startswith("Done: MOVE Red carried out in ")
    assert browser.evaluate("document.querySelectorAll('.wa-lit').length") == 0


def test_objects_are_dragged_and_moved_by_keys(browser):
    place = "document.querySelector('.wa-disc.wa-blue').getAttribute('aria-valuenow')"
    x, y = browser.place(".wa-disc.wa-blue .wa-body")
    browser.drag((x, y), (x - 5, y + 90))
    dragged = float(browser.evaluate(place))
    assert dragged < 25
    browser.evaluate("document.querySelector('.wa-disc.wa-blue').focus()")
    browser.press("ArrowLeft")
    assert float(browser.evaluate(place)) == dragged + 2
    assert seconds(browser) == 0


def test_finger_drags_an_object_on_a_phone(browser):
    browser.open(PAGE, width=360)
    place = "document.querySelector('.wa-disc.wa-green').getAttribute('aria-valuenow')"
    before = float(browser.evaluate(place))
    x, y = browser.place(".wa-disc.wa-green .wa-body")
    browser.swipe((x, y), (x + 40, y + 10))
    assert float(browser.evaluate(place)) < before - 10


def test_start_agent_word_and_neuron_are_chosen(browser):
    browser.evaluate("document.querySelector('[data-part=start]').focus()")
    browser.press("Home")
    assert browser.text('[data-part="start-text"]') == "120° to the right"
    browser.evaluate("document.querySelector('[data-part=agent]').focus()")
    browser.press("End")
    assert browser.text('[data-part="actions"] .wa-pills') == "MOVETOUCHIGNORE"
    browser.click('[data-part="mute-object"]')
    browser.click(".wa-trace:nth-of-type(2) .wa-mute")
    assert "Silenced in yours: the object word, neuron 2." in browser.text('[data-part="census-lead"]')
    to_the_end(browser)
    flat = "new Set(document.querySelectorAll('.wa-curve')[1].getAttribute('d').match(/ [\\d.]+/g)).size"
    assert browser.evaluate(flat) == 1


def test_eighty_tries_are_counted_in_a_worker_and_painted(browser):
    browser.click('[data-part="count"]')
    browser.wait_for(f"{NOT_COUNTING} && document.querySelector('[data-part=tally]').textContent !== ''")
    counts = browser.evaluate(
        "[...document.querySelectorAll('.wa-map button b')].map((e) => Number(e.textContent))"
    )
    assert len(counts) == 9
    assert browser.text('[data-part="tally"]').startswith(f"{sum(counts)} of 720 tries carried out")
    framed = "[...document.querySelectorAll('.wa-never')].map((e) => e.getAttribute('aria-label')).join()"
    assert re.findall(r"(\w+ \w+), never practised", browser.evaluate(framed)) == ["MOVE Blue", "TOUCH Green"]
    assert (
        browser.evaluate(
            "new Set([...document.querySelectorAll('.wa-map button')].map((e) => e.style.background)).size"
        )
        > 1
    )
    browser.click(".wa-map tr:nth-child(3) td:nth-child(3) button")
    assert browser.text(".wa-heard") == "INDICATEGreen"


# Objects' names that stick out of the picture or lie on their disc.
NAMES_CUT_OFF = """[...document.querySelectorAll('.wa-disc')].filter((disc) => {
  const name = disc.querySelector('.wa-name').getBoundingClientRect();
  const body = disc.querySelector('.wa-body').getBoundingClientRect();
  const stage = disc.closest('svg').getBoundingClientRect();
  const beside = name.right <= body.left || name.left >= body.right;
  const apart = beside || name.bottom <= body.top || name.top >= body.bottom;
  return !apart || name.left < stage.left || name.right > stage.right || name.top < stage.top;
}).map((disc) => disc.getAttribute('aria-label'))"""


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [360, 1280])
def test_page_can_be_read_in_every_light_and_width(browser, scheme, width):
    browser.open(PAGE, width=width, scheme=scheme)
    assert browser.evaluate("document.documentElement.scrollWidth") <= width
    assert browser.faint_texts() == []
    assert browser.evaluate(NAMES_CUT_OFF) == []
    if width < 600:
        browser.tap(word("Green"))
    else:
        browser.click(word("Green"))
    to_the_end(browser)
    assert "TOUCH Green" in browser.text(VERDICT)
    browser.click('[data-part="count"]')
    browser.wait_for(f"{NOT_COUNTING} && document.querySelector('[data-part=tally]').textContent !== ''")
    # Colours fade in.
    browser.evaluate("Promise.all(document.getAnimations().map((each) => each.finished)).then(() => 0)")
    assert browser.faint_texts() == []


def test_everything_that_can_be_operated_has_a_name_for_a_screen_reader(browser):
    named = browser.named()
    roles = {"button", "radio", "slider", "combobox", "image", "group", "table"}
    assert [role for role, name in named if role in roles and not name] == []
    assert {"TOUCH", "Red", "Blue object", "silence neuron 2", "Time", "Speed"} <= {name for _, name in named}
    assert any(role == "image" and name.startswith("What it senses: nothing seen") for role, name in named)
    assert browser.evaluate(f"document.querySelector('{VERDICT}').getAttribute('aria-live')") == "polite"


def test_arm_moves_by_itself_only_for_readers_who_like_motion(browser):
    assert browser.text('[data-part="play-text"]') == "Play"
    browser.open(PAGE, motion=True)
    browser.wait_for(f"parseFloat(document.querySelector('{CLOCK}').textContent) > 0.5")
