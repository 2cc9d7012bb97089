"""`wordarm port`: an agent's trial, carried out by the humanoid."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from tyro.conf import Positional

from arm2d import Condition, Instruction


@dataclass(frozen=True)
class Port:
    """Show an agent carrying out an instruction on the humanoid, as a video."""

    source: Positional[str]
    """Run folder, genotype file (.npz, .npy) or name of a shipped champion."""

    instruction: Positional[str]
    """An action word and an object word, such as "touch green"."""

    generation: int | None = None
    """Generation of the run, from 0. By default its champions are meant."""

    rank: int = 0
    """0 is the best of the generation, of the champions, or of the file."""

    condition: str | None = None
    """Condition of a bare genotype file: with-indicate (the default) or with-ignore."""

    start_area: Literal["right", "left"] = "right"
    """Where S1 starts: right or left."""

    trial_seed: int = 0
    """Start angle and object positions follow from it."""

    robot: str = "icub"
    """Which humanoid."""

    output: Path | None = None
    """The video. By default `videos/<agent>-<instruction>.mp4` in the run folder, or in the current one."""

    def run(self) -> int:
        """Record the trial and let the humanoid follow it."""
        instruction = Instruction.parse(self.instruction)
        condition = None if self.condition is None else Condition.parse(self.condition)

        from evolution.recording import record_instruction
        from evolution.sources import find_source

        source = find_source(self.source, generation=self.generation, rank=self.rank, condition=condition)
        record = record_instruction(source, instruction, self.start_area, self.trial_seed)
        raise NotImplementedError(f"the humanoid cannot follow {record.instruction} yet")
