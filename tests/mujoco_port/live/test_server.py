"""The page and its socket as a browser, or anybody else, meets them."""

import asyncio
import json
import os
import signal
import socket
import subprocess
import sys
import time
from contextlib import ExitStack
from urllib.parse import urlsplit

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from arm2d import Instruction
from mujoco_port.live.door import door_for
from mujoco_port.live.orders import Say
from mujoco_port.live.posture import Posture
from mujoco_port.live.server import MOST_VIEWERS, Server, Viewer
from tests.mujoco_port.live.serving import Served

PATIENCE = 60.0


@pytest.fixture(scope="module")
def served():
    with Served() as served:
        yield served


@pytest.fixture
def viewer(served):
    with connect(served.socket, max_size=None) as viewer:
        greeting = json.loads(viewer.recv(PATIENCE))
        assert greeting["actions"] == ["MOVE", "TOUCH", "INDICATE"]
        yield viewer
        ask(viewer, do="again")
        state(viewer, lambda told: told["phase"] == "ready")  # or the next one's orders may come before it


def ask(viewer, **order):
    viewer.send(json.dumps(order))


def told(viewer, until):
    """The first message in JSON of which something is true."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        message = viewer.recv(PATIENCE)
        if isinstance(message, str) and until(json.loads(message)):
            return json.loads(message)
    raise AssertionError("never told")


def state(viewer, until):
    return told(viewer, lambda news: "state" in news and until(news["state"]))["state"]


def moments(viewer, number):
    got = []
    while len(got) < number:
        message = viewer.recv(PATIENCE)
        got += [message] if isinstance(message, bytes) else []
    return got


def test_the_page_and_all_that_it_asks_for_is_there(served):
    status, page = served.get()
    assert status == 200
    assert "<title>A robot that obeys two words</title>" in page
    for name in ("main.js", "live.css", "drawing.js", "scene-coarse", "scene-fine"):
        assert served.get(served.address + name)[0] == 200, name


@pytest.mark.parametrize(
    "path", ["nothing", "../server.py", "%2e%2e/server.py", "index.html", "page/main.js"]
)
def test_nothing_else_is(served, path):
    assert served.get(served.address + path) == (404, "wordarm: there is no such page\n")


def test_a_trial_is_carried_out_and_judged_before_a_viewers_eyes(viewer):
    ask(viewer, do="speed", factor=4)
    ask(viewer, do="say", words="move red")
    ask(viewer, do="run", on=True)
    told_last = state(viewer, lambda told: told["phase"] == "ended")
    assert told_last["robot"] == {"success": True, "reason": "carried out"}
    assert told_last["planar"] is True
    ask(viewer, do="speed", factor=1)


def test_what_an_order_changes_just_before_older_news_is_told_is_told_too(session, lab):
    """The order comes between a state's writing down and its telling."""
    server = Server(session, Posture(lab.body.robot), {}, door_for("127.0.0.1"), {})
    viewer = Viewer(Heard())

    async def meet():
        server._viewers.add(viewer)
        teller = asyncio.create_task(server._tell(viewer))
        for order in (Say.both(Instruction.parse("move red")), None):
            server._show()
            if order is not None:
                session.do(order)
            for _ in range(5):  # turns for the teller
                await asyncio.sleep(0)
        teller.cancel()

    asyncio.run(meet())
    states = [json.loads(each)["state"] for each in viewer.connection.heard if isinstance(each, str)]
    assert [state["words"] for state in states] == [["TOUCH", "GREEN"], ["MOVE", "RED"]]


class Heard:
    """A connection that keeps what is sent."""

    def __init__(self):
        self.heard = []

    async def send(self, message):
        self.heard.append(message)


def test_all_see_the_same_and_one_who_leaves_is_not_missed(served, viewer):
    ask(viewer, do="say", words="indicate blue")
    ask(viewer, do="run", on=True)
    with connect(served.socket, max_size=None) as other:
        other.recv(PATIENCE)
        told(other, lambda news: "state" in news and news["state"]["words"] == ["INDICATE", "BLUE"])
    with connect(served.socket, max_size=None) as rude:
        rude.recv(PATIENCE)
        rude.socket.shutdown(socket.SHUT_RDWR)  # without a goodbye
    first = state(viewer, lambda _: True)["step"]
    state(viewer, lambda told: told["step"] >= first + 3)


def test_ten_viewers_look_on_and_give_orders(served):
    with ExitStack() as stack:
        viewers = [stack.enter_context(connect(served.socket, max_size=None)) for _ in range(10)]
        ask(viewers[0], do="run", on=True)
        for number, each in enumerate(viewers):
            each.recv(PATIENCE)
            ask(each, do="say", words=("touch red", "move blue")[number % 2])
        for each in viewers:
            assert len(moments(each, 5)) == 5
        ask(viewers[9], do="again")
        for each in viewers:
            state(each, lambda told: told["phase"] == "ready")


def test_more_viewers_than_can_be_served_are_told_so(served):
    with ExitStack() as stack:
        for _ in range(MOST_VIEWERS):
            stack.enter_context(connect(served.socket, max_size=None)).recv(PATIENCE)
        late = stack.enter_context(connect(served.socket, max_size=None))
        with pytest.raises(ConnectionClosed, match=f"{MOST_VIEWERS} viewers look on already"):
            late.recv(PATIENCE)


@pytest.mark.parametrize(
    "nonsense", ["hello", "[]", '{"do": "fly"}', '{"do": "say", "words": "fetch"}', b"\x00\x01", "[" * 999]
)
def test_nonsense_is_answered_and_the_robot_goes_on(viewer, nonsense):
    viewer.send(nonsense)
    assert told(viewer, lambda news: "refused" in news)["refused"]
    assert moments(viewer, 3)


def test_a_message_that_is_too_long_ends_its_own_connection_only(served, viewer):
    with connect(served.socket, max_size=None) as rude:
        rude.send("x" * 100_000)
        with pytest.raises(ConnectionClosed):
            moments(rude, 10**6)
    assert moments(viewer, 3)


def test_bytes_that_are_no_request_harm_nobody(served, viewer):
    place = urlsplit(served.address)
    for rubbish in (b"\x16\x03\x01\x00", b"GET / HTTP/9\r\n\r\n", b"POST / HTTP/1.1\r\n\r\n", b"\n" * 20_000):
        with socket.create_connection((place.hostname, place.port), 10) as rude:
            rude.sendall(rubbish)
    for frame in (b"\xff\xff\xff\xff", b"\x81\xfe"):
        with connect(served.socket, max_size=None) as rude:
            rude.socket.sendall(frame)
    assert moments(viewer, 3)
    assert served.process.poll() is None


def test_pages_of_strangers_are_refused(served):
    status, text = served.get(Host="stranger.example:8080")
    assert (status, text) == (
        403,
        "wordarm: this address is answered under the names localhost and 127.0.0.1 only\n",
    )
    with pytest.raises(InvalidStatus, match="403"):
        connect(served.socket, origin="https://stranger.example")


def test_elsewhere_nothing_is_answered_without_the_token():
    with Served("--host=0.0.0.0") as open_to_all:
        parts = urlsplit(open_to_all.address)
        token, root = parts.path.strip("/"), f"127.0.0.1:{parts.port}"
        assert len(token) >= 32
        for path in ("", "socket", "main.js", "wrong/", f"{token[:-1]}/"):
            assert open_to_all.get(f"http://{root}/{path}")[0] == 403, path
        for path in ("socket", "wrong/socket"):
            with pytest.raises(InvalidStatus, match="403"):
                connect(f"ws://{root}/{path}")
        assert open_to_all.get(f"http://{root}/{token}/")[0] == 200
        with connect(f"ws://{root}/{token}/socket") as viewer:
            assert "agent" in viewer.recv(PATIENCE)


def test_while_nobody_looks_time_stands_still(served):
    with connect(served.socket, max_size=None) as viewer:
        ask(viewer, do="again")
        ask(viewer, do="run", on=True)
        before = state(viewer, lambda told: told["step"] > 2)["step"]
    time.sleep(2.0)
    with connect(served.socket, max_size=None) as viewer:
        after = state(viewer, lambda _: True)["step"]
        ask(viewer, do="again")
    assert before <= after < before + 15


def test_ctrl_c_ends_it_with_one_sentence():
    with Served() as served:
        served.process.send_signal(signal.SIGINT)
        output, errors = served.process.communicate(timeout=PATIENCE)
        assert served.process.returncode == 130
        assert (output, errors) == ("", "wordarm: stopped by Ctrl-C\n")


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["nobody"], "wordarm: there is no"),
        (
            ["best-generaliser", "--port=70000"],
            "wordarm: --port 70000 is no port; give one from 1 to 65535, or 0",
        ),
        (
            ["best-generaliser", "--host=no.such.host.invalid"],
            "wordarm: --host no.such.host.invalid is no address",
        ),
        (["best-generaliser", "--host=192.0.2.1"], "wordarm: cannot listen at port 8080 of 192.0.2.1 ("),
        (
            ["best-generaliser", "--robot=icub-erd", "--port=0"],
            "wordarm: robot 'icub-erd' has 14 links that cannot act",
        ),
    ],
)
def test_what_cannot_be_served_is_told_in_one_sentence(options, sentence):
    assert refused(options).startswith(sentence)


def test_a_port_in_use_is_told_in_one_sentence(served):
    port = urlsplit(served.address).port
    sentence = f"wordarm: port {port} of 127.0.0.1 is in use; give another with --port, or --port 0"
    assert refused(["best-generaliser", f"--port={port}"]).startswith(sentence)


def test_without_the_extra_one_sentence_says_what_to_install(tmp_path):
    (tmp_path / "websockets").mkdir()
    (tmp_path / "websockets" / "__init__.py").write_text("raise ModuleNotFoundError('websockets')\n")
    assert refused(["best-generaliser"], PYTHONPATH=str(tmp_path)) == (
        "wordarm: the live page needs the package websockets; install it with: pip install 'wordarm[live]'\n"
    )


def refused(options, **variables):
    """The one line on stderr of a command that ends with exit code 2."""
    command = [sys.executable, "-m", "evolution", "live", *options]
    result = subprocess.run(
        command, capture_output=True, text=True, env={**os.environ, **variables}, timeout=300
    )
    assert (result.returncode, result.stdout) == (2, "")
    assert result.stderr.count("\n") == 1
    return result.stderr
