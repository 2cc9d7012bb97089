"""Finding the robot descriptions that installed packages bring along."""

from __future__ import annotations

import re
from importlib.metadata import PackageNotFoundError, files
from pathlib import Path

from models.robots import Robot


class RobotNotInstalledError(FileNotFoundError):
    """The package that brings a robot's description is missing or incomplete."""


def find_urdf(robot: Robot) -> Path:
    """Give the path of a robot's URDF in its installed package.

    The package's list of files is asked, not a Python module: some packages have none.

    Raises:
        RobotNotInstalledError: If the package or the file in it is missing.
    """
    try:
        listed = files(robot.package) or []
    except PackageNotFoundError:
        raise RobotNotInstalledError(
            f"robot '{robot.name}' needs the package {robot.package}, which is not installed; "
            f"run: pip install {robot.package}"
        ) from None
    for entry in listed:
        if str(entry).endswith(robot.urdf):
            path = Path(str(entry.locate())).resolve()
            if path.is_file():
                return path
    raise RobotNotInstalledError(
        f"robot '{robot.name}' needs {robot.urdf}, which the installed package {robot.package} lacks; "
        f"run: pip install --force-reinstall {robot.package}"
    )


def share_folder(urdf: Path) -> Path:
    """Give the folder that `package://` stands for in a URDF.

    A URDF names its meshes `package://NAME/...`; the folder NAME is one of the URDF's own parents.

    Raises:
        RobotNotInstalledError: If none of the URDF's parents has that name.
    """
    reference = re.search(r"package://([^/\"]+)/", urdf.read_text())
    name = reference.group(1) if reference else ""
    for parent in urdf.parents:
        if parent.name == name:
            return parent.parent
    raise RobotNotInstalledError(
        f"{urdf.name} asks for meshes in package://{name}/, but lies in no folder of that name; "
        "install its package again"
    )


def read_urdf(robot: Robot) -> str:
    """Give a robot's URDF with absolute mesh paths in place of `package://`."""
    path = find_urdf(robot)
    return path.read_text().replace("package://", f"{share_folder(path)}/")
