"""One trial of an agent, recorded step by step."""

from __future__ import annotations

from typing import Literal

from arm2d import Instruction, TrialRecord, draw_trials, record_trial
from evolution.runs.sources import Source
from evolution.search.randomness import Purpose, generator


def record_instruction(
    source: Source, instruction: Instruction, start_area: Literal["right", "left"], trial_seed: int
) -> TrialRecord:
    """An agent carrying out an instruction from a freshly drawn start.

    Args:
        source: The agent.
        instruction: One of the nine of its condition.
        start_area: Where S1 starts.
        trial_seed: Draws start angle and object positions.

    Raises:
        ValueError: If the agent's condition has no such instruction.
    """
    known = source.condition.instructions
    if instruction not in known:
        raise ValueError(
            f"{source.condition} has no instruction {instruction}; "
            f"it has {', '.join(str(each) for each in known)}"
        )
    trials = draw_trials([instruction], 1, source.readings, generator(trial_seed, Purpose.RECORDING))
    return record_trial(source.genotype, trials[("right", "left").index(start_area)], source.readings)
