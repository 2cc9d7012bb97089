"""Page and socket: viewers come and go, all see one session and may give it orders.

A viewer's socket brings it a greeting (JSON), the state whenever it changes (JSON), and 25 moments a second
(bytes: float32 seconds, alpha, beta, touched bits, then seven numbers for every body). A viewer that is slow
misses moments; nobody waits for it. While nobody looks, time stands still.
"""

from __future__ import annotations

import asyncio
import json
import logging
import socket
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from http import HTTPStatus
from typing import Any, Final

import numpy as np
from websockets.asyncio.server import ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from mujoco_port.live.door import Door
from mujoco_port.live.files import HEADERS, PageFile
from mujoco_port.live.orders import LONGEST, read_order
from mujoco_port.live.posture import Posture
from mujoco_port.live.session import FRAMES_PER_SECOND, Moment, Session

SOCKET: Final = "/socket"
MOST_VIEWERS: Final = 24
ORDER_PAUSE_S: Final = 0.01  # so often at most a viewer is listened to
LATE_S: Final = 0.5  # a clock that is so late does not hurry to catch up
POINTING: Final = "INDICATE"
# Whatever strangers send is answered or dropped; of it nothing is to be told in the terminal.
SILENT: Final = logging.getLogger("wordarm.live.socket")
SILENT.addHandler(logging.NullHandler())
SILENT.propagate = False


@dataclass(eq=False)
class Viewer:
    """Somebody who looks on."""

    connection: ServerConnection
    news: asyncio.Event = field(default_factory=asyncio.Event)
    told: int = -1  # version of the state


class Server:
    """One session for everybody who comes in.

    Args:
        session: What is shown.
        posture: How it is shown.
        files: The page, by path; made when they are asked for.
        door: Who may come in.
        greeting: What a viewer is told first.
    """

    def __init__(
        self,
        session: Session,
        posture: Posture,
        files: Mapping[str, Callable[[], PageFile]],
        door: Door,
        greeting: dict[str, Any],
    ) -> None:
        self._session, self._posture = session, posture
        self._files, self._door, self._greeting = files, door, greeting
        self._viewers: set[Viewer] = set()
        self._come = asyncio.Event()
        self._moment = b""
        self._state, self._version = "", -1
        self._show()

    async def run(self, listening: socket.socket, ready: Callable[[], None]) -> None:
        """Serve for ever; `ready` is called once whoever comes is let in."""
        async with serve(
            self._meet,
            sock=listening,
            process_request=self._answer,
            logger=SILENT,
            max_size=4 * LONGEST,
            max_queue=4,
            server_header=None,
            compression=None,
        ):
            ready()
            await self._keep_time()

    async def _keep_time(self) -> None:
        """Let the session's time go by while somebody looks."""
        clock = asyncio.get_running_loop()
        due = clock.time()
        while True:
            if not self._viewers:
                await self._come.wait()
                due = clock.time()
            self._show()
            due = max(due + 1.0 / FRAMES_PER_SECOND, clock.time() - LATE_S)
            await asyncio.sleep(due - clock.time())

    def _show(self) -> None:
        """Go on by a moment and let everybody know."""
        moment = self._session.tick()
        state, self._version = self._session.state(), self._session.version
        state["version"] = self._version
        self._state = json.dumps({"state": state}, separators=(",", ":"))
        pointing = state["words"][0] == POINTING
        self._moment = packed(moment, self._posture.poses(moment, pointing))
        for viewer in self._viewers:
            viewer.news.set()

    async def _meet(self, connection: ServerConnection) -> None:
        """Look after one viewer until it leaves."""
        if len(self._viewers) >= MOST_VIEWERS:
            await connection.close(1013, f"{MOST_VIEWERS} viewers look on already; come back later")
            return
        viewer = Viewer(connection)
        with suppress(ConnectionClosed):
            await connection.send(json.dumps({**self._greeting, "traces": self._session.traces()}))
            self._viewers.add(viewer)
            self._come.set()
            viewer.news.set()
            teller = asyncio.create_task(self._tell(viewer))
            try:
                await self._listen(viewer)
            finally:
                teller.cancel()
        self._viewers.discard(viewer)
        if not self._viewers:
            self._come.clear()

    async def _tell(self, viewer: Viewer) -> None:
        """Send the newest there is, again and again."""
        with suppress(ConnectionClosed):
            while True:
                await viewer.news.wait()
                viewer.news.clear()
                # Not the session's own version: an order may have come since its state was written down.
                if viewer.told != self._version:
                    viewer.told = self._version
                    await viewer.connection.send(self._state)
                await viewer.connection.send(self._moment)

    async def _listen(self, viewer: Viewer) -> None:
        """Obey a viewer; what cannot be obeyed is answered in a sentence."""
        async for text in viewer.connection:
            try:
                self._session.do(read_order(text))
            except ValueError as error:
                await viewer.connection.send(json.dumps({"refused": str(error)}))
            await asyncio.sleep(ORDER_PAUSE_S)

    def _answer(self, connection: ServerConnection, request: Request) -> Response | None:
        """The page's files; None lets a socket be opened."""
        if reason := self._door.refuses(request.headers):
            return _sentence(HTTPStatus.FORBIDDEN, reason)
        path = self._door.path(request.path)
        if path is None:
            return _sentence(
                HTTPStatus.FORBIDDEN, "the token is missing or wrong; take the address as it was printed"
            )
        if path == SOCKET:
            return None
        make = self._files.get(path)
        if make is None:
            return _sentence(HTTPStatus.NOT_FOUND, "there is no such page")
        file = make()
        headers = Headers({**HEADERS, "Content-Type": file.kind, "Content-Length": str(len(file.content))})
        return Response(HTTPStatus.OK, "OK", headers, file.content)


def packed(moment: Moment, poses: np.ndarray) -> bytes:
    """A moment as the page reads it."""
    touched = int(moment.touched @ (1, 2, 4))
    head = np.array([moment.seconds, *moment.planar, touched], dtype="<f4")
    return head.tobytes() + poses.astype("<f4").tobytes()


def _sentence(status: HTTPStatus, text: str) -> Response:
    """A short answer."""
    content = f"wordarm: {text}\n".encode()
    headers = {**HEADERS, "Content-Type": "text/plain; charset=utf-8", "Content-Length": str(len(content))}
    return Response(status, status.phrase, Headers(headers), content)
