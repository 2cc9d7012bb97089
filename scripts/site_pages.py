"""Pages of the documentation site that no file of docs/ holds: reference, notebook, contributing, changes.

MkDocs calls this module while it builds (`hooks` in mkdocs.yml). docs/ itself stays plain Markdown that can
be read where the repository is hosted; what leads out of it there is led to a page of the site here.
"""

from __future__ import annotations

import base64
import contextlib
import io
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page
from pymdownx.slugs import slugify

from evolution.cli import GROUPS, parse
from scripts.api_page import PACKAGES, TITLES, homes_of

ROOT: Final = Path(__file__).parents[1]
NOTEBOOK: Final = "examples/first-hour"
# Files of the repository that are pages of the site.
BORROWED: Final = {"CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md"}
GENERATED: Final = (
    *BORROWED.values(),
    f"{NOTEBOOK}.md",
    "reference/command-line.md",
    *(f"reference/{package}.md" for package in PACKAGES),
)
# Pages that are a tab by themselves: a list of one beside them would say nothing.
ALONE: Final = ("index.md", "glossary.md")
# Of the pictures in a notebook, as its outputs name them.
PICTURES: Final = {"image/png": "png", "image/jpeg": "jpg"}


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Name headings as GitHub does, so that a link to one works there and here."""
    config.mdx_configs["toc"]["slugify"] = slugify(case="lower")
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages."""
    for source, page in BORROWED.items():
        text = (ROOT / source).read_text(encoding="utf-8")
        files.append(File.generated(config, page, content=text.replace("](docs/", "](")))
    for package in PACKAGES:
        files.append(File.generated(config, f"reference/{package}.md", content=reference_of(package)))
    files.append(File.generated(config, "reference/command-line.md", content=command_line()))
    for name, content in notebook_page(ROOT / "docs" / f"{NOTEBOOK}.ipynb"):
        files.append(File.generated(config, f"examples/{name}", content=content))
    return files


def on_page_markdown(markdown: str, page: Page, **_: Any) -> str:
    """Lead links out of docs/ to the pages that stand for their targets."""
    if page.file.src_uri in ALONE:
        page.meta["hide"] = ["navigation"]
    up = "../" * page.file.src_uri.count("/")
    for source, target in BORROWED.items():
        markdown = markdown.replace(f"](../{up}{source}", f"]({up}{target}")
    if page.file.src_uri == f"{NOTEBOOK}.md":
        return markdown
    return markdown.replace(f"{NOTEBOOK}.ipynb)", f"{NOTEBOOK}.md)")


def reference_of(package: str) -> str:
    """All that a package offers, room by room, each name with its docstring."""
    homes = homes_of(package)
    text = f"# {package}\n\nWhat `import {package}` offers. By example: [a tour](../api.md).\n"
    for room in PACKAGES[package]:
        if room:
            text += f"\n## {TITLES.get(room, room).capitalize()}\n"
        for name in sorted((n for n in homes if not room or homes[n].split(".")[0] == room), key=str.lower):
            text += _entry(package, homes[name], name)
    return text


def _entry(package: str, home: str, name: str) -> str:
    """One name; mkdocstrings puts its documentation there."""
    path = ".".join(part for part in (package, home, name) if part)
    return f"\n::: {path}\n    options:\n      heading: {package}.{name}\n      toc_label: {name}\n"


def command_line() -> str:
    """What every command says about itself when it is asked with --help."""
    text = "# Every option\n\nWhat `wordarm COMMAND --help` says. By example: [commands](../commands.md).\n"
    for group, entries in GROUPS.items():
        text += f"\n## {group.capitalize()}\n"
        for name, entry in entries.items():
            text += f"\n### wordarm {name}\n\n{entry.line.capitalize()}.\n\n```text\n{help_of(name)}```\n"
    return text


def help_of(command: str) -> str:
    """The help text of one command, without colours."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.suppress(SystemExit):
        parse([command, "--help"])
    return re.sub(r"\x1b\[[\d;]*m", "", said.getvalue())


def notebook_page(path: Path) -> Iterator[tuple[str, str | bytes]]:
    """A stored notebook as Markdown, and its pictures: names beside it with their contents."""
    cells, text = json.loads(path.read_text(encoding="utf-8"))["cells"], ""
    for number, cell in enumerate(cells):
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            text += f"{source}\n\n"
            continue
        text += f"```python\n{source}\n```\n\n"
        for place, output in enumerate(cell["outputs"]):
            said = "".join(output.get("text", ())) or "".join(output.get("data", {}).get("text/plain", ()))
            for kind, ending in PICTURES.items():
                if drawn := output.get("data", {}).get(kind):
                    name = f"{path.stem}-{number}-{place}.{ending}"
                    yield name, base64.b64decode("".join(drawn))
                    text, said = f"{text}![What the lines above draw]({name})\n\n", ""
            text += f"```text\n{said.rstrip()}\n```\n\n" if said else ""
    yield f"{path.stem}.md", text
