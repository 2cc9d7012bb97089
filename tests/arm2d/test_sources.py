"""What was computed with other sources is not continued: every file of a package counts."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from arm2d.cache import source_files, sources_digest

ROOT = Path(__file__).parents[2]
DIGEST = "import sys; from arm2d.cache import sources_digest; print(sources_digest(*sys.argv[1:]))"
FINGERPRINTS = f"""
{DIGEST}
from arm2d.cache import cache_folder
print(cache_folder())
from mujoco_port.acting.agreement import fingerprint
print(fingerprint([], "icub"))
"""


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """The packages, to be changed."""
    home = tmp_path_factory.mktemp("sources")
    for package in ("arm2d", "models", "mujoco_port"):
        shutil.copytree(ROOT / package, home / package, ignore=shutil.ignore_patterns("__pycache__"))
    return home


def printed(home, code, *arguments):
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments], cwd=home, capture_output=True, text=True, check=True
    )
    return done.stdout.splitlines()


@pytest.mark.parametrize(
    "changed", ["arm2d/kernel/contact.py", "models/scene.xml", "mujoco_port/reach/hand.py"]
)
def test_a_change_anywhere_in_a_package_is_noticed(copy, changed):
    package, path = changed.split("/")[0], copy / changed
    before, whole = printed(copy, DIGEST, package), path.read_bytes()
    path.write_bytes(whole + b" ")
    assert printed(copy, DIGEST, package) != before
    path.write_bytes(whole)
    assert printed(copy, DIGEST, package) == before


def test_a_changed_kernel_continues_neither_outcomes_nor_machine_code(copy):
    path = copy / "arm2d" / "kernel" / "contact.py"
    before, whole = printed(copy, FINGERPRINTS, "arm2d"), path.read_bytes()
    path.write_bytes(whole + b"\n# another line\n")
    after = printed(copy, FINGERPRINTS, "arm2d")
    path.write_bytes(whole)
    assert len(before) == 3
    assert all(one != other for one, other in zip(before, after, strict=True))


def test_a_file_of_another_name_is_noticed(copy):
    path = copy / "models" / "scene.xml"
    before, renamed = printed(copy, DIGEST, "models"), path.with_name("scene2.xml")
    path.rename(renamed)
    after = printed(copy, DIGEST, "models")
    renamed.rename(path)
    assert after != before


def test_every_source_file_is_listed_once_and_in_order():
    listed = [place for place, _ in source_files(ROOT / "arm2d", "arm2d")]
    assert listed == sorted(listed, key=lambda place: place.split("/"))
    assert set(listed) == {str(each.relative_to(ROOT)) for each in (ROOT / "arm2d").rglob("*.py")}
    assert len(sources_digest("arm2d")) == 12
