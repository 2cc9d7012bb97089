"""`wordarm workspace`: what a robot's arm does everywhere, and the search for its constants."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from models.robots import Robot

NOT_CERTIFIED = 1  # exit code


@dataclass(frozen=True, kw_only=True)
class Workspace:
    """Certify that a humanoid reaches all of the workspace and meets neither the table nor itself."""

    robot: str = "icub"
    """Which humanoid; an unknown name lists those there are."""

    output: Path = Path()
    """Folder for `workspace-ROBOT.npz`, `.png` and `.svg`."""

    scale: float | None = None
    """Another scale of the map than the robot's own [m/cm]."""

    step_deg: float = 2.9
    """Widest step of the grid [deg]."""

    search: bool = False
    """Search for the constants of the robot's record instead, from those it has, and print the record."""

    evaluations: int = 3000
    """Records that a search tries."""

    seed: int = 0
    """Of the search: the same seed gives the same record."""

    def run(self) -> int:
        """Certify, or search."""
        from models.robots import get_robot

        robot = get_robot(self.robot)
        if self.scale is not None:
            if not self.scale > 0.0:
                raise ValueError(
                    f"a scale of {self.scale:g} m/cm is no map; give a positive one, such as 0.002"
                )
            robot = replace(robot, plane=replace(robot.plane, scale=self.scale))
        return self._search(robot) if self.search else self._certify(robot)

    def _certify(self, robot: Robot) -> int:
        from evolution.figures.page import save_figure
        from evolution.runs.storage import make_folder, write_arrays
        from mujoco_port.reach.certificate import certify
        from mujoco_port.reach.certificate_figure import draw_certificate

        if not self.step_deg > 0.0:
            raise ValueError(
                f"a step of {self.step_deg:g} degrees leads nowhere; give a positive one, at most 2.9"
            )
        make_folder(self.output)
        certificate = certify(robot, step_deg=self.step_deg)
        stem = self.output / f"workspace-{robot.name}"
        path = stem.with_suffix(".npz")
        write_arrays(path, certificate.arrays())
        figures = save_figure(draw_certificate(certificate, robot), stem)
        print("\n".join(certificate.summary()))
        for fault in certificate.faults():
            print(f"Not certified: {fault}.")
        print(", ".join(str(each) for each in (path, *figures)))
        return NOT_CERTIFIED if certificate.faults() else 0

    def _search(self, robot: Robot) -> int:
        from mujoco_port.reach.search import search_with_progress, written

        best = search_with_progress(robot, evaluations=self.evaluations, seed=self.seed)
        print(written(best))
        return 0
