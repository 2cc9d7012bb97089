"""`wordarm gallery`: all nine instructions of an agent on the humanoid, in one video."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from evolution.commands.agent import AgentCommand


@dataclass(frozen=True, kw_only=True)
class Gallery(AgentCommand):
    """Show an agent carrying out all nine instructions on the humanoid, three by three in one video."""

    start_area: Literal["right", "left"] = "right"
    """Where S1 starts: right or left."""

    trial_seed: int = 0
    """Start angles and object positions follow from it."""

    robot: str = "icub"
    """Which humanoid; an unknown name lists those there are."""

    output: Path | None = None
    """The video; its last picture lies beside it. By default `videos/<agent>-gallery.mp4`, as for `port`."""

    physics: bool = False
    """Let the robot act: motors, free objects, contacts; prints what became of each trial in 2D and 3D."""

    closed_loop: Literal["geometric", "camera"] | None = None
    """The agent's inputs come from the acting robot: objects seen where they are, or by a rendered camera."""

    def run(self) -> int:
        """Record the trials and let the humanoid follow them, or carry them out."""
        from evolution.agents.recording import record_instruction
        from evolution.runs.storage import make_folder
        from models.robots import get_robot
        from mujoco_port.film.names import film_name
        from mujoco_port.film.physical_port import check_acts, port_physical_gallery
        from mujoco_port.film.port import check_films, port_gallery

        get_robot(self.robot)  # refuses unknown names before anything is made
        source = self.find_agent()
        records = [
            record_instruction(source, instruction, self.start_area, self.trial_seed)
            for instruction in source.condition.instructions
        ]
        physics = self.physics or self.closed_loop is not None
        if physics:
            check_acts(self.robot)
        home = Path() if source.folder is None else source.folder.path
        name = film_name(
            source.name,
            "gallery",
            start_area=self.start_area,
            trial_seed=self.trial_seed,
            robot=self.robot,
            physics=physics,
            closed_loop=self.closed_loop,
        )
        output = self.output or home / "videos" / name
        check_films()
        make_folder(output.parent)
        carried_out = sum(record.success for record in records)
        title = f"{source.name}: nine instructions, two of them never met; {carried_out} carried out"
        if not physics:
            paths = port_gallery(records, title, output, robot=self.robot)
        else:
            paths, verdicts = port_physical_gallery(
                records,
                source.genotype,
                f"{title} in 2D",
                output,
                robot=self.robot,
                closed_loop=self.closed_loop,
            )
            for record, verdict in zip(records, verdicts, strict=True):
                planar = "carried out" if record.success else "not carried out"
                print(
                    f"{record.instruction}: 2D {planar}, 3D {'' if verdict.success else 'not '}carried out"
                    f"{'' if verdict.success else ': ' + verdict.reason}"
                )
        for path in paths:
            print(path)
        return 0
