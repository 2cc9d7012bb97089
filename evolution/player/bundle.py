"""JavaScript modules joined into one script that needs no server: a page opened from disk may not import.

Every module becomes a function that is called once, so that names private to it stay so:

    const world_camera_js = (() => { const { bearing } = world_arithmetic_js; ...; return { look }; })();

Only this form is understood: `import { a, b } from "./module.js";` and `export` before a declaration.
"""

from __future__ import annotations

import re
from pathlib import Path
from posixpath import dirname, join, normpath
from typing import Final

SOURCES: Final = Path(__file__).with_name("src")
IMPORT: Final = re.compile(r'^import (\{[^}]*\}) from "(\.[\w./]+)\.js";\n', re.MULTILINE)
EXPORT: Final = re.compile(r"^export (?=(?:const|function\*?|class) (\w+))", re.MULTILINE)
LEFT_OVER: Final = re.compile(r"^(?:import|export)\b.*", re.MULTILINE)


def bundle(entry: str, folder: Path = SOURCES) -> str:
    """The module `entry` and all that it imports, as one script whose value `wordarm` holds every export.

    Raises:
        ValueError: If modules import one another in a circle, or in a form that is not understood.
        OSError: If a module cannot be read.
    """
    texts: dict[str, str] = {}
    _collect(entry, folder, texts, ())
    exports = ", ".join(f"...{_variable(module)}" for module in texts)
    body = "\n".join(_wrapped(module, text) for module, text in texts.items())
    return f'"use strict";\nconst wordarm = (() => {{\n{body}\nreturn {{ {exports} }};\n}})();\n'


def _collect(module: str, folder: Path, texts: dict[str, str], path: tuple[str, ...]) -> None:
    """Add a module, named by its path without .js, to `texts` after all that it imports."""
    if module in path:
        raise ValueError(f"modules import one another in a circle: {' > '.join([*path, module])}")
    if module in texts:
        return
    text = (folder / f"{module}.js").read_text(encoding="utf-8")
    for _, needed in IMPORT.findall(text):
        _collect(_resolved(needed, module), folder, texts, (*path, module))
    texts[module] = text


def _resolved(needed: str, module: str) -> str:
    """What a module's relative import names."""
    return normpath(join(dirname(module), needed))


def _variable(module: str) -> str:
    """The constant that holds a module's exports."""
    return module.replace("/", "_") + "_js"


def _wrapped(module: str, text: str) -> str:
    """A module as a function called once."""
    names = ", ".join(EXPORT.findall(text))
    text = IMPORT.sub(lambda match: f"const {match[1]} = {_variable(_resolved(match[2], module))};\n", text)
    text = EXPORT.sub("", text)
    if strange := LEFT_OVER.search(text):
        raise ValueError(
            f'{module}.js: write import {{ a }} from "./module.js" or export const a, not {strange[0]!r}'
        )
    head = f"// {module}.js\nconst {_variable(module)} = (() => {{\n"
    return f"{head}{text.strip()}\nreturn {{ {names} }};\n}})();\n"
