import shutil

import pytest

from evolution.runs.run import evolve
from tests.evolution.small_runs import SMALL


@pytest.fixture(scope="session")
def finished_run(tmp_path_factory):
    path = tmp_path_factory.mktemp("runs") / "finished"
    assert evolve(path, SMALL) == 230
    return path


@pytest.fixture
def run_copy(finished_run, tmp_path):
    """A finished run that a test may damage."""
    return shutil.copytree(finished_run, tmp_path / "run")
