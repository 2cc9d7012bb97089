"""One made-up study for the tests of what it says and of how it is drawn."""

import pytest

from evolution.study.beyond.comparisons import comparisons
from evolution.study.beyond.groups import groups_of
from tests.evolution.study.beyond.made_up import SEEDS, made_study


@pytest.fixture(scope="package")
def groups():
    return groups_of(made_study(SEEDS))


@pytest.fixture(scope="package")
def found(groups):
    return comparisons(groups)
