"""Steps a second of worlds that controllers of one's own drive.

    python -m benchmarks.stepping

N trials take random turns, those that end begin anew. `VectorWorld` is compared with a Python loop over
`World` and, where gymnasium is installed, with its vector environments, in turn, in one process bound to
one core. CPU time; medians of the rounds.
"""

from __future__ import annotations

import importlib.util
import os
import time
from collections.abc import Callable
from statistics import median

import numpy as np
from rich.console import Console
from rich.table import Table

from arm2d import Condition, Readings, VectorWorld, World, draw_trials

N = 4096
ROUNDS = 7
STEPS = 200  # of all trials, in a round ...
FEWER_STEPS = {"SyncVectorEnv": 20}  # ... where that would take too long
SLOW = {"World, one after the other": 16, "SyncVectorEnv": 64}  # trials, instead of N


def vector_world(n: int) -> Callable[[int], None]:
    """The compiled vector."""
    instructions, readings = Condition.WITH_INDICATE.experienced, Readings()
    rng = np.random.default_rng(1)
    world = VectorWorld(draw_trials(instructions, -(-n // 14), readings, rng)[:n], readings)
    turns = rng.integers(-1, 2, (16, n, 2))

    def step(k: int) -> None:
        world.step(turns[k % 16])
        if len(over := np.flatnonzero(world.ended)):
            starts = draw_trials(instructions, -(-len(over) // 14), readings, rng)
            world.restart(over, starts[rng.permutation(len(starts))[: len(over)]])

    return step


def python_loop(n: int) -> Callable[[int], None]:
    """One `World` after the other."""
    worlds, rng = [World() for _ in range(n)], np.random.default_rng(1)
    for world in worlds:
        world.reset("touch red", seed=int(rng.integers(1000)))
    turns = rng.integers(-1, 2, (16, n, 2))

    def step(k: int) -> None:
        for world, turn in zip(worlds, turns[k % 16], strict=True):
            if world.ended:
                world.reset("touch red", seed=k)
            world.step(turn)

    return step


def gymnasium_vector(n: int, mode: str) -> Callable[[int], None]:
    """Gymnasium's own vector of worlds, or ours."""
    import gymnasium

    import arm2d.worlds.environment

    worlds = gymnasium.make_vec(arm2d.worlds.environment.NAME, num_envs=n, vectorization_mode=mode)
    worlds.reset(seed=1)
    actions = np.random.default_rng(1).integers(0, 3, (16, n, 2))
    return lambda k: worlds.step(actions[k % 16]) and None


def main() -> None:
    """Measure in turn, print the table."""
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    makers: dict[str, Callable[[int], Callable[[int], None]]] = {
        "VectorWorld": vector_world,
        "World, one after the other": python_loop,
    }
    if importlib.util.find_spec("gymnasium"):
        makers["gymnasium.make_vec"] = lambda n: gymnasium_vector(n, "vector_entry_point")
        makers["SyncVectorEnv"] = lambda n: gymnasium_vector(n, "sync")
    trials = {name: SLOW.get(name, N) for name in makers}
    steps = {name: make(trials[name]) for name, make in makers.items()}
    rates: dict[str, list[float]] = {name: [] for name in makers}
    for _ in range(ROUNDS):
        for name, step in steps.items():
            count = FEWER_STEPS.get(name, STEPS)
            began = time.process_time()
            for k in range(count):
                step(k)
            rates[name].append(count * trials[name] / (time.process_time() - began))
    table = Table("worlds", "trials", "million steps a second")
    for name, measured in sorted(rates.items(), key=lambda item: -median(item[1])):
        table.add_row(name, str(trials[name]), f"{median(measured) / 1e6:.3g}")
    Console().print(table)


if __name__ == "__main__":
    main()
