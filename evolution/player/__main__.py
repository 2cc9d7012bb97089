"""`python -m evolution.player`: agents in a page of their own, to be talked to in a browser."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Final

import tyro
from tyro.conf import Positional, arg

from evolution.answers import answer

SHIPPED: Final = ("best-generaliser", "best-specialist", "with-ignore")


@dataclass(frozen=True)
class Page:
    """Write one HTML file in which agents live: say two words, drag objects, silence neurons."""

    agents: Annotated[Positional[tuple[str, ...]], arg(metavar="AGENT...")] = SHIPPED
    """Run folders, genotype files or names of shipped agents."""

    output: Path = Path("play.html")
    """The file. It needs no server and no network."""

    def run(self) -> int:
        """Write the page and print its path."""
        from evolution.player.page import render_page
        from evolution.runs.sources import find_agent
        from evolution.runs.storage import make_folder, write_atomically

        page = render_page([find_agent(each) for each in self.agents])
        make_folder(self.output.parent)
        write_atomically(self.output, page.encode())
        print(self.output)
        return 0


def main(arguments: Sequence[str]) -> int:
    """Write a page; the exit code is 2 for bad input."""
    return answer(lambda: tyro.cli(Page, prog="python -m evolution.player", args=arguments).run())


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
