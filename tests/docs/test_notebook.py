"""The notebook runs, prints what is stored in it, and is small enough to be kept."""

import json

import nbformat
import pytest

from scripts.notebook import NOTEBOOK, executed, printed
from scripts.site_pages import notebook_page

STORED = nbformat.read(NOTEBOOK, as_version=4)


@pytest.mark.slow
def test_every_cell_runs_and_prints_what_is_stored(tmp_path):
    again = executed(tmp_path)
    assert printed(again) == printed(STORED)
    assert pictures(again) == pictures(STORED) == 4
    assert (tmp_path / "robot.png").is_file()


def test_stored_notebook_is_small_and_tells_nothing_of_a_machine():
    assert NOTEBOOK.stat().st_size < 500_000
    assert set(STORED.metadata) == {"kernelspec", "language_info"}
    assert "/tmp/" not in json.dumps(STORED)


def test_page_of_the_notebook_shows_its_pictures():
    files = dict(notebook_page(NOTEBOOK))
    page = files.pop("first-hour.md")
    assert len(files) == 4
    assert all(f"]({name})" in page for name in files)
    assert "never heard before" in page


def pictures(notebook):
    """How many outputs are pictures."""
    outputs = [each for cell in notebook.cells if cell.cell_type == "code" for each in cell.outputs]
    return sum(any(kind.startswith("image/") for kind in each.get("data", {})) for each in outputs)
