"""A report about somebody else's runs: whatever lies there, nothing of it acts when the page is opened."""

import base64
import hashlib
import os
import re
import shutil
import struct
import zlib
from urllib.parse import unquote, urlsplit

import pytest
from matplotlib.figure import Figure

from arm2d import Condition
from evolution.experiments.experiment import open_experiment
from evolution.figures.page import svg_bytes
from evolution.report.configuration import versions_rows
from evolution.report.page import render, write_report
from evolution.report.pictures import file_uri, flattened
from evolution.report.safety import check_drawing, content_policy, link_to
from evolution.results.analysis import analyse
from evolution.results.notable import best_agent
from evolution.search.config import RunConfig
from tests.browser import NEEDS_BROWSER, Browser
from tests.evolution.report.test_report import SMALL, Page, evolve_and_test

NAMES = [
    "javascript:alert(1)", "a#b", "a?b=c", "100%25", "quotes'\"", "<b>bold<", "data:text,x", "a b&amp;c",
    "$(touch x)", "line\nbreak",
]  # fmt: skip
SVG = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink">%s</svg>'

WORKER = """new Promise(done => {
  const worker = new Worker(URL.createObjectURL(new Blob(["postMessage(1)"])));
  worker.onmessage = () => done("works"); worker.onerror = () => done("refused"); })"""
FILM = """new Promise(done => {
  const film = document.querySelector("video");
  addEventListener("securitypolicyviolation", event => done(event.violatedDirective));
  film.onerror = () => setTimeout(() => done("asked for"), 200);
  film.load(); film.play().catch(() => 0); })"""
FETCH = """new Promise(done => {
  const image = new Image();
  image.onerror = () => done("not there");
  addEventListener("securitypolicyviolation", () => done("refused"));
  image.src = "http://127.0.0.1:9/x.png"; })"""


@pytest.fixture(scope="module")
def experiment(tmp_path_factory):
    folder = tmp_path_factory.mktemp("hostile") / "experiment"
    evolve_and_test(folder, RunConfig(Condition.WITH_INDICATE, 1, SMALL))
    return folder


def page_of(folder, home):
    return render(analyse(open_experiment(folder)), home)


def addresses(text, tag, name):
    return [
        attributes[name] for each, attributes in Page(text).elements if each == tag and name in attributes
    ]


@pytest.mark.parametrize("name", NAMES)
def test_a_link_leads_to_its_file_whatever_the_names_on_the_way(name, tmp_path):
    file = tmp_path / name / f"{name.replace('/', '')}.mp4"
    file.parent.mkdir(parents=True)
    file.touch()
    parts = urlsplit(link_to(file, tmp_path))
    assert (parts.scheme, parts.netloc, parts.query, parts.fragment) == ("", "", "", "")
    assert parts.path.startswith("./")
    assert os.path.samefile(tmp_path / unquote(parts.path), file)


def test_films_agents_and_experiments_of_any_name_are_linked_and_shown(experiment, tmp_path):
    name = "javascript:<b>'\"#?%25"
    folder = shutil.copytree(experiment, tmp_path / name)
    run = (folder / "with-indicate" / "seed-0001").rename(folder / "with-indicate" / name)
    films = [run / "videos" / f"{each}.mp4" for each in NAMES if "/" not in each]
    films[0].parent.mkdir()
    for each in films:
        each.touch()
    text = page_of(folder, tmp_path)
    shown = addresses(text, "video", "src")
    assert [tmp_path / unquote(each) for each in shown] == sorted(films)
    links = [each for each in addresses(text, "a", "href") if not each.startswith("#")]
    assert links == [*shown, "https://doi.org/10.1109/TAMD.2011.2114659"]
    assert f"experiment “{name}”" in Page(text).text
    assert "<b>bold" not in text


def test_a_name_that_is_no_text_makes_a_page_too_and_commands_in_it_are_quoted_for_a_shell(
    experiment, tmp_path
):
    folder = shutil.copytree(experiment, tmp_path / os.fsdecode(b"caf\xe9"))
    (folder / "with-indicate" / "seed-0001").rename(folder / "with-indicate" / "x;touch y")
    page = write_report(analyse(open_experiment(folder)), folder / "page.html")
    words = Page(page.read_text(encoding="utf-8")).text
    assert "experiment “caf?”" in words
    assert "wordarm port 'with-indicate/x;touch y' \"move blue\"" in words


def test_the_page_tells_the_browser_to_run_its_own_script_only_and_to_fetch_nothing(experiment):
    text = page_of(experiment, experiment)
    (policy,) = addresses(text, "meta", "content")[:1]
    rules = {rule.split()[0]: rule.split()[1:] for rule in policy.split(";")}
    scripts = re.findall(r'<script(?: id="[^"]*")?>(.*?)</script>', text, re.DOTALL)
    assert scripts
    digests = [base64.b64encode(hashlib.sha256(each.encode()).digest()).decode() for each in scripts]
    assert rules["default-src"] == ["'none'"]
    assert rules["script-src"] == [f"'sha256-{each}'" for each in digests]
    assert rules["img-src"] == ["data:"]
    assert rules["base-uri"] == rules["form-action"] == ["'none'"]
    assert text.index("Content-Security-Policy") < min(
        text.index(each) for each in ("<style", "<script", "<link")
    )
    assert not re.search(r"<[^>]+ on\w+=", text)  # what the policy would stop


@NEEDS_BROWSER
def test_a_browser_keeps_to_it_and_loses_neither_player_nor_films(experiment, tmp_path):
    folder = shutil.copytree(experiment, tmp_path / "experiment")
    (folder / "videos").mkdir()
    (folder / "videos" / "film.mp4").touch()
    planted = "<script>document.title = 'ran'</script><a id='bad' href='javascript:document.title=1'>x</a>"
    page = folder / "report.html"
    page.write_text(page_of(folder, folder).replace("<main>", f"<main>{planted}"), encoding="utf-8")
    with Browser(tmp_path / "chromium") as browser:
        browser.open(page)
        browser.evaluate("document.getElementById('bad').click()")
        assert browser.evaluate("document.title").startswith("wordarm")
        assert browser.evaluate(WORKER) == "works"
        assert browser.evaluate(FILM) == "asked for"
        assert browser.evaluate(FETCH) == "refused"


def test_only_scripts_of_the_template_are_allowed():
    assert content_policy("<script>one</script> <script>two</script>").count("sha256-") == 2
    assert "script-src 'none'" in content_policy("<p>no script</p>")


def test_a_drawing_of_our_own_is_let_in():
    figure = Figure()
    axes = figure.add_subplot()
    axes.imshow([[0, 1], [1, 0]])
    axes.fill_between([0, 1], [1, 2], hatch="//")
    axes.set_title(r"100 % of $\alpha$ & <b>")
    check_drawing(svg_bytes(figure))


@pytest.mark.parametrize(
    ("content", "found"),
    [
        ("<script>alert(1)</script>", "an element 'script'"),
        ("<g><svg:script xmlns:svg='http://www.w3.org/2000/svg'/></g>", "an element 'svg:script'"),
        ("<foreignObject/>", "an element 'foreignObject'"),
        ("<a xlink:href='javascript:alert(1)'/>", "an element 'a'"),
        ("<animate attributeName='href' to='javascript:alert(1)'/>", "an element 'animate'"),
        ("<g onload='alert(1)'/>", "an attribute 'onload'"),
        ("<g xml:base='http://example.org/'/>", "an attribute 'xml:base'"),
        ("<image href='http://example.org/x.png'/>", "it refers to 'http://example.org/x.png'"),
        ("<image xlink:href='file:///etc/passwd'/>", "it refers to 'file:///etc/passwd'"),
        ("<image href='data:image/svg+xml,x'/>", "it refers to 'data:image/svg"),
        ("<use xlink:href='other.svg#a'/>", "it refers to 'other.svg#a'"),
        ("<style>@import 'http://example.org'</style>", "its style holds '@'"),
        ("<style>* {fill: url(http://example.org)}</style>", "its style holds 'url('"),
        ("<style>* {fill: \\75rl(x)}</style>", r"its style holds '\\\\'"),
        ("<style>* {fill: u</style><style>rl(x)}</style>", "its style holds 'url('"),
        ("<g style='fill: URL( x)'/>", "its attribute 'style' holds 'URL('"),
        ("<g fill='url(&quot;x&quot;)'/>", "its attribute 'fill' holds"),
        ("<g style='background: image-set(\"x\" 1x)'/>", "its attribute 'style' holds 'image-set'"),
        ("<?xml-stylesheet href='x'?>", "an instruction 'xml-stylesheet'"),
        ("<g>", "it is not XML"),
        ("&entity;", "it is not XML"),
    ],
)
def test_a_drawing_that_acts_or_reaches_out_is_refused(content, found):
    with pytest.raises(
        ValueError, match=re.escape(found).replace(r"\\\(", r"\(").replace(r"\\\\\\\\", r"\\\\")
    ):
        check_drawing((SVG % content).encode())


@pytest.mark.parametrize(
    "heading",
    [
        '<!DOCTYPE svg [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>',
        '<!DOCTYPE svg [<!ENTITY a SYSTEM "file:///etc/passwd">]>',
        '<?xml version="1.0" encoding="iso-8859-1"?>',
    ],
)
def test_a_drawing_that_defines_what_it_is_written_in_is_refused(heading):
    with pytest.raises(ValueError, match=r"it defines entities|it is written in"):
        check_drawing(heading.encode() + (SVG % "").encode())


def test_what_acts_is_named_instead_and_links_are_neither_embedded_nor_linked(experiment, tmp_path):
    folder = shutil.copytree(experiment, tmp_path / "experiment")
    agent = best_agent(analyse(open_experiment(folder)).conditions[Condition.WITH_INDICATE])
    drawings, films = agent.run.path / "lineage", folder / "videos"
    drawings.mkdir()
    films.mkdir()
    acting, link = (
        drawings / f"generation-{agent.generation:06d}-rank-{agent.rank}{each}.svg" for each in ("", "-link")
    )
    (tmp_path / "secret.svg").write_text(SVG % "<title>secret</title>")
    (tmp_path / "secret.mp4").touch()
    acting.write_text(SVG % "<script>secret</script>")
    link.symlink_to(tmp_path / "secret.svg")
    (films / "link.mp4").symlink_to(tmp_path / "secret.mp4")
    (films / ".film.unfinished.mp4").touch()
    text = page_of(folder, folder)
    assert f"{acting} is not shown: it holds an element 'script'" in Page(text).text
    assert f"{link} is not shown: {link} is a symbolic link" in Page(text).text
    assert addresses(text, "img", "alt").count("Its line of ancestors") == 0
    assert addresses(text, "video", "src") == []


def test_a_picture_of_endless_pixels_is_refused_before_it_is_unpacked(tmp_path):
    header = struct.pack(">IIBBBBB", 100_000, 100_000, 8, 2, 0, 0, 0)
    chunk = b"IHDR" + header
    png = b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + chunk + struct.pack(">I", zlib.crc32(chunk))
    png += struct.pack(">I", 0) + b"IDAT" + struct.pack(">I", zlib.crc32(b"IDAT"))
    with pytest.raises(ValueError, match="its PNG"):
        flattened(png)
    (tmp_path / "a.svg").write_text(SVG % (" " * 500_000))
    (tmp_path / "a.png").write_bytes(b"GIF89a")
    with pytest.raises(ValueError, match="its PNG cannot be read"):
        file_uri(tmp_path / "a.svg")


@pytest.mark.parametrize(
    "start", ['{"versions": 5}', '{"machine": 5}', "5", '{"versions": {"a": {"b": []}}}']
)
def test_what_meta_json_holds_never_ends_the_report(start, experiment, tmp_path):
    folder = shutil.copytree(experiment, tmp_path / "experiment")
    (folder / "with-indicate" / "seed-0001" / "meta.json").write_text(f'{{"starts": [{start}]}}')
    assert versions_rows(analyse(open_experiment(folder)))[-1][0] == "this page"
