"""What a reproduction of the paper does once its runs are evolved and tested: a look at agents."""

from __future__ import annotations

from pathlib import Path

from evolution.agents.classes import Sampling, observation_path
from evolution.agents.subtasks import AgentClass
from evolution.child import reference
from evolution.commands.behaviour import BehaviourCommand
from evolution.commands.classes import Classes
from evolution.commands.lineage import LineageCommand
from evolution.experiments.plan import LOGS
from evolution.experiments.workers import Job
from evolution.results.notable import best_agent
from evolution.results.records import Results


def agent_chains(results: Results, folder: Path) -> list[list[Job]]:
    """What is still to be drawn of the best agent of each condition: its ancestors, and how it does it."""
    chains = []
    for condition, each in results.conditions.items():
        if (agent := best_agent(each)) is None:
            continue
        path, stem = agent.run.path, f"generation-{agent.generation:06d}-rank-{agent.rank}"
        name, log = f"{condition}, its best agent", folder / LOGS / f"{condition}-best-agent.log"
        which = {"folder": str(path), "generation": agent.generation, "rank": agent.rank}
        for function, stage, done in (
            (trace_ancestors, "tracing ancestors", path / "lineage" / f"{stem}.npz"),
            (observe_agent, "observing", path / "behaviour" / f"{stem}-behaviour.npz"),
        ):
            if not done.exists():
                chains.append([Job(name, stage, reference(function), which, path, log)])
    return chains


def class_chains(results: Results, folder: Path) -> list[list[Job]]:
    """What is still to be observed of the classes of agents, run by run."""
    chains = []
    for condition, each in results.conditions.items():
        for index, run in enumerate(each.runs):
            some = any(each.members[kind][index] for kind in AgentClass)
            if some and not observation_path(run, Sampling()).exists():
                log = folder / LOGS / f"{condition}-seed-{run.config.seed:04d}.log"
                name, which = f"{condition}, seed {run.config.seed}", {"folder": str(run.path)}
                job = Job(name, "observing classes", reference(observe_classes), which, run.path, log)
                chains.append([job])
    return chains


def trace_ancestors(folder: str, generation: int, rank: int) -> int:
    """`wordarm lineage` of an agent, in a process of its own."""
    return LineageCommand(Path(folder), generation, rank).run()


def observe_agent(folder: str, generation: int, rank: int) -> int:
    """`wordarm behaviour` of an agent, in a process of its own."""
    return BehaviourCommand(folder, generation=generation, rank=rank).run()


def observe_classes(folder: str) -> int:
    """`wordarm classes` of a run, in a process of its own, without its figures."""
    return Classes(Path(folder), figures=False).run()
