"""One trial of an agent, recorded step by step."""

from __future__ import annotations

from dataclasses import replace

from arm2d import Instruction, TrialRecord, draw_trials, record_trial
from arm2d.instructions import instruction_of
from arm2d.tasks.task import check_asked, task_of
from arm2d.trials import StartArea, area_index
from evolution.runs.sources import Agent
from evolution.search.randomness import Purpose, generator


def record_instruction(
    agent: Agent, instruction: Instruction | str, start_area: StartArea, trial_seed: int
) -> TrialRecord:
    """An agent carrying out an instruction from a freshly drawn start.

    Args:
        agent: Who carries it out.
        instruction: One of the nine of its condition; text such as "touch green" will do.
        start_area: Where S1 starts.
        trial_seed: Draws start angle and object positions.

    Raises:
        ValueError: If the agent's condition has no such instruction, or there is no such area.
    """
    asked = instruction_of(instruction)
    check_asked([asked], agent.condition)
    rng = generator(trial_seed, Purpose.RECORDING)
    trials = draw_trials([asked], 1, agent.readings, rng, agent.condition)
    record = record_trial(agent.genotype, trials[area_index(start_area)], agent.readings)
    return replace(record, task=task_of(agent.condition))  # films show the words that the agent knows
