import pytest

pytest.importorskip("warp", reason="the extra gpu is not installed")

from arm2d.device.opening import CHECK
from evolution.experiments.device.late_tests import laboratory_on


@pytest.fixture
def laboratory():
    """The device's kernel on the processor."""
    return laboratory_on(CHECK)
