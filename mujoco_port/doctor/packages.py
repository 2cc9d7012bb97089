"""Versions of the packages that are needed, and whether what is imported is what was installed.

A ROS workspace in PYTHONPATH or LD_LIBRARY_PATH brings a Pinocchio of its own, which then takes the place of
the one that was installed here: an import that fails, or works with other results.
"""

from __future__ import annotations

import json
import os
import re
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import Distribution, PackageNotFoundError, distribution, requires
from pathlib import Path
from typing import Final

from packaging.requirements import Requirement

from mujoco_port.doctor.children import Attempt, attempt
from mujoco_port.doctor.findings import Finding, State
from mujoco_port.film.gl import VARIABLE

TOPIC: Final = "packages"
PROJECT: Final = "wordarm"
# How a package is imported, where that is not its name; None: it holds data only.
MODULES: Final = {"pin": "pinocchio", "pillow": "PIL", "icub-models": None, "example-robot-data": None}
OVERLAY_ROOTS: Final = ("/opt/ros", "/opt/openrobots")
ABSENT_LIBRARY: Final = re.compile(r"(lib\S+\.so[.\d]*): cannot open shared object file")
# Which of Debian's packages brings a library that wheels expect of the system.
DEBIAN: Final = {
    "libgomp.so.1": "libgomp1",
    "libGL.so.1": "libgl1",
    "libEGL.so.1": "libegl1",
    "libstdc++.so.6": "libstdc++6",
}
# First where the module would come from, then, if it can be imported, its version and its own libraries.
IMPORT: Final = """
import importlib, importlib.util, json, sys
name = sys.argv[1]
spec = importlib.util.find_spec(name)
print(spec.origin if spec else "", flush=True)
module = importlib.import_module(name)
with open("/proc/self/maps", errors="surrogateescape") as maps:
    # A path is the sixth column, and may hold blanks.
    rows = [line.rstrip("\\n").split(maxsplit=5) for line in maps]
loaded = sorted({row[5] for row in rows if len(row) == 6 and f"lib{name}" in row[5]})
print(json.dumps([str(getattr(module, "__version__", "")), loaded]))
"""


@dataclass(frozen=True)
class Package:
    """A package that is needed, and what became of importing it.

    Attributes:
        requirement: Name and versions, as the project asks for them.
        imported: The attempt; None if it holds data only.
    """

    requirement: Requirement
    imported: Attempt | None

    @cached_property
    def installed(self) -> Distribution | None:
        """What this environment's list of installed packages says."""
        try:
            return distribution(self.requirement.name)
        except PackageNotFoundError:
            return None

    @property
    def origin(self) -> str:
        """The file that is imported; empty if there is none."""
        return self.imported.lines[0] if self.imported and self.imported.lines else ""

    @property
    def loaded(self) -> list[str]:
        """The package's own shared libraries in the process that imported it."""
        return json.loads(self.imported.lines[1])[1] if self.imported and self.imported.works else []

    @property
    def works(self) -> bool:
        """Whether it is there, of a version that will do, and can be imported."""
        return self.finding().state is State.WORKS

    def finding(self) -> Finding:
        """Put it into words."""
        name, asked = self.requirement.name, str(self.requirement)
        if elsewhere := self.foreign():
            return self._missing(
                f"{module_of(name)} comes from {elsewhere}, not from the package {name} of this environment",
                f"run it without that folder: {without(elsewhere)}",
            )
        if self.installed is None:
            return self._missing("not installed", f"pip install '{asked}'")
        version = self.installed.version
        if not self.requirement.specifier.contains(version, prereleases=True):
            return self._missing(
                f"{version}, but {self.requirement.specifier} is needed", f"pip install '{asked}'"
            )
        if self.imported and not self.imported.works:
            reason = self.imported.reason
            return self._missing(f"{version} cannot be imported: {reason}", remedy(reason, asked))
        return Finding(TOPIC, name, State.WORKS, f"{version}, {self._place()}")

    def foreign(self) -> str:
        """The file that takes the place of this package's own, such as one of a ROS workspace."""
        if self.imported is None:
            return ""
        for path in filter(None, (self.origin, *self.loaded)):
            if path.startswith(OVERLAY_ROOTS) or (self.installed and not self._owns(path)):
                return path
        return ""

    def _owns(self, path: str) -> bool:
        """Whether a file lies where this environment keeps its packages."""
        return self.installed is not None and Path(path).resolve().is_relative_to(_home_of(self.installed))

    def _place(self) -> str:
        """The folder that is imported, or where the data lies."""
        home = _home_of(self.installed) if self.installed else Path()
        return str(Path(self.origin).parent if self.origin else home)

    def _missing(self, text: str, next_move: str) -> Finding:
        return Finding(TOPIC, self.requirement.name, State.MISSING, text, next_move)


def needed_packages() -> list[Package]:
    """Import every package the project needs, each in a process of its own.

    Raises:
        PackageNotFoundError: If the project itself is not installed.
    """
    asked = [Requirement(each) for each in requires(PROJECT) or []]
    asked = [each for each in asked if each.marker is None or each.marker.evaluate({"extra": ""})]
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        return list(pool.map(examine_package, asked))


def examine_package(asked: Requirement) -> Package:
    """Import one package in a process of its own."""
    module = module_of(asked.name)
    # With a back end that is not there mujoco refuses to be imported: that is no fault of the package.
    quiet = {VARIABLE: ""}
    return Package(asked, None if module is None else attempt(IMPORT, module, environment=quiet))


def remedy(reason: str, asked: str) -> str:
    """What to do about an installed package that cannot be imported."""
    library = ABSENT_LIBRARY.search(reason)
    if library is None:
        return f"pip install --force-reinstall '{asked}'"
    name = library.group(1)
    return f"apt-get install {DEBIAN.get(name, f'the package that brings {name} (apt-file search {name})')}"


def module_of(name: str) -> str | None:
    """How a package is imported."""
    return MODULES.get(name, name.replace("-", "_"))


def overlays() -> list[Finding]:
    """Folders in PYTHONPATH and LD_LIBRARY_PATH that bring packages of a robotics distribution."""
    findings = []
    for variable in ("PYTHONPATH", "LD_LIBRARY_PATH"):
        for folder in filter(None, os.environ.get(variable, "").split(":")):
            if folder.startswith(OVERLAY_ROOTS) or holds_pinocchio(Path(folder)):
                text = (
                    f"{variable} leads to {folder}{_distribution_of_ros()}, whose packages come before ours"
                )
                findings.append(Finding(TOPIC, variable, State.NOTE, text, f"unset {variable}"))
    return findings


def holds_pinocchio(folder: Path) -> bool:
    """Whether a folder brings a Pinocchio, as a module or as a library."""
    return (folder / "pinocchio").is_dir() or any(folder.glob("libpinocchio*.so*"))


def without(path: str) -> str:
    """The call of `wordarm` that does not see a file."""
    for variable in ("PYTHONPATH", "LD_LIBRARY_PATH"):
        folders = filter(None, os.environ.get(variable, "").split(":"))
        if any(Path(path).is_relative_to(folder) for folder in folders):
            return f"env -u {variable} wordarm ..."
    return "make a virtual environment without --system-site-packages and install wordarm there"


def _distribution_of_ros() -> str:
    name = os.environ.get("ROS_DISTRO")
    return f" (ROS {name})" if name else ""


def _home_of(installed: Distribution) -> Path:
    return Path(str(installed.locate_file(""))).resolve()
