"""The command `wordarm`, and `python -m wordarm`: found whatever else is called `evolution` or `models`.

The same for a library, where a script's own folder has a module of that name:

    from wordarm import evolution, mujoco_port
"""

import sys
from importlib import import_module
from pathlib import Path
from types import ModuleType

HOME = Path(__file__).resolve().parent
PACKAGES = ("arm2d", "models", "evolution", "mujoco_port")


def main() -> int:
    """Run a command and return its exit code."""
    sys.path.insert(0, str(HOME))
    try:
        from evolution.__main__ import main as command
    finally:
        sys.path.remove(str(HOME))
    return command()


def __getattr__(name: str) -> ModuleType:
    """A package of ours; the others come along, so that it finds them too.

    Raises:
        ImportError: If a stranger of one of these names was imported before.
    """
    if name not in PACKAGES:
        raise AttributeError(
            f"module 'wordarm' has no attribute {name!r}; it has main and {', '.join(PACKAGES)}"
        )
    sys.path.insert(0, str(HOME))
    try:
        found = {package: import_module(package) for package in PACKAGES}
    finally:
        sys.path.remove(str(HOME))
    for package, module in found.items():
        file = getattr(module, "__file__", None)
        if file is None or Path(file).resolve().parent.parent != HOME:
            raise ImportError(
                f"{file} was imported as {package!r} before wordarm's package of that name; "
                "rename it, or import from wordarm first",
                name=package,
                path=file,
            )
    return found[name]


if __name__ == "__main__":
    sys.exit(main())
