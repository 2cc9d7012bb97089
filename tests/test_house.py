"""The rooms stay rooms: few modules each, every one with a sentence that says what it is for.

Who may import whom is held by import-linter (`make lint`; contracts in pyproject.toml).
"""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGES = ["models", "arm2d", "mujoco_port", "evolution", "tests"]
MOST_MODULES = 15
ROOMS = sorted({file.parent for package in PACKAGES for file in (ROOT / package).rglob("*.py")})


def name_of(room: Path) -> str:
    return str(room.relative_to(ROOT))


@pytest.mark.parametrize("room", ROOMS, ids=name_of)
def test_a_room_has_few_enough_modules_to_be_known_by_name(room):
    modules = [file.name for file in room.glob("*.py") if file.name != "__init__.py"]
    assert len(modules) <= MOST_MODULES, modules


@pytest.mark.parametrize("room", [room for room in ROOMS if "tests" not in room.parts], ids=name_of)
def test_every_module_says_in_one_line_what_it_is_for(room):
    for file in room.glob("*.py"):
        first_line = (ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) or "").split("\n")[0]
        assert 10 < len(first_line) <= 120, file


def test_tests_mirror_the_rooms():
    """A room of the code that has tests has them in a room of the same name."""
    for room in ROOMS:
        path = room.relative_to(ROOT)
        if path.parts[:2] in {("tests", "evolution"), ("tests", "mujoco_port")}:
            assert (ROOT / Path(*path.parts[1:])).is_dir(), path
