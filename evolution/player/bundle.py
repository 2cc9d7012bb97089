"""JavaScript modules joined into one script that needs no server: a page opened from disk may not import.

Every module becomes a function that is called once, so that names private to it stay so:

    const camera_js = (() => { const { bearing } = arithmetic_js; ...; return { look, inView }; })();

Only this form is understood: `import { a, b } from "./module.js";` and `export` before a declaration.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

SOURCES: Final = Path(__file__).with_name("src")
IMPORT: Final = re.compile(r'^import (\{[^}]*\}) from "\./(\w+)\.js";\n', re.MULTILINE)
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
    exports = ", ".join(f"...{name}_js" for name in texts)
    body = "\n".join(_wrapped(name, text) for name, text in texts.items())
    return f'"use strict";\nconst wordarm = (() => {{\n{body}\nreturn {{ {exports} }};\n}})();\n'


def _collect(name: str, folder: Path, texts: dict[str, str], path: tuple[str, ...]) -> None:
    """Add a module to `texts` after all that it imports."""
    if name in path:
        raise ValueError(f"modules import one another in a circle: {' > '.join([*path, name])}")
    if name in texts:
        return
    text = (folder / f"{name}.js").read_text(encoding="utf-8")
    for _, needed in IMPORT.findall(text):
        _collect(needed, folder, texts, (*path, name))
    texts[name] = text


def _wrapped(name: str, text: str) -> str:
    """A module as a function called once."""
    names = ", ".join(EXPORT.findall(text))
    text = EXPORT.sub("", IMPORT.sub(r"const \1 = \2_js;\n", text))
    if strange := LEFT_OVER.search(text):
        raise ValueError(f'{name}.js has {strange[0]!r}; write import {{ a }} from "./module.js" or export const a')
    return f"// {name}.js\nconst {name}_js = (() => {{\n{text.strip()}\nreturn {{ {names} }};\n}})();\n"
