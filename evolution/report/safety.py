"""What a page takes from folders that others may write, and what it may do once somebody opens it.

Names become addresses that lead nowhere else, drawings are looked at before they are let in, and the page
tells the browser which script is ours and that nothing is to be fetched.
"""

from __future__ import annotations

import os
import re
from base64 import b64encode
from hashlib import sha256
from pathlib import Path
from typing import Final
from urllib.parse import quote
from xml.parsers import expat

# A page needs nothing from elsewhere but films, which lie beside it; its player counts in a worker made of
# the page's own script.
POLICY: Final = (
    "default-src 'none'; script-src {scripts}; style-src 'unsafe-inline'; img-src data:; "
    "media-src 'self' file:; worker-src blob:; base-uri 'none'; form-action 'none'"
)
SCRIPT: Final = re.compile(r"<script(?: id=[^>]*)?>(.*?)</script>", re.DOTALL)
PLAYER: Final = "{{ player.script }}"
# What drawings consist of, whoever draws them; no scripts, foreign elements, links or animations.
ELEMENTS: Final = frozenset((
    "svg", "g", "defs", "style", "path", "use", "rect", "circle", "ellipse", "line", "polyline", "polygon",
    "text", "tspan", "title", "desc", "image", "clipPath", "pattern", "marker", "symbol", "linearGradient",
    "radialGradient", "stop", "metadata", "RDF", "Work", "type", "format", "creator", "date", "Agent",
))  # fmt: skip
REFERENCES: Final = ("href", "src")
INSIDE: Final = re.compile(r"#|data:image/(png|jpeg);base64,")
# Ways by which a style reaches for something else, and the backslash, by which they can be disguised.
REACHING: Final = re.compile(
    r"\\|@|://|url\((?!\s*[\"']?#)|image-set|(?<![\w-])(image|src|element)\(", re.IGNORECASE
)


def content_policy(template: str, player: str = "") -> str:
    """The policy of a page: no script runs in it but those of its template, word for word.

    Args:
        template: Of the page.
        player: What stands in it for `PLAYER`.
    """
    scripts = [each.replace(PLAYER, player) for each in SCRIPT.findall(template)]
    digests = [b64encode(sha256(each.encode()).digest()).decode() for each in scripts]
    return POLICY.format(scripts=" ".join(f"'sha256-{each}'" for each in digests) or "'none'")


def link_to(path: Path, home: Path) -> str:
    """The address of a file, relative to the folder of a page; its name can be no other kind of address."""
    return f"./{quote(os.fsencode(os.path.relpath(path, home)))}"


def check_drawing(drawing: bytes) -> None:
    """Refuse an SVG that holds more than a drawing.

    Raises:
        ValueError: With what it holds.
    """
    reader, styles = expat.ParserCreate(), list[str]()
    inside: list[str] = []

    def begin(name: str, attributes: dict[str, str]) -> None:
        inside.append(_local(name))
        if inside[-1] not in ELEMENTS:
            raise ValueError(f"it holds an element {name!r}")
        for attribute, value in attributes.items():
            _check_attribute(_local(attribute), attribute, value)

    def text(content: str) -> None:
        if inside and inside[-1] == "style":
            styles.append(content)

    reader.StartElementHandler, reader.CharacterDataHandler = begin, text
    reader.EndElementHandler = lambda name: inside.pop()
    reader.ProcessingInstructionHandler = _refuse_instruction
    reader.StartDoctypeDeclHandler = _check_doctype
    reader.XmlDeclHandler = _check_encoding
    try:
        reader.Parse(drawing, True)
    except expat.ExpatError as error:
        raise ValueError(f"it is not XML: {error}") from None
    if found := REACHING.search("".join(styles)):
        raise ValueError(f"its style holds {found[0]!r}")


def _check_attribute(local: str, name: str, value: str) -> None:
    """Refuse what acts, or leads out of the drawing."""
    if name.partition(":")[0] == "xmlns" or name == "rdf:resource":  # names of vocabularies
        return
    if local.lower().startswith("on") or local == "base":
        raise ValueError(f"it holds an attribute {name!r}")
    if local in REFERENCES:
        if not INSIDE.match(value):
            raise ValueError(f"it refers to {value[:40]!r}")
    elif found := REACHING.search(value):
        raise ValueError(f"its attribute {name!r} holds {found[0]!r}")


def _refuse_instruction(target: str, data: str) -> None:
    raise ValueError(f"it holds an instruction {target!r}")


def _check_doctype(name: str, system: str | None, public: str | None, has_own: int) -> None:
    """The usual heading of an SVG is read by nobody; definitions in it are."""
    if has_own:
        raise ValueError("it defines entities")


def _check_encoding(version: str, encoding: str | None, standalone: int) -> None:
    if (encoding or "utf-8").lower() != "utf-8":
        raise ValueError(f"it is written in {encoding!r}, not UTF-8")


def _local(name: str) -> str:
    return name.rpartition(":")[2]
