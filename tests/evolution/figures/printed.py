"""What a printed page must not have: words cut off, too small or on each other, and marks nobody explains."""

from functools import cache
from itertools import combinations

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex
from matplotlib.text import Text

from arm2d.drawing import FULL, INK, QUIET, SMALLEST_LETTERS

NEUTRAL = {to_hex(colour) for colour in (INK, QUIET, "white", "black", "#C9C6BE")}
SLACK = 1.0  # [pixel] of 100 dots per inch, by which boxes round letters may meet


@cache
def texts_of(figure):
    """Everything written on a page, ticks out of sight left out."""
    FigureCanvasAgg(figure).draw()
    found = list(figure.texts)
    for legend in figure.legends:
        found += [*legend.get_texts(), legend.get_title()]
    for axes in figure.axes:
        found += [*axes.texts, axes.title, axes._left_title, axes._right_title]
        if axes.get_legend():
            found += axes.get_legend().get_texts()
        for axis in (axes.xaxis, axes.yaxis) if axes.axison else ():
            low, high = sorted(axis.get_view_interval())
            margin = 1e-9 * (high - low)
            ticks = [t for t in axis.get_major_ticks() if low - margin <= t.get_loc() <= high + margin]
            found += [axis.label, *(label for tick in ticks for label in (tick.label1, tick.label2))]
    return [text for text in found if text.get_visible() and text.get_text().strip()]


def said(text: Text) -> str:
    return " ".join(text.get_text().split())


def cut_off(figure):
    """What reaches over the edge of the page."""
    page = figure.bbox
    return [
        said(text)
        for text in texts_of(figure)
        for box in [text.get_window_extent()]
        if box.x0 < page.x0 - SLACK or box.x1 > page.x1 + SLACK or box.y0 < page.y0 or box.y1 > page.y1
    ]


def too_small(figure):
    """What cannot be read where the figure is printed across a page; a wider one is made smaller for that."""
    scale = min(1.0, FULL / figure.get_size_inches()[0])
    return {
        (said(text), round(text.get_fontsize() * scale, 2))
        for text in texts_of(figure)
        if text.get_fontsize() * scale < SMALLEST_LETTERS
    }


def on_each_other(figure):
    """Pairs of words that overlap."""
    boxes = [(said(text), text.get_window_extent()) for text in texts_of(figure)]
    return [
        (one, other)
        for (one, a), (other, b) in combinations(boxes, 2)
        if min(a.x1, b.x1) - max(a.x0, b.x0) > SLACK and min(a.y1, b.y1) - max(a.y0, b.y0) > SLACK
    ]


def unexplained(figure):
    """Markers, dashes and colours of lines that no legend has and no word is written in."""
    legends = [*figure.legends, *(a.get_legend() for a in figure.axes if a.get_legend())]
    handles = [handle for legend in legends for handle in legend.legend_handles]
    markers = {handle.get_marker() for handle in handles if hasattr(handle, "get_marker")}
    dashed = any(handle.is_dashed() for handle in handles if hasattr(handle, "is_dashed"))
    colours = NEUTRAL | {to_hex(text.get_color()) for text in texts_of(figure)}
    for handle in handles:
        for name in ("get_color", "get_markeredgecolor", "get_facecolor"):
            if hasattr(handle, name):
                colours.add(to_hex(getattr(handle, name)()))
    missing = set()
    for line in (line for axes in figure.axes for line in axes.lines if len(line.get_xdata())):
        if line.get_marker() not in ("", "None", None, " ") and line.get_marker() not in markers:
            missing.add(f"marker {line.get_marker()}")
        if line.is_dashed() and not dashed:
            missing.add("a dashed line")
        colour = line.get_markeredgecolor() if line.get_linestyle() == "None" else line.get_color()
        if to_hex(colour) not in colours:
            missing.add(f"the colour {to_hex(colour)}")
    return missing
