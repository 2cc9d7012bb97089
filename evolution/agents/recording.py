"""One trial of an agent, recorded step by step."""

from __future__ import annotations

from dataclasses import replace

from arm2d import Instruction, TrialRecord, draw_trials, record_trial
from arm2d.tasks.task import task_of
from arm2d.trials import StartArea, area_index
from evolution.runs.sources import Agent
from evolution.search.randomness import Purpose, generator


def record_instruction(
    agent: Agent, instruction: Instruction, start_area: StartArea, trial_seed: int
) -> TrialRecord:
    """An agent carrying out an instruction from a freshly drawn start.

    Args:
        agent: Who carries it out.
        instruction: One of the nine of its condition.
        start_area: Where S1 starts.
        trial_seed: Draws start angle and object positions.

    Raises:
        ValueError: If the agent's condition has no such instruction, or there is no such area.
    """
    known = agent.condition.instructions
    if instruction not in known:
        raise ValueError(
            f"{agent.condition} has no instruction {instruction}; "
            f"it has {', '.join(str(word) for word in known)}"
        )
    rng = generator(trial_seed, Purpose.RECORDING)
    trials = draw_trials([instruction], 1, agent.readings, rng, agent.condition)
    record = record_trial(agent.genotype, trials[area_index(start_area)], agent.readings)
    return replace(record, task=task_of(agent.condition))  # films show the words that the agent knows
