"""Figures of what goes on inside networks of any size."""

import numpy as np
import pytest

from arm2d import Condition, Readings
from arm2d.network.genes import genes_of
from evolution.agents.behaviour import record_behaviour
from evolution.figures.neurons import activity_figure
from evolution.figures.states import outline, principal_plane, state_space_figure


@pytest.fixture(scope="module", params=[1, 5, 16])
def behaviour(request):
    genotype = np.random.default_rng(request.param).random(genes_of(request.param).count)
    return record_behaviour(genotype, Condition.WITH_INDICATE, Readings(), per_area=1)


def test_every_inter_neuron_has_a_row(behaviour):
    count = behaviour.activity.shape[-1]
    figure = activity_figure(behaviour)
    figure.canvas.draw()
    names = [axes.get_ylabel() for axes in figure.axes if axes.get_ylabel()]
    assert [int(name.split()[-1]) for name in names] == list(range(1, count + 1))


def test_all_paths_lie_where_outputs_can_be(behaviour):
    mean, plane, shares = principal_plane(behaviour.activity)
    assert plane.shape == (behaviour.activity.shape[-1], 2)
    assert 0.0 < shares.sum() <= 1.0 + 1e-12
    state_space_figure(behaviour).canvas.draw()
    rim = outline(plane) - mean @ plane
    assert np.allclose(rim[0], rim[-1])
    points = ((behaviour.activity - mean) @ plane).reshape(-1, 2)
    points = points[np.isfinite(points).all(axis=1)]
    for (x, y), (dx, dy) in zip(rim[:-1], np.diff(rim, axis=0), strict=True):
        # Anticlockwise, so that all that is inside lies to the left of every edge.
        assert (dx * (points[:, 1] - y) - dy * (points[:, 0] - x)).min() > -1e-9


def test_the_outline_of_three_dimensions_is_that_of_the_cubes_corners():
    plane, _ = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 2)))
    corners = np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).reshape(3, -1).T @ plane
    found = outline(plane)
    assert np.allclose(found.min(axis=0), corners.min(axis=0))
    assert np.allclose(found.max(axis=0), corners.max(axis=0))
    for corner in found[:-1]:
        assert np.isclose(corners, corner).all(axis=1).any()
