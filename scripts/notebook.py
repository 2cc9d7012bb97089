"""The notebook of docs/examples, executed: its outputs are stored in it.

    python -m scripts.notebook      runs every cell in an empty folder and writes what came out of it

Outputs are kept in the repository: so the page can be read where nothing is installed, and is built into the
site without being run. A test runs every cell again and compares what was printed.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import Final

import nbformat
from nbclient import NotebookClient
from nbformat import NotebookNode

NOTEBOOK: Final = Path(__file__).parents[1] / "docs" / "examples" / "first-hour.ipynb"
# Of one cell [s]: far more than any takes, on a machine that others use too.
PATIENCE: Final = 600


def executed(folder: Path) -> NotebookNode:
    """The notebook with the outputs of all its cells, run in a folder, without anything of this machine."""
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    # The kernel draws for the notebook, whatever the caller draws for.
    inherited = os.environ.pop("MPLBACKEND", None)
    try:
        NotebookClient(
            notebook,
            kernel_name="python3",
            timeout=PATIENCE,
            startup_timeout=PATIENCE,
            extra_arguments=["--log-level=ERROR"],
            resources={"metadata": {"path": str(folder)}},
        ).execute()
    finally:
        if inherited is not None:
            os.environ["MPLBACKEND"] = inherited
    notebook.metadata = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    for cell in notebook.cells:
        cell.metadata = {}
    return notebook


def printed(notebook: NotebookNode) -> list[str]:
    """What each cell of code printed or gave as text."""
    return [
        "".join(output.get("text", output.get("data", {}).get("text/plain", "")) for output in cell.outputs)
        for cell in notebook.cells
        if cell.cell_type == "code"
    ]


def main() -> None:
    """Run it and store it."""
    with tempfile.TemporaryDirectory() as folder:
        nbformat.write(executed(Path(folder)), NOTEBOOK)


if __name__ == "__main__":
    main()
