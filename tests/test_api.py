"""What the packages offer is found by completion and type checkers, explained, and listed on docs/api.md."""

import ast
import inspect
import re
from importlib import import_module
from pathlib import Path

import pytest

from scripts import api_page

ROOT = Path(__file__).parents[1]
PAGE = api_page.PAGE.read_text(encoding="utf-8")
NAMES = [(package, name) for package in api_page.PACKAGES for name in api_page.homes_of(package)]


def test_the_tables_of_the_page_are_what_the_packages_say():
    assert api_page.page_of(PAGE) == PAGE, "rewrite them with: python -m scripts.api_page"


@pytest.mark.parametrize("package", api_page.PACKAGES)
def test_completion_offers_just_what_the_stub_names(package):
    module = import_module(package)
    assert sorted(dir(module)) == sorted(module.__all__) == sorted(api_page.homes_of(package))
    assert (ROOT / package / "py.typed").is_file()
    with pytest.raises(AttributeError, match="no_such_name"):
        _ = module.no_such_name


@pytest.mark.parametrize(("package", "name"), NAMES, ids=map(".".join, NAMES))
def test_every_name_is_there_and_says_what_it_is(package, name):
    value = getattr(import_module(package), name)
    said = api_page.described(package, api_page.homes_of(package)[name], name, value)
    assert 10 < len(said) < 160
    if inspect.isclass(value) and value.__doc__:
        assert not value.__doc__.startswith(f"{name}("), "that is what dataclass makes of no docstring"


@pytest.mark.parametrize("package", api_page.PACKAGES)
def test_every_room_of_a_package_has_its_table(package):
    homes = {home.split(".")[0] for home in api_page.homes_of(package).values()}
    rooms = api_page.PACKAGES[package]
    assert rooms == ("",) or homes == set(rooms)


def test_the_page_lists_no_deep_path():
    assert not re.findall(r"^(?:from|import) (?:\w+\.\w+).*", "\n".join(_own_imports()), re.MULTILINE)
    for package, name in re.findall(rf"\b({'|'.join(api_page.PACKAGES)})\.(\w+)", PAGE):
        assert name in dir(import_module(package)), f"{package}.{name}"


def test_a_record_of_arrays_prints_as_one_line():
    records = [each for package in api_page.PACKAGES for each in _records_of_arrays(ROOT / package)]
    assert len(records) > 20
    for module, name in records:
        own = vars(getattr(import_module(module), name))["__repr__"]
        # What dataclass writes prints whole arrays; it is wrapped against recursion.
        assert not hasattr(own, "__wrapped__"), f"give {name} of {module} `__repr__ = brief` of arm2d.records"


def _records_of_arrays(folder):
    """Module and name of every dataclass that has an array among its fields."""
    for file in sorted(folder.rglob("*.py")):
        module = ".".join(file.relative_to(ROOT).with_suffix("").parts)
        for each in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(each, ast.ClassDef) and any(
                "dataclass" in ast.unparse(by) for by in each.decorator_list
            ):
                kinds = [ast.unparse(own.annotation) for own in each.body if isinstance(own, ast.AnnAssign)]
                if any(kind.startswith(("NDArray", "np.ndarray")) for kind in kinds):
                    yield module, each.name


def _own_imports():
    """Import lines of the page that are about our packages."""
    return re.findall(rf"^ *((?:from|import) (?:{'|'.join(api_page.PACKAGES)})\b.*)$", PAGE, re.MULTILINE)
