"""A Python process of our own: how one is started, which packages it finds, and which function it calls.

    python -P .../evolution/child.py FUNCTION ARGUMENTS     a function of ours, with arguments as JSON
    python -P .../evolution/child.py -m MODULE [WORD...]    a module, as `python -m` does

`-P` keeps Python from importing what lies in the current folder, where anyone may have put a `random.py`; and
whatever a sub-folder there is called, our packages are those that the parent has, installed or not.
"""

from __future__ import annotations

import json
import runpy
import sys
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path
from types import ModuleType
from typing import Any, Final

PACKAGES: Final = ("arm2d", "evolution", "models", "mujoco_port")
HOME: Final = Path(__file__).resolve().parents[1]

# What a process is told to do: a function at the top of one of our modules, which answers with an exit code.
Function = Callable[..., int]


def python(*words: str) -> list[str]:
    """The command line of a child, such as `python("-m", "evolution", "status", "runs")`."""
    return [sys.executable, "-P", str(HOME / "evolution" / "child.py"), *words]


def calling(function: str, arguments: Mapping[str, Any]) -> list[str]:
    """The command line of a child that calls a function, known by its reference."""
    return python(function, json.dumps(arguments))


def reference(function: Function) -> str:
    """A function as text, for another process: its module and name.

    Raises:
        ValueError: If it is not found by them.
    """
    text = f"{function.__module__}:{function.__qualname__}"
    if resolve(text) is not function:
        raise ValueError(f"{text} is not what another process would find by this name")
    return text


def resolve(text: str) -> Function:
    """The function of a reference.

    Raises:
        ValueError: If it is none of ours.
    """
    module, _, name = text.partition(":")
    ours = module.split(".")[0] == "evolution"
    function: Function | None = getattr(import_module(module), name, None) if ours else None
    if function is None or not callable(function):
        raise ValueError(f"{text!r} is no function of ours; expected evolution.<module>:<function>")
    return function  # pyright: ignore[reportReturnType] - an exit code, or its caller finds out


def perform(function: str, arguments: Mapping[str, Any]) -> int:
    """Call a function by its reference; the exit code, bad input being told in one sentence."""
    from evolution.answers import answer

    return answer(lambda: resolve(function)(**arguments))


class _OurPackages:
    """Finds our packages where this file is."""

    @staticmethod
    def find_spec(
        name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        return PathFinder.find_spec(name, [str(HOME)]) if name in PACKAGES else None


def _main(words: Sequence[str]) -> None:
    """Be the child."""
    sys.meta_path.insert(0, _OurPackages)
    if str(HOME) not in sys.path:
        # Last of all: for processes that libraries start from this one, which are handed its path.
        sys.path.append(str(HOME))
    if words[0] == "-m":
        sys.argv = list(words[1:])
        runpy.run_module(words[1], run_name="__main__", alter_sys=True)
    else:
        sys.exit(perform(words[0], json.loads(words[1])))


if __name__ == "__main__":
    _main(sys.argv[1:])
