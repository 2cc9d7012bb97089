"""`wordarm play`: agents in a page of their own, to be talked to in a browser."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from tyro.conf import Positional

SHIPPED: Final = ("best-generaliser", "best-specialist", "with-ignore")


@dataclass(frozen=True)
class Play:
    """Write one HTML file in which agents live: say two words, drag objects, silence neurons."""

    agents: Positional[tuple[str, ...]] = SHIPPED
    """Run folders, genotype files or names of shipped agents."""

    output: Path = Path("play.html")
    """The file. It needs no server and no network."""

    def run(self) -> int:
        """Write the page."""
        from evolution.player.page import render_page
        from evolution.runs.sources import find_source
        from evolution.runs.storage import make_folder, write_atomically

        page = render_page([find_source(each) for each in self.agents])
        make_folder(self.output.parent)
        write_atomically(self.output, page.encode())
        print(self.output)
        return 0
