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

    def run(self) -> int:
        """Record the trials and let the humanoid follow them."""
        from evolution.recording import record_instruction
        from evolution.storage import make_folder
        from models.robots import get_robot
        from mujoco_port.port import port_gallery

        get_robot(self.robot)  # refuses unknown names before anything is made
        source = self.find_agent()
        records = [
            record_instruction(source, instruction, self.start_area, self.trial_seed)
            for instruction in source.condition.instructions
        ]
        home = Path() if source.folder is None else source.folder.path
        output = self.output or home / "videos" / f"{source.name}-gallery.mp4"
        make_folder(output.parent)
        carried_out = sum(record.success for record in records)
        title = f"{source.name}: nine instructions, two of them never met; {carried_out} carried out"
        for path in port_gallery(records, title, output, robot=self.robot):
            print(path)
        return 0
