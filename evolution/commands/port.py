"""`wordarm port`: an agent's trial, carried out by the humanoid."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from tyro.conf import Positional, arg

from arm2d import Instruction
from evolution.commands.agent import AgentCommand


@dataclass(frozen=True, kw_only=True)
class Port(AgentCommand):
    """Show an agent carrying out an instruction on the humanoid, as a video."""

    instruction: Annotated[Positional[str], arg(metavar="INSTRUCTION")]
    """An action word and an object word, such as "touch green"."""

    start_area: Literal["right", "left"] = "right"
    """Where S1 starts: right or left."""

    trial_seed: int = 0
    """Start angle and object positions follow from it."""

    robot: str = "icub"
    """Which humanoid; an unknown name lists those there are."""

    output: Path | None = None
    """The video. By default `videos/<agent>-<instruction>.mp4` in the run folder, or in the current one."""

    def run(self) -> int:
        """Record the trial and let the humanoid follow it."""
        instruction = Instruction.parse(self.instruction)

        from evolution.recording import record_instruction
        from evolution.storage import make_folder
        from models.robots import get_robot
        from mujoco_port.port import port_trial

        get_robot(self.robot)  # refuses unknown names before anything is made
        source = self.find_agent()
        record = record_instruction(source, instruction, self.start_area, self.trial_seed)
        home = Path() if source.folder is None else source.folder.path
        words = f"{instruction.action.name}-{instruction.object.name}".lower()
        output = self.output or home / "videos" / f"{source.name}-{words}.mp4"
        make_folder(output.parent)
        port_trial(record, output, robot=self.robot)
        print(output)
        return 0
