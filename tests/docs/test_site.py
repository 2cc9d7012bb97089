"""The site, built as `make docs` builds it and opened from disk."""

import os
from pathlib import Path

import pytest
from mkdocs.commands.build import build
from mkdocs.config import load_config

from evolution.cli import COMMANDS
from tests.browser import NEEDS_BROWSER, Browser
from tests.docs.pages import ROOT

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    """Its folder."""
    folder = tmp_path_factory.mktemp("site")
    before = Path.cwd()
    os.chdir(ROOT)
    try:
        # Any warning ends it.
        build(load_config(str(ROOT / "mkdocs.yml"), site_dir=str(folder), strict=True))
    finally:
        os.chdir(before)
    return folder


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    with Browser(tmp_path_factory.mktemp("profile")) as opened:
        yield opened


def test_reference_says_what_docstrings_and_commands_say(site):
    reference = (site / "reference" / "evolution.html").read_text(encoding="utf-8")
    assert "Start a run in a folder, or go on with it" in reference
    commands = (site / "reference" / "command-line.html").read_text(encoding="utf-8")
    for command in COMMANDS:
        assert f"usage: wordarm {command} " in commands


@NEEDS_BROWSER
@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("page", ["index", "tutorial", "how-to/resume", "reference/evolution", "glossary"])
def test_pages_open_from_disk_and_ask_for_nothing_else(site, browser, page, scheme):
    browser.messages.clear()
    browser.requests.clear()
    browser.open(site / f"{page}.html", width=360, scheme=scheme)
    assert browser.requests
    assert all(address.startswith(("file:", "data:")) for address in browser.requests)
    assert not browser.messages
    assert browser.evaluate("document.documentElement.scrollWidth") == 360
    assert browser.evaluate("[...document.images].every(each => each.complete && each.naturalWidth)")


@NEEDS_BROWSER
def test_search_finds_words_of_the_field_from_disk(site, browser):
    browser.open(site / "index.html")
    browser.evaluate("document.querySelector('#__search').click()")
    for word, page in (("zero-shot", "Glossary"), ("resume", "Resume a stopped run")):
        browser.evaluate(
            "(() => { const field = document.querySelector('[data-md-component=search-query]');"
            f"field.focus(); field.value = '{word}';"
            "field.dispatchEvent(new Event('keyup', { bubbles: true })); })()"
        )
        browser.wait_for(
            "[...document.querySelectorAll('.md-search-result__item h1')]"
            f".some(each => each.textContent.includes('{page}'))"
        )
