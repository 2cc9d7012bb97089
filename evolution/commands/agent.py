"""What commands about one agent have in common: how the agent is named."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from tyro.conf import Positional, arg

from arm2d import Condition

if TYPE_CHECKING:
    from evolution.runs.sources import Agent


@dataclass(frozen=True)
class AgentCommand:
    """The options of a command about one agent."""

    source: Annotated[Positional[str], arg(metavar="AGENT")]
    """Run folder, genotype file (.npz, .npy) or name of a shipped champion."""

    generation: int | None = None
    """Generation of the run, from 0. By default its champions are meant."""

    rank: int = 0
    """0 is the best of the generation, of the champions, or of the file."""

    condition: str | None = None
    """Condition of a bare genotype file: with-indicate (the default) or with-ignore."""

    def find_agent(self) -> Agent:
        """The agent's genotype and its world."""
        from evolution.runs.sources import find_agent

        condition = None if self.condition is None else Condition.parse(self.condition)
        return find_agent(self.source, generation=self.generation, rank=self.rank, condition=condition)
