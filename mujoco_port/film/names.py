"""What a film is called if nobody names it: short, and never the name of another trial's."""

from __future__ import annotations

from typing import Final, Literal

PHYSICS: Final = "physics"


def film_name(
    agent: str,
    what: str,
    *,
    start_area: Literal["right", "left"] = "right",
    trial_seed: int = 0,
    robot: str = "icub",
    physics: bool = False,
    closed_loop: str | None = None,
) -> str:
    """Such as `champion-move-red.mp4` or `champion-move-red-left-seed-3-physics.mp4`.

    Only what is not the default is told, so that a plain film has a plain name.

    Args:
        agent: Its name.
        what: The instruction in words, such as "MOVE Red", or "gallery".
        start_area: Where S1 starts.
        trial_seed: What start angle and objects are drawn with.
        robot: Who carries it out.
        physics: Whether it acts.
        closed_loop: Where the agent's inputs come from, if from the acting robot.
    """
    parts = [agent, *what.lower().split()]
    parts += [start_area] if start_area != "right" else []
    parts += [f"seed-{trial_seed}"] if trial_seed else []
    parts += [robot] if robot != "icub" else []
    parts += [closed_loop or PHYSICS] if physics or closed_loop else []
    return "-".join(parts) + ".mp4"
