"""The page and its parts: style, markup and script, each a file beside this one."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from evolution.player.agents import agent_for_page
from evolution.player.bundle import bundle
from evolution.runs.sources import Agent

HERE = Path(__file__).parent


def render_page(sources: Sequence[Agent]) -> str:
    """The text of a page in which these agents live. The same agents give the same page."""
    environment = Environment(
        loader=FileSystemLoader(HERE), autoescape=True, undefined=StrictUndefined, keep_trailing_newline=True
    )
    return environment.get_template("page.html").render(
        **player_parts(), agents=as_json([agent_for_page(each) for each in sources])
    )


def player_parts() -> dict[str, Markup]:
    """What a page with players needs once: `style`, `markup` and `script`."""
    return {
        "style": Markup((HERE / "player.css").read_text(encoding="utf-8")),  # noqa: S704 - our own files
        "markup": Markup((HERE / "player.html").read_text(encoding="utf-8")),  # noqa: S704
        "script": Markup(bundle("main")),  # noqa: S704
    }


def as_json(value: Any) -> Markup:
    """JSON that can stand in a script element, whatever strings it holds."""
    text = json.dumps(value, separators=(",", ":"))
    return Markup(text.replace("<", "\\u003c"))  # noqa: S704 - escaped here
