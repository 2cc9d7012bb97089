"""From an agent to an address: what `wordarm live` does."""

from __future__ import annotations

import asyncio
import errno
import socket
from collections.abc import Callable
from contextlib import ExitStack
from typing import TYPE_CHECKING, Final, Literal

from arm2d import Trials
from models.robots import Robot, get_robot
from mujoco_port.film.gl import drawing, refuse_other_renderer, without_drawing
from mujoco_port.live.actor import Actor
from mujoco_port.live.door import Door, door_for

if TYPE_CHECKING:
    from mujoco_port.acting.lab import Lab
    from mujoco_port.acting.rollout import Eyes

LARGEST_PORT: Final = 65535
FINER: Final = 4.0  # triangles for a card that draws, of those that do for a processor
ClosedLoopName = Literal["geometric", "camera"]


def show_live(
    actor: Actor,
    draw: Callable[[str, int], Trials],
    say: Callable[[str], None],
    *,
    robot: str = "icub",
    closed_loop: ClosedLoopName | None = None,
    area: str = "right",
    seed: int = 0,
    host: str = "127.0.0.1",
    port: int = 8080,
) -> None:
    """Let a robot act in a web page until Ctrl-C.

    Args:
        actor: Whose mind moves it.
        draw: Draws a trial to start from, in the area "right" or "left" and with a seed; a batch of one.
        say: Told the address, once whoever comes is let in.
        robot: Name of a record in `models.robots`.
        closed_loop: What the agent sees with, if it is to live in the robot from the beginning.
        area: Where S1 starts, "right" or "left".
        seed: Of the first start.
        host: Where to listen; anything but this machine's own address asks for a token.
        port: 0 for one that is free.

    Raises:
        ValueError: If host or port cannot be listened at, or a package is missing.
        NoPhysicsError, UnknownRobotError, NoRenderingError: As `port_physical_trial`.
    """
    chosen = get_robot(robot)
    _check_installed()
    with ExitStack() as stack:
        listening = stack.enter_context(listen(host, port))
        stack.enter_context(drawing() if closed_loop == "camera" else without_drawing())
        from mujoco_port.acting.lab import Lab
        from mujoco_port.live.files import page_files
        from mujoco_port.live.posture import Posture
        from mujoco_port.live.scene import scene
        from mujoco_port.live.server import Server
        from mujoco_port.live.session import Session
        from mujoco_port.live.trial import Start

        def draw_start(area: str, seed: int) -> Start:
            trial = draw(area, seed)
            return Start(float(trial.alpha[0]), trial.discs[0])

        lab, door = Lab(chosen, actor.readings), door_for(host)
        laid = lab.body.robot
        posture = Posture(laid)
        session = Session(
            lab,
            actor,
            draw_start,
            closed=closed_loop is not None,
            eyes=_eyes(stack, lab, actor) if closed_loop == "camera" else None,
            area=area,
            seed=seed,
        )
        scenes = {
            "scene-coarse": lambda: scene(posture, laid, actor.readings),
            "scene-fine": lambda: scene(Posture(laid, FINER), laid, actor.readings),
        }
        greeting = greeting_of(actor, chosen, closed_loop)
        server = Server(session, posture, page_files(scenes), door, greeting)
        asyncio.run(server.run(listening, lambda: say(address(listening, host, door))))


def listen(host: str, port: int) -> socket.socket:
    """A socket that takes connections.

    Raises:
        ValueError: If there is none to be had, with the next move.
    """
    if not 0 <= port <= LARGEST_PORT:
        raise ValueError(
            f"--port {port} is no port; give one from 1 to {LARGEST_PORT}, or 0 for any free one"
        )
    try:
        family, kind, number, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except (OSError, UnicodeError):
        raise ValueError(
            f"--host {host} is no address of this machine; give one, such as 127.0.0.1, or 0.0.0.0 for all"
        ) from None
    listening = socket.socket(family, kind, number)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind(place)
        listening.listen()
    except OSError as error:
        listening.close()
        if error.errno == errno.EADDRINUSE:
            raise ValueError(
                f"port {port} of {host} is in use; give another with --port, or --port 0 for any free one"
            ) from None
        raise ValueError(f"cannot listen at port {port} of {host} ({error.strerror})") from None
    return listening


def address(listening: socket.socket, host: str, door: Door) -> str:
    """What to open in a browser."""
    port = listening.getsockname()[1]
    name = socket.gethostname() if host in ("0.0.0.0", "::", "") else host  # noqa: S104 - compared only
    shown = f"[{name}]" if ":" in name else name
    return f"http://{shown}:{port}/" + (f"{door.token}/" if door.token else "")


def greeting_of(actor: Actor, robot: Robot, closed_loop: ClosedLoopName | None) -> dict[str, object]:
    """What a page is told once."""
    actions = dict.fromkeys(each.action.name for each in actor.instructions)
    return {
        "agent": actor.name,
        "robot": robot.title,
        "actions": list(actions),
        "eyes": closed_loop or "geometric",
    }


def _eyes(stack: ExitStack, lab: Lab, actor: Actor) -> Eyes:
    """A camera's, open as long as the page is served."""
    refuse_other_renderer()
    from mujoco_port.acting.camera import CameraEyes

    return stack.enter_context(CameraEyes(lab.body, actor.readings))


def _check_installed() -> None:
    """Refuse to begin without the extra's package."""
    try:
        import websockets  # noqa: F401
    except ImportError:
        raise ValueError(
            "the live page needs the package websockets; install it with: pip install 'wordarm[live]'"
        ) from None
