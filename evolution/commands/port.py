"""`wordarm port`: an agent's trial, or all nine, carried out by the humanoid."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, Literal

from tyro.conf import Positional, arg

from arm2d import Instruction
from arm2d.tasks.task import papers_condition
from evolution.commands.agent import AgentCommand

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from arm2d import Condition, TrialRecord
    from evolution.runs.sources import Agent

ALL: Final = "all"


@dataclass(frozen=True, kw_only=True)
class Port(AgentCommand):
    """Show an agent carrying out an instruction on the humanoid, as a video; or all nine, three by three."""

    instruction: Annotated[Positional[str], arg(metavar="INSTRUCTION")]
    """An action word and an object word, such as "touch green"; or all."""

    start_area: Literal["right", "left"] = "right"
    """Where S1 starts."""

    trial_seed: int = 0
    """Start angle and object positions follow from it."""

    robot: str = "icub"
    """Which humanoid; an unknown name lists those there are."""

    quality: Literal["draft", "normal", "high"] = "normal"
    """How finely it is drawn: high has all triangles, smooth edges, soft shadows, and takes some 15 times."""

    output: Path | None = None
    """The video; for all, its last picture lies beside it. A file of that name is replaced once the new one
    is complete. By default `videos/<agent>-<instruction>.mp4` in the run folder or the current one; the name
    also tells start area, seed, robot and physics where they are not the default."""

    physics: bool = False
    """Let the robot act: motors, free objects, contacts; prints what became of it in 2D and 3D."""

    closed_loop: Literal["geometric", "camera"] | None = None
    """The agent's inputs come from the acting robot: objects seen where they are, or by a rendered camera."""

    video: bool = True
    """Only print what became of the acting robot's trial."""

    @property
    def acts(self) -> bool:
        """Whether the robot acts rather than follows."""
        return self.physics or self.closed_loop is not None

    def run(self) -> int:
        """Record the trials and let the humanoid follow them, or carry them out."""
        if not self.video and not self.acts:
            raise ValueError("without a video there is nothing to do but physics; add --physics")
        whole = self.instruction.strip().lower() == ALL
        if whole and not self.video:
            raise ValueError("all instructions are a video; count them without one by: wordarm agree")
        instruction = None if whole else Instruction.parse(self.instruction)

        from models.robots import get_robot

        get_robot(self.robot)  # refuses unknown names before anything is made
        source = self.find_agent()
        if instruction is None:
            self._show_all(source)
        else:
            self._show(source, instruction)
        return 0

    def _show(self, source: Agent, instruction: Instruction) -> None:
        """One instruction."""
        from mujoco_port.film.physical_port import port_physical_trial
        from mujoco_port.film.port import port_trial

        record = self._record(source, instruction)
        output = self._place(source, str(instruction))
        if not self.acts:
            port_trial(record, output, robot=self.robot, genotype=source.genotype, quality=self.quality)
        else:
            verdict = port_physical_trial(
                record,
                source.genotype,
                output if self.video else None,
                robot=self.robot,
                closed_loop=self.closed_loop,
                quality=self.quality,
            )
            print(f"2D: {'carried out' if record.success else 'not carried out'}")
            print(f"3D: {'carried out' if verdict.success else 'not carried out: ' + verdict.reason}")
        if self.video:
            print(output)

    def _show_all(self, source: Agent) -> None:
        """All nine instructions in one video, and its last picture."""
        from mujoco_port.film.physical_port import port_physical_gallery
        from mujoco_port.film.port import port_gallery

        condition = papers_condition(source.condition, "the gallery of nine")
        records = [self._record(source, instruction) for instruction in condition.instructions]
        output = self._place(source, "gallery")
        title, rates = headline(source, condition)
        if not self.acts:
            paths = port_gallery(records, title, output, robot=self.robot, quality=self.quality, rates=rates)
        else:
            paths, verdicts = port_physical_gallery(
                records,
                source.genotype,
                title,
                output,
                robot=self.robot,
                closed_loop=self.closed_loop,
                quality=self.quality,
                rates=rates,
            )
            for record, verdict in zip(records, verdicts, strict=True):
                planar = "carried out" if record.success else "not carried out"
                spatial = "carried out" if verdict.success else f"not carried out: {verdict.reason}"
                print(f"{record.instruction}: 2D {planar}, 3D {spatial}")
        for path in paths:
            print(path)

    def _record(self, source: Agent, instruction: Instruction) -> TrialRecord:
        """The trial, as the planar arm carries it out."""
        from evolution.agents.recording import record_instruction

        return record_instruction(source, instruction, self.start_area, self.trial_seed)

    def _place(self, source: Agent, what: str) -> Path:
        """Where the video goes, its folder made; the robot is refused first if it cannot act."""
        from evolution.runs.storage import make_folder
        from mujoco_port.film.names import film_name
        from mujoco_port.film.physical_port import check_acts
        from mujoco_port.film.port import check_films

        home = Path() if source.folder is None else source.folder.path
        name = film_name(
            source.name,
            what,
            start_area=self.start_area,
            trial_seed=self.trial_seed,
            robot=self.robot,
            physics=self.acts,
            closed_loop=self.closed_loop,
        )
        output = self.output or home / "videos" / name
        if self.video:
            if self.acts:
                check_acts(self.robot)
            check_films()
            make_folder(output.parent)
        return output


def headline(source: Agent, condition: Condition) -> tuple[str, NDArray[np.float64]]:
    """What stands above a gallery, and the rates [9] in its cells: one trial shows how, not how often."""
    from evolution.agents.subtasks import usually
    from evolution.search.evaluation import evaluate

    counted = evaluate(source.genotype, condition, source.readings)
    obeyed = usually(counted.successes[0].sum(axis=-1)).sum()
    title = (
        f"{source.name}: {obeyed} of nine instructions succeed in more than 75 % of {counted.trials} trials"
    )
    return title, counted.success[0]
