"""The tables of docs/api.md, written from what the packages offer and say of it.

    python -m scripts.api_page      rewrites them; the tour above them is written by hand

A package offers the names of its `__init__.pyi`; what is said of a name is the first line of its docstring,
or the comment above a value that can have none.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cached_property
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Final

PAGE: Final = Path(__file__).parents[1] / "docs" / "api.md"
MARK: Final = "<!-- From here on written by `python -m scripts.api_page`. -->\n"
PACKAGES: Final = {
    "arm2d": ("",),
    "evolution": (
        "search",
        "library",
        "runs",
        "agents",
        "experiments",
        "results",
        "figures",
        "report",
        "study",
        "trust",
    ),
    "mujoco_port": ("film", "acting", "reach"),
    "models": ("",),
}
TITLES: Final = {"library": "runs and agents in hand"}
LONGEST_CALL: Final = 90


def main() -> None:
    """Rewrite the page."""
    PAGE.write_text(page_of(PAGE.read_text(encoding="utf-8")), encoding="utf-8")


def page_of(text: str) -> str:
    """The page with its tables as they should be."""
    by_hand, _, _ = text.partition(MARK)
    return by_hand + MARK + "".join(section(package) for package in PACKAGES)


def section(package: str) -> str:
    """The names of one package, room by room."""
    homes = homes_of(package)
    text = f"\n## Names in {package}\n"
    for room in PACKAGES[package]:
        names = [name for name, home in homes.items() if home.split(".")[0] == room or not room]
        text += f"\n### {TITLES.get(room, room)}\n" if room else ""
        text += "\n| name | what |\n| --- | --- |\n"
        text += "".join(row(package, homes[name], name) for name in sorted(names, key=str.lower))
    return text


def homes_of(package: str) -> dict[str, str]:
    """Each name that a package offers, with the module it comes from; none for a module of the package."""
    stub = Path(str(import_module(package).__file__)).with_suffix(".pyi")
    imports = [each for each in ast.parse(stub.read_text()).body if isinstance(each, ast.ImportFrom)]
    return {name.name: each.module or "" for each in imports for name in each.names}


def row(package: str, home: str, name: str) -> str:
    """One line of a table."""
    value = getattr(import_module(package), name)
    what = described(package, home, name, value)
    if inspect.isclass(value) and (parts := list(parts_of(value))):
        what += "<br>" + ", ".join(f"`{part}`" for part in parts)
    called = call(name, value) if inspect.isfunction(value) else name
    return f"| `{_cell(called)}` | {_cell(what)} |\n"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def described(package: str, home: str, name: str, value: object) -> str:
    """The first line that is said of a name."""
    if isinstance(value, ModuleType) or inspect.isclass(value) or inspect.isfunction(value):
        return first_line(value)
    lines = Path(str(import_module(f"{package}.{home}").__file__)).read_text(encoding="utf-8").splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith((f"{name} ", f"{name}:")))
    said = []
    while lines[at - 1].startswith("# "):
        at -= 1
        said.insert(0, lines[at].removeprefix("# "))
    return " ".join(said)


def first_line(value: object) -> str:
    """Of a docstring of its own."""
    return (value.__doc__ or "").strip().split("\n")[0]


def call(name: str, function: object, *, bound: bool = False) -> str:
    """How a function is called: its arguments with their defaults."""
    shown, starred = [], False
    for each in list(inspect.signature(function).parameters.values())[bound:]:  # pyright: ignore
        if each.kind is each.KEYWORD_ONLY and not starred:
            shown, starred = [*shown, "*"], True
        default = "" if each.default is each.empty else f"={_plain(each.default)}"
        shown.append(each.name + default)
    return f"{name}({', '.join(shown)})"


def _plain(value: object) -> str:
    """A default, as short as it can be."""
    if isinstance(value, Enum):
        return str(value)
    text = repr(value)
    return "..." if "<" in text or len(text) > LONGEST_CALL // 3 else text


def parts_of(kind: type) -> Iterator[str]:
    """What an object of a class has: members, fields, properties, methods; of its bases, fields alone."""
    if issubclass(kind, Enum):
        yield from (each.name for each in kind)
    own = [each.name for each in fields(kind)] if is_dataclass(kind) else []
    yield from own
    for name, value in vars(kind).items():
        if name.startswith("_") or name in own:
            continue
        if isinstance(value, property | cached_property):
            yield name
        elif isinstance(value, classmethod):
            yield call(name, value.__func__, bound=True)
        elif inspect.isfunction(value):
            yield call(name, value, bound=True)


if __name__ == "__main__":
    main()
