"""Debian's Chromium without a window, driven by the DevTools protocol: real clicks, keys and touches.

with Browser(folder) as browser:
    browser.open(page, width=360)
    browser.click('[data-part="play"]')
    assert browser.text('[data-part="verdict"]') ...
    assert not browser.messages
"""

from __future__ import annotations

import base64
import json
import shutil
import subprocess
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Final

import pytest
from websockets.sync.client import connect

CHROMIUM: Final = shutil.which("chromium")
NEEDS_BROWSER: Final = pytest.mark.skipif(
    CHROMIUM is None,
    reason="a browser is needed to try the page in; as root on Debian: apt-get install chromium",
)
OPTIONS: Final = (
    "--headless",
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--remote-debugging-port=0",
)
WEBGL: Final = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
CONTRAST: Final = Path(__file__).with_name("contrast.js").read_text(encoding="utf-8")
# Much more than anything here takes; a busy machine is no fault.
PATIENCE: Final = 60.0


class Browser:
    """A browser with one page.

    Args:
        folder: An empty folder for its profile.
        webgl: Whether the processor is to draw what a graphics card would.

    Attributes:
        messages: Whatever the pages wrote to the console, threw, or failed to load.
        requests: Every address that was asked for.
    """

    def __init__(self, folder: Path, *, webgl: bool = False) -> None:
        self._options = WEBGL if webgl else ("--disable-gpu",)
        self.messages: list[str] = []
        self.requests: list[str] = []
        self._folder, self._sent, self._open = folder, 0, ExitStack()

    def __enter__(self) -> Browser:
        assert CHROMIUM is not None, "there is no chromium on this machine"
        self._process = subprocess.Popen(
            [CHROMIUM, *OPTIONS, *self._options, f"--user-data-dir={self._folder}", "about:blank"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            self._socket = self._open.enter_context(connect(self._address(), max_size=None))
            for domain in ("Page", "Runtime", "Log", "Network"):
                self._do(f"{domain}.enable")
        except BaseException:
            self._process.kill()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self._open.close()
        self._process.terminate()
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def open(
        self,
        page: Path | str,
        *,
        width: int = 1200,
        height: int = 900,
        scheme: str = "light",
        motion: bool = False,
    ) -> None:
        """Load a file or an address, in a window of some width and height [px]; `scheme` is light or dark."""
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600}
        self._do("Emulation.setDeviceMetricsOverride", **size)
        still = "no-preference" if motion else "reduce"
        features = {"prefers-color-scheme": scheme, "prefers-reduced-motion": still}
        self._do(
            "Emulation.setEmulatedMedia", features=[{"name": n, "value": v} for n, v in features.items()]
        )
        self.evaluate("void (window.isOld = true)")
        self._do("Page.navigate", url=page if isinstance(page, str) else page.resolve().as_uri())
        self.wait_for("!window.isOld && document.readyState === 'complete'")

    def evaluate(self, expression: str) -> Any:
        """The value of a JavaScript expression; a promise is waited for."""
        answer = self._do("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise AssertionError(f"{expression}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def wait_for(self, expression: str) -> None:
        """Wait until an expression is true.

        Raises:
            AssertionError: If it does not become so.
        """
        end = time.monotonic() + PATIENCE
        while not self.evaluate(expression):
            assert time.monotonic() < end, f"never true: {expression}"
            time.sleep(0.02)

    def text(self, selector: str) -> str:
        """What an element says."""
        return self.evaluate(f"document.querySelector({json.dumps(selector)}).textContent")

    def click(self, selector: str) -> None:
        """Press the mouse in the middle of an element."""
        x, y = self.place(selector)
        self.drag((x, y), (x, y))

    def place(self, selector: str) -> tuple[float, float]:
        """Middle of an element in the window [px], after scrolling to it."""
        x, y = self.evaluate(
            f"(() => {{ const e = document.querySelector({json.dumps(selector)});"
            "e.scrollIntoView({ block: 'center', behavior: 'instant' }); const r = e.getBoundingClientRect();"
            "return [r.x + r.width / 2, r.y + r.height / 2]; })()"
        )
        return x, y

    def drag(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Press the mouse at one place of the window and let go at another [px]."""
        for kind, (x, y), buttons in (
            ("mousePressed", start, 1),
            ("mouseMoved", end, 1),
            ("mouseReleased", end, 0),
        ):
            self._do(
                "Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=buttons, clickCount=1
            )

    def tap(self, selector: str) -> None:
        """Touch the middle of an element with a finger."""
        place = self.place(selector)
        self.swipe(place, place)

    def swipe(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Put a finger on one place of the window and lift it at another [px]."""
        for kind, points in (("touchStart", [start]), ("touchMove", [end]), ("touchEnd", [])):
            if kind != "touchMove" or start != end:
                touched = [{"x": x, "y": y} for x, y in points]
                self._do("Input.dispatchTouchEvent", type=kind, touchPoints=touched)

    def press(self, key: str) -> None:
        """Press a key, by its name in `KeyboardEvent.key`."""
        text = {"text": key} if len(key) == 1 else {}
        self._do("Input.dispatchKeyEvent", type="keyDown", key=key, code=key, **text)
        self._do("Input.dispatchKeyEvent", type="keyUp", key=key, code=key)

    def faint_texts(self) -> list[str]:
        """Texts of a page of ours whose contrast is below 4.5, with what it is."""
        return self.evaluate(CONTRAST)

    def named(self) -> list[tuple[str, str]]:
        """(role, name) of everything that a screen reader finds on the page."""
        nodes = self._do("Accessibility.getFullAXTree")["nodes"]
        return [
            (each["role"]["value"], each.get("name", {}).get("value", ""))
            for each in nodes
            if not each["ignored"]
        ]

    def picture(self, path: Path, *, whole: bool = False) -> Path:
        """Write a PNG of the window, or of the whole page."""
        image = self._do("Page.captureScreenshot", captureBeyondViewport=whole)
        path.write_bytes(base64.b64decode(image["data"]))
        return path

    def _address(self) -> str:
        """Of the page's own socket, as soon as Chromium has written down where it listens."""
        note = self._folder / "DevToolsActivePort"
        end = time.monotonic() + PATIENCE
        while not (note.exists() and len(note.read_text().split()) == 2):
            assert time.monotonic() < end, "chromium did not start"
            assert self._process.poll() is None, "chromium ended at once"
            time.sleep(0.02)
        port, address = note.read_text().split()
        with connect(f"ws://127.0.0.1:{port}{address}", max_size=None) as browser:
            browser.send(json.dumps({"id": 1, "method": "Target.getTargets"}))
            targets = json.loads(browser.recv())["result"]["targetInfos"]
        page = next(each["targetId"] for each in targets if each["type"] == "page")
        return f"ws://127.0.0.1:{port}/devtools/page/{page}"

    def _do(self, method: str, **parameters: Any) -> Any:
        """Call a method of the protocol, taking note of what happens meanwhile."""
        self._sent += 1
        self._socket.send(json.dumps({"id": self._sent, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self._socket.recv(timeout=PATIENCE))
            if answer.get("id") == self._sent:
                assert "error" not in answer, f"{method}: {answer.get('error')}"
                return answer["result"]
            self._note(answer)

    def _note(self, event: dict[str, Any]) -> None:
        """Remember messages and requests."""
        method, details = event.get("method"), event.get("params", {})
        if method == "Network.requestWillBeSent":
            self.requests.append(details["request"]["url"])
        elif method == "Runtime.consoleAPICalled":
            self.messages.append(str([each.get("value") for each in details["args"]]))
        elif method == "Runtime.exceptionThrown":
            self.messages.append(str(details["exceptionDetails"]))
        elif method == "Log.entryAdded":
            self.messages.append(details["entry"]["text"])
