"""The picture of docs/live.md: the page of `wordarm live` in a real browser, after a word that was never met.

    python -m scripts.live_picture docs/images/live.png

needs the extra live and Debian's Chromium (`sh scripts/browser.sh`). Take it again after a change of the
shipped agents or of the page.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path
from typing import Final

from tests.browser import Browser
from tests.mujoco_port.live.serving import Served

WIDTH, HEIGHT = 1280, 800
STARTS: Final = ("--start-area=left", "--trial-seed=16")
WORDS: Final = (".pill.touch span", ".pill.green span")
DRAWN: Final = "window.wordarmLive && wordarmLive.drawn > 0"
OVER: Final = "document.getElementById('now').textContent.includes('is over')"


def main(path: Path) -> None:
    """Say TOUCH Green, wait for the verdicts, and take the picture."""
    with (
        tempfile.TemporaryDirectory() as folder,
        Served(*STARTS) as served,
        Browser(Path(folder), webgl=True) as page,
    ):
        page.open(served.address, width=WIDTH, height=HEIGHT)
        page.wait_for(DRAWN)
        for word in WORDS:
            page.click(word)
        page.click("#run")
        while not page.evaluate(OVER):  # as long as it takes: the processor draws
            time.sleep(0.5)
        time.sleep(3.0)  # what stands still is drawn finely
        print(page.picture(path))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
