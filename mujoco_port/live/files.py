"""The page's files, read once; nothing else can be asked for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Final

PAGE: Final = Path(__file__).with_name("page")
KINDS: Final = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
}
BYTES: Final = "application/octet-stream"
# Nothing is fetched from elsewhere, nothing tells others of an address that holds a token, nothing is kept.
HEADERS: Final = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
    "img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "Cache-Control": "no-store",
    "Connection": "close",
}


@dataclass(frozen=True)
class PageFile:
    """What is answered.

    Attributes:
        kind: Its media type.
        content: Its bytes.
    """

    kind: str
    content: bytes


def page_files(made: Mapping[str, Callable[[], bytes]]) -> dict[str, Callable[[], PageFile]]:
    """What can be asked for, by path: the page, which is `/`, its files, and bytes that are made once."""
    files: dict[str, Callable[[], PageFile]] = {
        f"/{path.name}": partial(PageFile, KINDS[path.suffix], path.read_bytes())
        for path in sorted(PAGE.iterdir())
        if path.suffix in KINDS
    }
    files["/"] = files.pop("/index.html")
    for name, make in made.items():
        files[f"/{name}"] = cache(partial(_made, make))
    return files


def _made(make: Callable[[], bytes]) -> PageFile:
    return PageFile(BYTES, make())
