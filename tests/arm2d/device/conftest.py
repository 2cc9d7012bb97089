import pytest

pytest.importorskip("warp", reason="the extra gpu is not installed")

from arm2d.device.opening import CHECK, open_device


@pytest.fixture(scope="session")
def laboratory():
    """The device's kernel on the processor."""
    device = open_device(CHECK)
    from arm2d.device.groups import Laboratory

    return Laboratory(device)
