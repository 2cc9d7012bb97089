"""A run small enough for tests: two whole parts and a short one, a millisecond per generation."""

from evolution.search.config import RunConfig
from evolution.search.settings import Settings

SMALL = RunConfig(seed=11, settings=Settings(population=10, elites=2, parents=5, generations=230))
SMALL_FLAGS = ["--seed=11", "--population=10", "--elites=2", "--parents=5", "--generations=230"]


def contents(path):
    """Every file that determines the run or is determined by it, as bytes."""
    files = [*path.glob("*.npz"), *path.glob("parts/*"), path / "config.toml"]
    return {str(each.relative_to(path)): each.read_bytes() for each in files}
