"""What environments are asked for: which trials, which instructions, which turns of the joints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from reprlib import repr as shortened
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d.instructions import Instruction, instruction_of, instructions_of
from arm2d.readings import Readings, given_or_default
from arm2d.tasks.task import AnyTask, as_paper, check_asked
from arm2d.trials import Trials, draw_trials

Asked = Literal["experienced", "held-out", "all"]
Reward = Literal["end", "progress"]


def asked_instructions(
    condition: AnyTask, asked: Asked | Sequence[Instruction | str]
) -> tuple[Instruction, ...]:
    """The instructions that trials are drawn from.

    Args:
        condition: Which instructions there are.
        asked: The seven experienced ones, the two held out, all nine, or instructions, as records or as text
            such as "touch red".

    Raises:
        ValueError: If it is none of these, or an instruction is not one of the condition's.
    """
    if isinstance(asked, str):
        choices = {
            "experienced": condition.experienced,
            "held-out": condition.held_out,
            "all": condition.instructions,
        }
        if asked not in choices:
            raise ValueError(
                f"asked for {asked!r} instructions; there are {', '.join(choices)}, or a list of them"
            )
        if not choices[asked]:
            raise ValueError(f"the task {condition} holds out no instruction; ask for experienced or all")
        return choices[asked]
    chosen = instructions_of(asked)
    if not chosen:
        raise ValueError("asked for an empty list of instructions; give at least one, such as 'touch red'")
    check_asked(chosen, condition)
    return tuple(chosen)


def turns_of(actions: ArrayLike, shape: tuple[int, ...]) -> NDArray[np.int64]:
    """Actions 0, 1 and 2 as turns -1, 0 and 1.

    Raises:
        ValueError: If they have another shape or are anything else.
    """
    given = np.asarray(actions)
    if given.shape != shape or given.dtype.kind not in "iuf":
        raise ValueError(
            f"actions must be an array {list(shape)} of 0, 1 and 2, not {given.dtype} {list(given.shape)}"
        )
    possible = (given == 0) | (given == 1) | (given == 2)
    if not possible.all():
        raise ValueError(
            f"an action of {given[~possible][0]:g} was given; each is 0, 1 or 2, for a turn of -1, 0 or 1"
        )
    return given.astype(np.int64) - 1


class Source:
    """What trials are drawn from, for an environment of one trial or of many."""

    def __init__(
        self,
        condition: AnyTask | str,
        asked: Asked | Sequence[Instruction | str],
        readings: Readings | None,
        reward: Reward,
    ) -> None:
        if reward not in get_args(Reward):
            raise ValueError(f"reward = {shortened(reward)}; choose {' or '.join(get_args(Reward))}")
        self.condition = as_paper(condition)
        self.instructions = asked_instructions(self.condition, asked)
        self.readings = given_or_default(readings)

    def draw(self, n: int, rng: np.random.Generator) -> Trials:
        """N trials, each of any of the instructions and from either start area."""
        chosen = [self.instructions[i] for i in rng.integers(len(self.instructions), size=n)]
        drawn = draw_trials(chosen, 1, self.readings, rng, self.condition)
        return drawn[2 * np.arange(n) + rng.integers(2, size=n)]

    def first(self, n: int, rng: np.random.Generator, options: Mapping[str, Any] | None) -> Trials:
        """The same after a reset, all of the instruction that its options may name."""
        drawn = self.draw(n, rng)
        if not options or "instruction" not in options:
            return drawn
        asked = instruction_of(options["instruction"])
        check_asked([asked], self.condition)
        words = np.full(n, asked.action), np.full(n, asked.object)
        return Trials(*words, drawn.alpha, drawn.discs, task=drawn.task)
