"""The pages of docs/ lead to one another, in the site and where the repository is hosted."""

import re
from itertools import pairwise

import pytest
import yaml

from scripts.site_pages import GENERATED
from tests.docs.pages import DOCS, ROOT

PAGES = sorted(DOCS.rglob("*.md"))
README = (ROOT / "README.md").read_text(encoding="utf-8")
LINK = re.compile(r"\]\(([^)\s]+)\)")
CONFIG = yaml.safe_load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))
# What somebody who has never seen the project looks for: the page, and words of the answer.
ASKED = {
    "how to resume a run": ("how-to/resume.md", "To resume, give the same command again"),
    "what success is": ("success.md", "A trial succeeds if F1 = F2 = 1"),
    "how sure the verdict is": ("statistics.md", "The paper's claim does not come out"),
    "how to add a word": ("how-to/instruction.md", "Add a word"),
    "why two machines give the same bits": ("same-bits.md", "Only exact operations decide"),
}


def name_of(page):
    return str(page.relative_to(DOCS))


def text_of(page):
    return page.read_text(encoding="utf-8")


def in_the_navigation(entries=None):
    """The pages that the navigation of the site names."""
    for entry in CONFIG["nav"] if entries is None else entries:
        for value in entry.values():
            yield from [value] if isinstance(value, str) else in_the_navigation(value)


def anchors(page):
    """What links to a page may name after #."""
    titles = re.findall(r"^#+ (.*)$", text_of(page), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


def test_every_page_is_in_the_navigation_once():
    named = list(in_the_navigation())
    assert sorted(named) == sorted([*map(name_of, PAGES), *GENERATED])


def test_the_first_page_leads_to_all_others():
    linked = set(LINK.findall(text_of(DOCS / "index.md")))
    missing = {name_of(page) for page in PAGES} - linked - {"index.md"}
    assert not missing


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_links_to_a_heading_find_it(page):
    for link in LINK.findall(text_of(page)):
        path, _, anchor = link.partition("#")
        if anchor and not link.startswith("https:"):
            target = page.parent / path if path else page
            assert anchor in anchors(target), link


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_lists_and_tables_begin_after_a_blank_line(page):
    """Elsewhere they need none; in the site they would become text."""
    text = re.sub(r"^```.*?^```$", "", text_of(page), flags=re.MULTILINE | re.DOTALL)
    begins = re.compile(r"(?:- |\* |\d+\. |\|)")
    for before, line in pairwise(text.splitlines()):
        if begins.match(line) and before.strip():
            assert begins.match(before) or before.startswith("  "), f"{before}\n{line}"


@pytest.mark.parametrize("question", ASKED)
def test_what_is_asked_first_is_two_links_from_the_readme(question):
    page, answer = ASKED[question]
    assert "docs/index.md" in LINK.findall(README)
    assert page in LINK.findall(text_of(DOCS / "index.md"))
    assert page in in_the_navigation()
    assert answer in " ".join(text_of(DOCS / page).split())
