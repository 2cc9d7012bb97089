"""The network's state space: all outputs, seen from where they spread most."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from arm2d.drawing import FULL, INK, OBJECT_COLOURS, SMALL, STYLE, look
from evolution.agents.behaviour import Behaviour
from evolution.agents.firsts import NEVER
from evolution.figures.neurons import object_handles
from evolution.figures.page import FAINT, beside, draw_alike, head

SHOWN_PER_AREA: Final = 3
CUBE_COLOUR: Final = "#C9C6BE"
# Beyond so many neurons only the outline is drawn; those whose axes hardly show in the plane have no name.
MOST_EDGES_DRAWN: Final = 3
LEAST_NAMED: Final = 0.3


def state_space_figure(behaviour: Behaviour, origin: str = "") -> Figure:
    """A page with the paths of the outputs in the plane that shows most of them, by action word."""
    mean, plane, shares = principal_plane(behaviour.activity)
    actions = [word.action.name for word in behaviour.condition.instructions[::3]]
    with look(STYLE):
        figure = Figure(figsize=(FULL, 3.3))
        head(figure, "The paths through the network's states", origin)
        panels = figure.subplots(1, 3, sharex=True, sharey=True)
        figure.subplots_adjust(left=0.075, right=0.985, top=0.81, bottom=0.21, wspace=0.05)
        for action, axes in enumerate(panels):
            draw_paths(axes, behaviour, (behaviour.activity - mean) @ plane, action)
            draw_cube(axes, mean, plane)
            axes.set_title(actions[action], fontweight="bold")
            axes.set_xlabel(f"first component, {100 * shares[0]:.0f} % of variance")
        panels[0].set_ylabel(f"second component, {100 * shares[1]:.0f} %")
        handles = object_handles() + _path_handles()
        figure.legend(handles=handles, loc="lower center", ncols=5)
    return figure


def principal_plane(
    activity: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Mean [N], plane [N, 2] of most variance, and its shares of variance [2], over all trials and steps."""
    points = activity[np.isfinite(activity).all(axis=-1)]
    mean = points.mean(axis=0)
    deviations = points - mean
    if deviations.shape[1] == 1:  # one output has no plane: the second component is nothing
        return mean, np.array([[1.0, 0.0]]), np.array([1.0, 0.0])
    _, sizes, axes = np.linalg.svd(deviations, full_matrices=False)
    # The sign of an axis is arbitrary; its largest weight shall be positive.
    signs = np.sign(axes[np.arange(len(axes)), np.abs(axes).argmax(axis=1)])
    shares = np.square(sizes) / max(float(np.square(sizes).sum()), np.finfo(np.float64).tiny)
    return mean, (axes * signs[:, np.newaxis])[:2].T, shares[:2]


def draw_paths(axes: Axes, behaviour: Behaviour, points: NDArray[np.float64], action: int) -> None:
    """Paths [T, 251, 2] of some trials of an action word in the objects' colours, as means of two steps."""
    for object_, colour in OBJECT_COLOURS.items():
        trials = np.flatnonzero((behaviour.actions == action) & (behaviour.objects == object_))
        shown = np.concatenate([trials[behaviour.areas[trials] == area][:SHOWN_PER_AREA] for area in (0, 1)])
        paths = {trial: without_alternation(points[trial]) for trial in shown}
        draw_alike(axes, list(paths.values()), color=colour, lw=0.6, alpha=0.8)
        events = (
            (np.zeros_like(behaviour.steps), "s", INK),
            (behaviour.first_sight, "o", "white"),
            (behaviour.first_touch, "D", colour),
            (behaviour.steps, "X", colour),
        )
        for rows, marker, face in events:
            met = [
                path[min(rows[trial], len(path) - 1)] for trial, path in paths.items() if rows[trial] != NEVER
            ]
            if met:
                axes.plot(*np.array(met).T, marker, ms=3.6, mfc=face, mec=INK, mew=0.5, zorder=4)
    axes.set_aspect("equal", adjustable="box")


def without_alternation(path: NDArray[np.float64]) -> NDArray[np.float64]:
    """A path [K + 1, 2], then nothing, as the means of successive steps [K, 2].

    Some neurons alternate from step to step, and the lines to and fro would hide everything.
    """
    own = path[np.isfinite(path).all(axis=-1)]
    return (own[:-1] + own[1:]) / 2


def draw_cube(axes: Axes, mean: NDArray[np.float64], plane: NDArray[np.float64]) -> None:
    """Where the outputs can be, with each neuron's axis named: a cube, or the outline of one of N axes."""
    count = len(mean)
    if count <= MOST_EDGES_DRAWN:
        corners = np.array(np.meshgrid(*[[0, 1]] * count)).reshape(count, -1).T
        for a in corners:
            for b in corners:
                if (b - a).sum() == 1 and np.abs(b - a).sum() == 1:
                    axes.plot(*((np.array([a, b]) - mean) @ plane).T, color=CUBE_COLOUR, lw=0.6, zorder=0)
    else:
        axes.plot(*(outline(plane) - mean @ plane).T, color=CUBE_COLOUR, lw=0.6, zorder=0)
    axes.margins(0.14)  # room for the neurons' names
    origin = -mean @ plane
    for neuron in range(count):
        tip = (np.eye(count)[neuron] - mean) @ plane
        length = float(np.linalg.norm(tip - origin))
        way = (tip - origin) / max(length, 1e-9)
        look = {"fontsize": SMALL, "color": FAINT, "ha": "center", "va": "center", "zorder": 5}
        if count <= MOST_EDGES_DRAWN:
            sideways = abs(way[0]) > 0.5
            if sideways:  # below the tip, lest it stick out of the frame
                look["ha"] = "right" if way[0] > 0 else "left"
            beside(axes, f"neuron {neuron + 1}", tip, (0, -12) if sideways else 7 * way, **look)
        elif length >= LEAST_NAMED:
            axes.plot(*np.array([origin, tip]).T, color=CUBE_COLOUR, lw=0.6, zorder=0)
            beside(axes, f"{neuron + 1}", tip, 4 * way, **look)


def outline(plane: NDArray[np.float64]) -> NDArray[np.float64]:
    """The outline [2 N + 1, 2], seen in a plane [N, 2], of the cube of all outputs from 0 to 1.

    From its lowest corner on, it is made of all edges and then of all edges back, by their directions.
    """
    edges = np.where(plane[:, 1:] < 0.0, -plane, plane)
    edges = edges[np.argsort(np.arctan2(edges[:, 1], edges[:, 0]))]
    lowest = plane[plane[:, 1] < 0.0].sum(axis=0)
    return lowest + np.concatenate([[[0.0, 0.0]], np.cumsum(np.concatenate([edges, -edges]), axis=0)])


def _path_handles() -> list[Line2D]:
    """What the markers on a path mean."""
    marks = (
        ("s", INK, "start"),
        ("o", "white", "first sight"),
        ("D", FAINT, "first touch"),
        ("X", FAINT, "end"),
    )
    cube = Line2D([], [], color=CUBE_COLOUR, lw=0.6, label="where outputs can be")
    path = Line2D([], [], color=INK, lw=0.6, label="a trial, mean of two steps each")
    return [
        path,
        *(
            Line2D([], [], ls="", marker=marker, ms=3.6, mfc=face, mec=INK, mew=0.5, label=label)
            for marker, face, label in marks
        ),
        cube,
    ]
