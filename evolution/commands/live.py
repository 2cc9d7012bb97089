"""`wordarm live`: an agent in an acting humanoid, in a web page."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from evolution.commands.agent import AgentCommand


@dataclass(frozen=True, kw_only=True)
class Live(AgentCommand):
    """Let the humanoid act in a web page in real time: words are chosen and changed, objects moved there."""

    start_area: Literal["right", "left"] = "right"
    """Where S1 starts."""

    trial_seed: int = 0
    """Start angle and object positions follow from it."""

    robot: str = "icub"
    """Which humanoid; an unknown name lists those there are."""

    closed_loop: Literal["geometric", "camera"] | None = None
    """The agent's inputs come from the acting robot: objects seen where they are, or by a rendered camera."""

    host: str = "127.0.0.1"
    """Where to listen. Anything but this machine's own address asks for the token in the printed address."""

    port: int = 8080
    """Of the page; 0 for any that is free."""

    def run(self) -> int:
        """Serve the page until Ctrl-C."""
        from arm2d import Trials, draw_trials
        from evolution.search.randomness import Purpose, generator
        from mujoco_port.live.actor import Actor
        from mujoco_port.live.live import show_live

        source = self.find_agent()
        instructions = source.condition.instructions

        def draw(area: str, seed: int) -> Trials:  # as `wordarm port` does
            trials = draw_trials([instructions[0]], 1, source.readings, generator(seed, Purpose.RECORDING))
            return trials[("right", "left").index(area)]

        show_live(
            Actor(source.name, source.genotype, source.readings, instructions),
            draw,
            lambda address: print(f"open {address} in a browser; Ctrl-C ends", flush=True),
            robot=self.robot,
            closed_loop=self.closed_loop,
            area=self.start_area,
            seed=self.trial_seed,
            host=self.host,
            port=self.port,
        )
        return 0
