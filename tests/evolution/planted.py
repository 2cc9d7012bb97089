"""Files in the current folder that tell when they are imported: whatever is started there must not."""

from pathlib import Path

NAMES = ("random", "json", "subprocess", "runpy", "mujoco", "numpy", "arm2d", "models", "sitecustomize")
TELL = "open(__file__ + '.executed', 'a').close()\n"


def plant(folder: Path) -> Path:
    """Plant modules that carry names of ours, of libraries and of Python's own."""
    (folder / "evolution").mkdir(parents=True)
    for name in (*NAMES, "evolution/__init__", "evolution/__main__", "mujoco_port"):
        (folder / f"{name}.py").write_text(TELL)
    return folder


def executed(folder: Path) -> list[str]:
    """Those that were imported, by whomever."""
    return sorted(each.name for each in folder.rglob("*.executed"))
