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
    """The video; a file of that name is replaced once the new one is complete. By default
    `videos/<agent>-<instruction>.mp4` in the run folder or the current one; the name also tells start area,
    seed, robot and physics where they are not the default."""

    physics: bool = False
    """Let the robot act: motors, free objects, contacts; prints what became of it in 2D and 3D."""

    closed_loop: Literal["geometric", "camera"] | None = None
    """The agent's inputs come from the acting robot: objects seen where they are, or by a rendered camera."""

    video: bool = True
    """Without a video, only the verdicts of an acting robot are printed."""

    def run(self) -> int:
        """Record the trial and let the humanoid follow it, or carry it out."""
        physics = self.physics or self.closed_loop is not None
        if not self.video and not physics:
            raise ValueError("without a video there is nothing to do but physics; add --physics")
        instruction = Instruction.parse(self.instruction)

        from evolution.agents.recording import record_instruction
        from evolution.runs.storage import make_folder
        from models.robots import get_robot
        from mujoco_port.film.names import film_name
        from mujoco_port.film.physical_port import check_acts, port_physical_trial
        from mujoco_port.film.port import check_films, port_trial

        get_robot(self.robot)  # refuses unknown names before anything is made
        source = self.find_agent()
        record = record_instruction(source, instruction, self.start_area, self.trial_seed)
        home = Path() if source.folder is None else source.folder.path
        name = film_name(
            source.name,
            str(instruction),
            start_area=self.start_area,
            trial_seed=self.trial_seed,
            robot=self.robot,
            physics=physics,
            closed_loop=self.closed_loop,
        )
        output = self.output or home / "videos" / name
        if self.video:
            if physics:
                check_acts(self.robot)
            check_films()
            make_folder(output.parent)
        if physics:
            shown = output if self.video else None
            verdict = port_physical_trial(
                record, source.genotype, shown, robot=self.robot, closed_loop=self.closed_loop
            )
            print(f"2D: {'carried out' if record.success else 'not carried out'}")
            print(f"3D: {'carried out' if verdict.success else 'not carried out: ' + verdict.reason}")
        else:
            port_trial(record, output, robot=self.robot)
        if self.video:
            print(output)
        return 0
