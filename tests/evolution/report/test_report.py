"""The page without a browser: it needs nothing else, shows every number, and says what is missing."""

import errno
import json
import re
import shutil
from base64 import b64decode
from dataclasses import replace
from html import unescape
from html.parser import HTMLParser
from urllib.parse import quote

import numpy as np
import pytest
from matplotlib.figure import Figure

from arm2d import Condition, Readings
from arm2d.films import write_mp4
from evolution.agents.parts import late_spans
from evolution.agents.postevaluation import post_evaluate
from evolution.agents.solving import solved_trials
from evolution.agents.subtasks import SUBTASKS
from evolution.agents.transitions import run_transition_test
from evolution.experiments.experiment import open_experiment
from evolution.report.page import render, write_report
from evolution.report.pictures import file_uri
from evolution.report.sentences import result_sentences
from evolution.report.tables import main_lines, shown_runs, shown_tests
from evolution.results import published
from evolution.results.analysis import analyse
from evolution.results.notable import best_agent
from evolution.results.statistics import Comparison
from evolution.results.wording import p_value, percent
from evolution.runs.run import evolve
from evolution.runs.sources import find_agent
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from tests.browser import NEEDS_BROWSER, Browser

SMALL = Settings(population=10, elites=2, parents=5, generations=30)
VOID = {"meta", "link", "img", "input", "br", "hr"}


class Page(HTMLParser):
    """Elements, links and the text of a page; fails on a tag that is not closed in order."""

    def __init__(self, text):
        super().__init__()
        self.open, self.elements, self.words = [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, self.getpos()

    def handle_data(self, data):
        if self.open and self.open[-1] not in ("script", "style"):
            self.words.append(data)

    @property
    def text(self):
        return " ".join(" ".join(self.words).split())


def evolve_and_test(folder, config):
    path = folder / config.condition / f"seed-{config.seed:04d}"
    evolve(path, config)
    run = open_experiment(path).all_runs[0]
    post_evaluate(run)
    run_transition_test(run)
    solved_trials(run)


@pytest.fixture(scope="session")
def experiment(tmp_path_factory):
    """Two tested runs of either condition, far too short to learn anything."""
    folder = tmp_path_factory.mktemp("experiments") / "tiny & <small>"
    for condition in Condition:
        for seed in (1, 2):
            evolve_and_test(folder, RunConfig(condition, seed, SMALL))
    return folder


@pytest.fixture(scope="session")
def results(experiment):
    return analyse(open_experiment(experiment))


@pytest.fixture(scope="session")
def text(results, experiment):
    return render(results, experiment)


def test_everything_in_the_template_is_filled_in(text):
    assert not re.search(r"\{\{|\{%|%\}|\}\}", Page(text).text)


def test_the_page_parses_and_needs_nothing_from_elsewhere(text):
    page = Page(text)
    for tag, attributes in page.elements:
        for name in ("src", "href", "srcset", "poster", "action"):
            address = attributes.get(name) or ""
            plain_link = tag == "a" and name == "href"
            assert plain_link or address.startswith("data:") or not address, (tag, address)
    assert not re.search(r"@import|url\((?!#)|fetch\(|XMLHttpRequest|import\(", text)
    # The page has one plain link; the player names the vocabulary that its drawings are written in.
    assert re.findall(r"https?://[^\s\"<]+", text) == [
        "https://doi.org/10.1109/TAMD.2011.2114659",
        "http://www.w3.org/2000/svg",
    ]


def test_inner_links_lead_somewhere(text):
    page = Page(text)
    ids = [attributes["id"] for _, attributes in page.elements if "id" in attributes]
    assert len(ids) == len(set(ids))
    for tag, attributes in page.elements:
        if tag == "a" and attributes["href"].startswith("#"):
            assert attributes["href"][1:] in ids


CELL = re.compile(r"<t[hd][^>]*>(.*?)</t[hd]>", re.DOTALL)


def tables_of(text):
    """Every table of a page as rows of words."""
    tables = []
    for table in re.findall(r"<table.*?</table>", text, re.DOTALL):
        rows = re.findall(r"<tr.*?</tr>", table, re.DOTALL)
        tables.append([[unescape(word).strip() for word in CELL.findall(row)] for row in rows])
    return tables


def rows_below(text, heads):
    """The rows of every table with this line of heads, table by table."""
    return [table[table.index(heads) + 1 :] for table in tables_of(text) if heads in table]


@pytest.fixture(scope="module")
def unequal(results, experiment):
    """Results whose numbers all differ, and their page."""
    comparisons = {
        name: Comparison((0.1, 0.2), 0.3 + place / 10, (0.4, 0.5), 0.06, 0.07, 0.8)
        for place, name in enumerate(results.comparisons)
    }
    conditions = {
        condition: replace(own, counts=np.arange(44).reshape(11, 4) + 10_000 + 100 * place)
        for place, (condition, own) in enumerate(results.conditions.items())
    }
    changed = replace(results, comparisons=comparisons, conditions=conditions)
    return changed, render(changed, experiment)


def test_runs_and_tests_stand_under_their_names(unequal):
    changed, text = unequal
    for table in (shown_runs(changed), shown_tests(changed)):
        (rows,) = rows_below(text, list(table.columns))
        assert rows == [list(row.values()) for row in table.rows()]
        assert len(rows) >= 4


def test_the_papers_numbers_and_ours_stand_under_their_heads(unequal):
    changed, text = unequal
    (main,) = rows_below(text, ["", "paper", "ours", "paper", "ours"])
    expected = [
        [line.what, *(words for pair in line.pairs for words in pair)] for line in main_lines(changed)
    ]
    assert main == expected
    categories = rows_below(text, ["category", *["paper", "ours"] * 4])
    assert len(categories) == 2
    for rows, (condition, own) in zip(categories, changed.conditions.items(), strict=True):
        both = np.stack([published.TABLE_II[condition], own.counts], axis=-1).reshape(11, 8)
        assert [row[1:] for row in rows] == [[f"{n:,}" for n in row] for row in both]


def test_all_figures_are_inside(text):
    page = Page(text)
    images = [attributes for tag, attributes in page.elements if tag == "img"]
    assert len(images) == 4  # and none of classes, since these agents are too young for any
    assert "No agent masters the experienced instructions" in page.text
    assert all(image["alt"] and image["src"].startswith("data:image/") for image in images)


def test_the_result_is_three_sentences_from_the_data(results):
    sentences = result_sentences(results)
    assert len(sentences) == 3
    assert sentences[0].startswith("0 of 2 With-Indicate runs and 0 of 2 With-Ignore runs end at the largest")
    assert sentences[1].startswith("No agent is fully compositional")
    assert sentences[2].startswith("No difference between the conditions can be claimed (smallest p")


def test_where_the_conditions_differ_the_shares_are_those_of_the_comparison_that_is_named(results):
    names = list(results.comparisons)
    told = {
        name: replace(own, means=(0.01 * k, 0.5 + 0.01 * k), mann_whitney_p=0.9 - 0.1 * k)
        for k, (name, own) in enumerate(results.comparisons.items())
    }
    least = names[2]
    told[least] = replace(told[least], mann_whitney_p=0.001)
    sentence = result_sentences(replace(results, comparisons=told))[2]
    full = names.index("fully compositional agents")
    assert f"differ most in {least}: 2.0 % of the With-Indicate agents and 52.0 % of the With-Ig" in sentence
    assert "(p = 0.001, runs being the unit, smallest of 7 comparisons)" in sentence
    assert f"Fully compositional are {full}.0 % of the With-Indicate agents and 5{full}.0 %" in sentence


def test_the_best_agents_live_at_the_top_of_the_page(text, results):
    players = json.loads(
        re.search(r'<div class="wordarm">\s*<script[^>]*>(.*?)</script>', text, re.DOTALL)[1]
    )
    best = [best_agent(each) for each in results.conditions.values()]
    for player, agent, condition in zip(players, best, Condition, strict=True):
        source = find_agent(str(agent.run.path), generation=agent.generation, rank=agent.rank)
        assert np.array_equal(player["genotype"], source.genotype)
        assert player["successes"] == agent.successes.tolist()
        assert player["condition"] == condition
        assert player["readings"] == source.readings.to_mapping()
    assert text.index('id="agents"') < text.index('id="beside"')


@NEEDS_BROWSER
def test_the_page_lives_and_can_be_read_in_a_browser(furnished, tmp_path):
    page = tmp_path / "report.html"
    page.write_text(furnished[1], encoding="utf-8")  # with a still of a film
    with Browser(tmp_path / "chromium") as browser:
        for width, scheme in ((360, "light"), (1280, "dark")):
            browser.open(page, width=width, scheme=scheme)
            assert browser.evaluate("document.documentElement.scrollWidth") <= width
            assert browser.faint_texts() == []
        browser.click(".wa-pill.wa-move span")
        browser.click(".wa-pill.wa-blue span")
        browser.evaluate("document.querySelector('[data-part=time]').focus()")
        browser.press("End")
        assert re.match(r"(Done|Not done): .*MOVE Blue", browser.text('[data-part="verdict"]'))
        assert browser.messages == []
        assert all(each.startswith(("file://", "data:")) for each in browser.requests)


def test_configuration_readings_and_versions_are_told(text):
    words = Page(text).text
    for name in (*Readings().to_mapping(), *SMALL.to_mapping()):
        assert name.replace("_", " ") in words
    for name in ("numba", "numpy", "revision", "processor"):
        assert name in words
    assert "size: population 10, not 100" in words


def test_names_are_escaped(text):
    assert "tiny &amp; &lt;small&gt;" in text
    assert "<small>”" not in text


def test_what_is_missing_is_named_and_the_rest_is_shown(experiment, tmp_path):
    folder = tmp_path / "partly"
    shutil.copytree(experiment, folder)
    shutil.rmtree(folder / "with-ignore")
    evolve(folder / "with-ignore" / "seed-0001", RunConfig(Condition.WITH_IGNORE, 1, SMALL))
    words = Page(render(analyse(open_experiment(folder)), folder)).text
    assert "with-ignore, seed 1: left out, not post-evaluated; go on with: wordarm postevaluate" in words
    assert "Only With-Indicate runs can be analysed, so the conditions are not compared." in words
    assert "0 of 2 With-Indicate runs end at the largest fitness" in words
    assert re.search(r"with-ignore, seed 1 30 of 30 \d\.\d{3} 0 %", words)


def test_a_run_that_may_not_be_looked_into_stands_on_the_page_without_a_share(
    experiment, tmp_path, monkeypatch
):
    """Nobody knows how much of it is to be tested. Root may look into everything, so one is refused here."""
    folder = tmp_path / "closed"
    shutil.copytree(experiment, folder)
    closed = next(folder.glob("with-ignore/seed-*"))

    def refusing(run):
        if run.path == closed:
            raise PermissionError(errno.EACCES, "Permission denied")
        return late_spans(run)

    results = analyse(open_experiment(folder))
    monkeypatch.setattr("evolution.experiments.standing.late_spans", refusing)
    assert re.search(r"with-ignore, seed \d+ 0 of 30 none yet - ", Page(render(results, folder)).text)


def test_an_experiment_without_any_result_is_a_page_too(finished_run, tmp_path):
    path = write_report(analyse(open_experiment(finished_run)), tmp_path / "new" / "page.html")
    page = Page(path.read_text(encoding="utf-8"))
    assert "No run is finished and tested yet, so there is no result." in page.text
    assert "with-indicate, seed 11 230 of 230" in page.text


@pytest.fixture(scope="module")
def furnished(results, experiment):
    """The pages, above it and elsewhere, of an experiment with a film beside a run, and a drawing of its best
    agent's ancestors."""
    film = experiment / "with-ignore" / "seed-0001" / "videos" / "champion-touch-green.mp4"
    film.parent.mkdir()
    write_mp4([np.full((90, 160, 3), 200, np.uint8)] * 20, film, 10)
    for leftover in (".champion-touch-green.unfinished.mp4", ".champion-touch-green.mp4.0a1b2c3d.unfinished"):
        (film.parent / leftover).touch()  # of a process that was killed
    agent = best_agent(results.conditions[Condition.WITH_INDICATE])
    drawings = agent.run.path / "lineage"
    drawings.mkdir()
    stem = f"generation-{agent.generation:06d}-rank-{agent.rank}"
    (drawings / f"{stem}.svg").write_text("<svg/>")
    (drawings / "generation-000000-rank-0.svg").write_text("<svg/>")  # another agent's
    texts = render(results, experiment.parent), render(results, experiment.parent / "elsewhere")
    shutil.rmtree(film.parent)
    shutil.rmtree(drawings)
    return texts


def test_films_beside_the_runs_are_linked(furnished, experiment):
    place = f"./{quote(experiment.name)}/with-ignore/seed-0001/videos/champion-touch-green.mp4"
    elements = Page(furnished[0]).elements
    assert [a["href"] for tag, a in elements if tag == "a" and "mp4" in a["href"]] == [place]
    assert [a["src"] for tag, a in elements if tag == "video"] == [place]
    assert "no film beside these runs" not in Page(furnished[0]).text


def test_a_page_shows_a_still_of_each_film_and_only_that_of_one_it_cannot_reach(furnished):
    above, elsewhere = (Page(text).elements for text in furnished)
    (video,) = [a for tag, a in above if tag == "video"]
    assert video["poster"].startswith("data:image/jpeg;base64,")
    assert "video" not in [tag for tag, _ in elsewhere]
    (still,) = [a for tag, a in elsewhere if tag == "img" and a["src"] == video["poster"]]
    assert still["alt"] == "A still of the film: TOUCH Green, with-ignore, seed-0001, champion"


def test_without_films_the_commands_that_make_them_are_told(text, results):
    words = Page(text).text
    for each in results.conditions.values():
        agent = best_agent(each)
        place = agent.run.path.relative_to(results.experiment.path)
        for instruction in ("move blue", "touch green"):
            command = (
                f'wordarm port {place} "{instruction}" --generation {agent.generation} --rank {agent.rank}'
            )
            assert command in words


def test_figures_drawn_for_the_best_agent_are_taken_along(furnished):
    assert furnished[0].count('alt="Its line of ancestors"') == 1


def test_a_drawing_is_shortened_where_no_eye_can_tell_and_replaced_where_it_is_huge(tmp_path):
    drawing = tmp_path / "a.svg"
    drawing.write_text('<svg><path d="M 1.234567 2.3"/><use transform="scale(0.015625)"/></svg>')
    shown = b64decode(file_uri(drawing).split(",")[1]).decode()
    assert shown == '<svg><path d="M 1.23 2.3"/><use transform="scale(0.015625)"/></svg>'
    drawing.write_text("<svg>" + " " * 500_000 + "</svg>")
    figure = Figure(figsize=(2, 1))
    figure.add_subplot().plot([0, 1])
    figure.savefig(drawing.with_suffix(".png"))
    kind, data = file_uri(drawing).split(",")
    assert kind == "data:image/png;base64"
    assert len(b64decode(data)) < drawing.with_suffix(".png").stat().st_size


def test_fully_compositional_agents_are_called_so(results):
    condition = Condition.WITH_INDICATE
    each = results.conditions[condition]
    members = {kind: np.array([3, 0]) for kind in each.members}
    found = replace(results, conditions={**results.conditions, condition: replace(each, members=members)})
    sentence = result_sentences(found)[1]
    assert sentence.startswith(
        "Fully compositional agents, above 75 % on all nine instructions, arise in 1 of 2 With-Indi"
    )


def test_small_shares_and_p_values_are_not_rounded_to_nought():
    assert [percent(share) for share in (0.0, 0.5, 0.00008)] == ["0 %", "50.0 %", "0.008 %"]
    assert [p_value(p) for p in (1.0, 0.0312, 0.0)] == ["1", "0.031", "below 1e-300"]
    assert len(SUBTASKS) == 4
