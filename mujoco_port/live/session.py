"""What viewers share: one robot, one trial, one clock. It knows neither page nor socket.

session = Session(lab, actor, draw_start)
session.do(Say.both(Instruction.parse("touch red")))
session.do(Run(True))
moment = session.tick()   # what is to be seen 1/25 s later
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from arm2d import NON_EXPERIENCED, Instruction, ObjectWord
from arm2d.constants import BETA_MAX, DT
from arm2d.records import brief
from mujoco_port.acting.lab import Lab
from mujoco_port.acting.rollout import Eyes
from mujoco_port.film.take import Neurons, thinking
from mujoco_port.live.actor import Actor
from mujoco_port.live.orders import Again, Loop, Order, Place, Reset, Run, Say, Speed
from mujoco_port.live.placing import Placing
from mujoco_port.live.trial import LiveTrial, Start, Stretch

FRAMES_PER_SECOND: Final = 25
FIRST: Final = 4  # TOUCH Green, which no agent met during evolution
# Draws a start in an area, "right" or "left", with a seed.
DrawStart = Callable[[str, int], Start]


@dataclass(frozen=True)
class Moment:
    """What is to be seen now.

    Attributes:
        seconds: [s] since the start.
        angles: [J] in [rad].
        head: [H] in [rad], of neck and eyes.
        places: [3, 7], of the objects: centre in [m] and quaternion.
        touched: [3], which objects are touched.
        planar: [2] in [deg], alpha and beta.
        jumped: Whether the robot has been put there since the moment before.
    """

    seconds: float
    angles: NDArray[np.float64]
    head: NDArray[np.float64]
    places: NDArray[np.float64]
    touched: NDArray[np.bool_]
    planar: NDArray[np.float64]
    jumped: bool

    __repr__ = brief


class Session:
    """One robot that takes orders.

    Args:
        lab: The robot at its table.
        actor: Whose mind moves it.
        draw_start: How starts are drawn.
        closed: Whether the agent lives in the robot at first.
        eyes: What it sees in closed loop; without, it knows where the objects are.
        area: Where S1 starts at first, and
        seed: with what seed.

    Attributes:
        version: Grows whenever there is more to tell than where things are.

    Raises:
        ValueError: If the table is not laid for the actor's world.
    """

    def __init__(
        self,
        lab: Lab,
        actor: Actor,
        draw_start: DrawStart,
        *,
        closed: bool = False,
        eyes: Eyes | None = None,
        area: str = "right",
        seed: int = 0,
    ) -> None:
        self._lab, self._actor, self._draw, self._eyes = lab, actor, draw_start, eyes
        lab.check_world(actor.readings)
        self._placing = Placing(lab.body.robot.plane)
        self._instruction = actor.instructions[FIRST]
        self._closed, self._speed, self._area, self._seed = closed, 1.0, area, seed
        self._start = draw_start(area, seed)
        self._rows = float(lab.body.steps_per_turn)
        self.version = 0
        self._prepare()

    @property
    def running(self) -> bool:
        """Whether time goes on."""
        return self._phase == "running" and not self._paused

    def do(self, order: Order) -> None:
        """Obey an order.

        Raises:
            ValueError: If it cannot be obeyed now, in a sentence for the viewer.
        """
        match order:
            case Say(action, object_):
                heard = self._instruction
                self._say(
                    Instruction(
                        heard.action if action is None else action,
                        heard.object if object_ is None else object_,
                    )
                )
            case Place(object_, x, y):
                self._place(object_, x, y)
            case Reset(area, seed):
                self._area = self._area if area is None else area
                self._seed = self._seed if seed is None else seed
                self._start = self._draw(self._area, self._seed)
                self._prepare()
            case Again():
                self._prepare()
            case Loop(closed):
                self._closed = closed
                self._prepare()
            case Speed(factor):
                self._speed = factor
            case Run(on):
                self._run(on)
        self.version += 1

    def tick(self) -> Moment:
        """Let 1/25 s go by, if time goes on; what is to be seen then."""
        if self.running:
            self._row += self._speed * self._rows / (FRAMES_PER_SECOND * DT)
            while self._row > self._rows and self.running:
                self._advance()
        jumped, self._jumped = self._jumped, False
        stretch, row = self._stretch, max(int(self._row) - 1, 0)
        return Moment(
            DT * max(0.0, self._trial.steps - 1 + self._row / self._rows),
            stretch.angles[row],
            stretch.head[row],
            stretch.places[row],
            stretch.touched[row],
            stretch.planar[row],
            jumped,
        )

    def state(self) -> dict[str, Any]:
        """Everything but where things are, for a page."""
        trial = self._trial
        verdict, planar = trial.verdict, trial.planar.judgement.success
        return {
            "phase": self._phase,
            "paused": self._paused,
            "words": [self._instruction.action.name, self._instruction.object.name],
            "met": self._instruction not in NON_EXPERIENCED,
            "closed": self._closed,
            "speed": self._speed,
            "area": self._area,
            "seed": self._seed,
            "step": trial.steps,
            "inputs": self._inputs.tolist(),
            "motors": np.round(self._motors, 4).tolist(),
            "rates": np.round(self._rates[-1], 4).tolist() if self._rates else None,
            "changes": self._changes,
            "share": round(trial.share, 4),
            # The 2D world is ahead of the robot: it does not tell before the robot has been judged, too.
            "planar": planar if trial.ended else None,
            "robot": None if verdict is None else {"success": verdict.success, "reason": verdict.reason},
            "fault": self._fault,
        }

    def traces(self) -> list[list[float]]:
        """Rates [K, N] of the inter-neurons since the start, for whoever comes later."""
        return np.round(self._rates, 4).tolist()

    def _prepare(self) -> None:
        """Stand at the start."""
        actor = self._actor
        self._trial = LiveTrial(
            self._lab,
            actor.genotype,
            actor.readings,
            self._instruction,
            self._start,
            closed=self._closed,
            eyes=self._eyes,
        )
        self._neurons: Neurons = thinking(actor.genotype, actor.readings)
        self._rates: list[NDArray[np.float64]] = []
        self._motors, self._inputs = np.zeros(4), np.zeros(18)
        self._changes: list[tuple[int, str]] = [(0, str(self._instruction))]
        self._phase, self._paused, self._fault, self._jumped = "ready", False, "", True
        body, rows = self._lab.body, self._lab.body.steps_per_turn
        self._stretch = Stretch(
            np.tile(body.angles, (rows, 1)),
            np.tile(body.head, (rows, 1)),
            np.tile(body.places, (rows, 1, 1)),
            np.zeros((rows, 3), bool),
            np.tile([self._start.alpha, BETA_MAX], (rows, 1)),
        )
        self._row = self._rows  # physics steps of the stretch that have been seen

    def _say(self, instruction: Instruction) -> None:
        if instruction not in self._actor.instructions:
            known = ", ".join(str(each) for each in self._actor.instructions)
            raise ValueError(f"this agent has no instruction {instruction}; it has {known}")
        if instruction == self._instruction and self._phase != "ended":
            return
        self._instruction = instruction
        if self._phase == "ready":
            self._prepare()
            return
        if self._fault:
            raise ValueError("this trial broke off; go back to the start")
        self._trial.say(instruction)
        self._changes = [*self._changes, (self._trial.steps, str(instruction))]
        self._phase, self._paused = "running", False if self._phase == "ended" else self._paused

    def _place(self, object_: ObjectWord, x: float, y: float) -> None:
        """Put an object somewhere between two trials; the others stand where they lie."""
        if self._phase == "running":
            raise ValueError(
                "objects are moved between trials; wait for the verdict, or go back to the start"
            )
        discs = self._start.discs if self._phase == "ready" else self._lying()
        self._start = Start(self._start.alpha, self._placing.placed(discs, object_, x, y))
        self._prepare()

    def _lying(self) -> NDArray[np.float64]:
        """Where the objects lie now, [3, 2] in [cm], or stood at the start if they lie in a heap."""
        places = self._stretch.places[-1, :, :2] / self._lab.body.robot.plane.scale
        standing = self._placing.standing(places)
        return self._start.discs if standing is None else standing

    def _run(self, on: bool) -> None:
        if on and self._phase == "ended":
            raise ValueError("the trial is over; say other words, or go back to the start")
        if on:
            self._phase = "running"
        self._paused = not on and self._phase == "running"

    def _advance(self) -> None:
        """Carry out the next control step, or end the trial."""
        if self._trial.ended:
            self._phase, self._row = "ended", self._rows
            self.version += 1
            return
        self._row -= self._rows
        try:
            self._stretch = self._trial.step()
        except ValueError as error:  # out of reach, or unstable
            self._fault, self._phase, self._row = str(error), "ended", self._rows
        else:
            self._inputs = self._trial.inputs
            rates, self._motors = self._neurons(self._inputs)
            self._rates.append(rates)
        self.version += 1
