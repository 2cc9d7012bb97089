"""The ledger of readings: one field for everything the paper leaves open (spec section 12).

Each field's documentation gives the paper's words first, then the readings.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import cache
from itertools import pairwise
from math import degrees
from numbers import Integral, Real
from reprlib import repr as shortened
from typing import Any, Final, Literal, get_args, get_origin, get_type_hints

from arm2d.constants import ALPHA_MAX, ALPHA_MIN

TURN_LATTICE = 2**44
LARGEST_WHOLE = 10**300  # beyond, a whole number is not turned into a float
# Turn of a joint per step, half-width of "on target", angle of a full MOVE [deg].
TURN_SETS = {"degrees": (2.9, 4.6, 34.4), "radians": (degrees(0.05), degrees(0.08), degrees(0.6))}


@dataclass(frozen=True)
class Readings:
    """One way to understand the paper. A run stores the whole record."""

    mutation_probability: float = 0.04
    """"with a probability of 0.4". Per gene; 0.04 would make one mutation in 25 genes."""

    mutation_sd: float = 0.1
    """Standard deviation of a mutation's Gaussian offset, printed as 0.1; 0.03 makes nearly the same total
    step as 0.1 with a mutation probability of 0.04."""

    parent_scaling: Literal["raw", "cubed", "excess", "rank"] = "raw"
    """"fitness-proportional": parents are drawn in proportion to their fitness, to its cube, to its excess
    over the best genotype that is no candidate, or to their rank, from 2 for the best to 0 for the last."""

    ties: Literal["elders", "children"] = "children"
    """Not said: of equally fit genotypes those copied on unchanged rank before their children, or after
    them. If before, three elites at a fitness that all good genotypes reach are never replaced."""

    crossover: float = 0.0
    """Only selection, elitism and mutation are named: no crossover. Else the probability that a child takes
    the genes after a random cut from a second parent, before mutation."""

    bias_ranges: Literal["symmetric", "negative"] = "symmetric"
    """"[-4, -4]" and "[-5, -5]", both empty: [-4, 4] and [-5, 5]; or beta_I in [-4, -2]."""

    tau_exponent_max: float = 1.0
    """"10^2.0", of which the paper says "about 4 %" of a trial; 1.0 and 0.0 are nearer to that."""

    object_radius: float = 8.0
    """Only in Fig. 1b. [cm]; at most 11.8: a straight S2 that touches a larger disc is never on target."""

    sector_half_width: float = 10.0
    """Only in Fig. 1b. [deg]; half the width of each object's sector seen from J1."""

    start_areas: Literal["between", "bounds"] = "between"
    """Only in Fig. 1b. S1 starts midway between neighbouring sectors, or at its bounds."""

    start_half_width: float = 8.0
    """Only in Fig. 1b. [deg]; half the width of the start areas between the sectors. From 5 on, an object at
    the edge of the default sectors can be in view at the start, if the camera sits at J1."""

    sector_centres: tuple[float, float, float] = (30.0, 90.0, 150.0)
    """Only in Fig. 1b. [deg]; bearing of the middle of the blue, green and red sector."""

    bound_vision: Literal["at", "near"] = "near"
    """White "when S1 reaches the bound": at the bound only, or within 15 degrees of it."""

    object_vision: Literal["centre", "any_part"] = "centre"
    """"falls within the sector": the disc's centre does, or any part of the disc."""

    camera_origin: Literal["J1", "end"] = "end"
    """"the camera and S1 move together": bearings of the discs are as seen from J1, or from the end of S1,
    where "in view" then is judged from too. From there an object is seen only when S1 nearly points at it."""

    turn: Literal["degrees", "radians"] = "degrees"
    """2.9, 4.6 and 34.4 degrees as printed, or the 0.05, 0.08 and 0.6 rad that round to them."""

    success: Literal["f1_f2", "f1_f2_f3"] = "f1_f2"
    """"F_tot = 1", though the sum reaches 3: F1 = F2 = 1, or F3 > 0.99 as well where the action has an F3."""

    run_counting: Literal["uninterrupted", "cumulative"] = "uninterrupted"
    """"uninterrupted interval" (III), "number of time steps" (VI): a bad step resets the count, or not."""

    indicate_angle: Literal["narrow", "wide"] = "wide"
    """30 (III) or 4.6 degrees (VI): how near INDICATE's good steps must be. F1 keeps 4.6."""

    f3_time: Literal["end", "best"] = "end"
    """Not said: F3 is taken at the end of the trial, or at its best step with the target in view."""

    ignore_stops: Literal["early", "never"] = "early"
    """The early end is listed for INDICATE, TOUCH and MOVE only: IGNORE ends at 100 too, or runs on."""

    starts_shared: Literal["generation", "genotype"] = "genotype"
    """Not said: all genotypes of a generation meet the same starts, or each its own."""

    collision_penalty: Literal["ratio", "whole"] = "ratio"
    """The line of eq. 5 is garbled: P1 scales the distance ratio only, or the whole of F1."""

    def __repr__(self) -> str:
        other = (each.name for each in fields(self) if getattr(self, each.name) != each.default)
        return f"Readings({', '.join(f'{name}={getattr(self, name)!r}' for name in other)})"

    def __post_init__(self) -> None:
        for each in fields(self):
            value = getattr(self, each.name)
            _check_type(each.name, value, each.default)
            object.__setattr__(self, each.name, _as_default(value, each.default))
        for name, allowed in choices().items():
            if getattr(self, name) not in allowed:
                raise ValueError(f"reading {name} = {getattr(self, name)!r}; choose {' or '.join(allowed)}")
        _check_geometry(self)
        _check_interval("mutation_probability", self.mutation_probability, 0.0, 1.0)
        _check_interval("mutation_sd", self.mutation_sd, 0.0, 1.0)
        _check_interval("crossover", self.crossover, 0.0, 1.0)
        _check_interval("tau_exponent_max", self.tau_exponent_max, -1.0, 3.0)

    @classmethod
    def preset(cls, name: str) -> Readings:
        """The readings called `name`: `default`, `plain` or `printed`."""
        if name not in PRESETS:
            raise ValueError(f"unknown preset of readings {name!r}; there are {', '.join(PRESETS)}")
        return PRESETS[name]

    @classmethod
    def from_mapping(cls, values: Mapping[str, Any]) -> Readings:
        """Readings from plain values, as read from a config file; what it does not name is as in `PLAIN`.

        Raises:
            ValueError: If a name is unknown or a value is not one of its readings.
        """
        return PLAIN.with_values(values)

    def with_values(self, values: Mapping[str, Any]) -> Readings:
        """These readings with some fields replaced; see `from_mapping` for what is refused."""
        known = [each.name for each in fields(self)]
        for name in values:
            if name not in known:
                raise ValueError(f"unknown reading {name!r}; there are {', '.join(known)}")
        return replace(self, **values)

    def to_mapping(self) -> dict[str, Any]:
        """Every field as a plain value, ready for a config file."""
        values = {each.name: getattr(self, each.name) for each in fields(self)}
        return {**values, "sector_centres": list(self.sector_centres)}

    @property
    def turn_size(self) -> float:
        """Turn of a joint per control step [deg], to the nearest 2**-44 degrees.

        Starting from 90, every sum of such turns is exact, so beta has only some 64 values.
        """
        return round(TURN_SETS[self.turn][0] * TURN_LATTICE) / TURN_LATTICE

    @property
    def target_cone(self) -> float:
        """S1 is on target when nearer to its bearing than this [deg]."""
        return TURN_SETS[self.turn][1]

    @property
    def indicate_cone(self) -> float:
        """The same for INDICATE's good steps [deg]."""
        return 30.0 if self.indicate_angle == "wide" else self.target_cone

    @property
    def move_angle(self) -> float:
        """MOVE succeeds when S1 has pushed the target over this angle [deg]."""
        return TURN_SETS[self.turn][2]

    @property
    def start_intervals(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Start angles of S1 [deg]: the right and the left area."""
        if self.start_areas == "bounds":
            return (-30.0, 0.0), (180.0, 210.0)
        blue, green, red = self.sector_centres
        right, left = (blue + green) / 2, (green + red) / 2
        half = self.start_half_width
        return (right - half, right + half), (left - half, left + half)


@cache
def choices() -> dict[str, tuple[str, ...]]:
    """The allowed values of every reading that is a choice between words."""
    hints = get_type_hints(Readings)
    return {name: get_args(hint) for name, hint in hints.items() if get_origin(hint) is Literal}


def given_or_default(readings: Readings | None) -> Readings:
    """The readings that are given, or else the default ones.

    Raises:
        ValueError: If they are of another kind.
    """
    return Readings() if readings is None else checked_readings(readings)


def checked_readings(readings: Readings) -> Readings:
    """The readings that are given.

    Raises:
        ValueError: If they are of another kind, such as the name of a preset.
    """
    if isinstance(readings, Readings):
        return readings
    raise ValueError(
        f"readings = {shortened(readings)} must be a record, such as Readings() or Readings.preset('plain')"
    )


def _check_geometry(readings: Readings) -> None:
    """Refuse worlds in which the experiment makes no sense."""
    _check_interval("object_radius", readings.object_radius, 0.1, 11.8)
    _check_interval("sector_half_width", readings.sector_half_width, 0.1, 30.0)
    _check_interval("start_half_width", readings.start_half_width, 0.0, 30.0)
    centres = readings.sector_centres
    if len(centres) != 3 or not all(-15.0 <= a < b <= 195.0 for a, b in pairwise(centres)):
        raise ValueError(
            f"reading sector_centres = {centres}; "
            "give three rising bearings in [-15, 195] degrees, such as 30, 90, 150"
        )
    (lowest, _), (_, highest) = readings.start_intervals
    if lowest < ALPHA_MIN or highest > ALPHA_MAX:
        raise ValueError(
            f"with sector_centres = {centres}, start_half_width = {readings.start_half_width:g} and "
            f"start_areas = {readings.start_areas!r}, S1 would start between {lowest:g} and {highest:g} "
            f"degrees; it turns from {ALPHA_MIN:g} to {ALPHA_MAX:g}"
        )


def _check_interval(name: str, value: float, low: float, high: float) -> None:
    """Refuse a number outside [low, high], NaN included."""
    if not low <= value <= high:
        shown = f"{value:g}" if isinstance(value, float) else str(value)
        raise ValueError(f"reading {name} = {shown} must lie in [{low:g}, {high:g}]")


def _check_type(name: str, value: Any, default: Any) -> None:
    """Refuse a value of the wrong kind before the comparisons would fail on it."""
    if isinstance(default, str):
        fits = isinstance(value, str)
    elif isinstance(default, float):
        fits = _is_number(value)
    else:
        fits = isinstance(value, (list, tuple)) and all(map(_is_number, value))
    if not fits:
        raise ValueError(f"reading {name} = {value!r} is not of the kind of its default {default!r}")
    numbers = value if isinstance(value, (list, tuple)) else [value]
    if any(isinstance(each, Integral) and abs(int(each)) > LARGEST_WHOLE for each in numbers):
        raise ValueError(f"reading {name} holds a number that no float can hold; its default is {default!r}")


def _is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _as_default(value: Any, default: Any) -> Any:
    """A number as the kind of number the default is, so that 8 and 8.0 are written alike."""
    if isinstance(value, (list, tuple)):
        return tuple(float(each) for each in value)
    return float(value) if isinstance(default, float) else value


PLAIN: Final = Readings(
    mutation_probability=0.4,
    mutation_sd=0.1,
    parent_scaling="raw",
    ties="elders",
    crossover=0.0,
    bias_ranges="symmetric",
    tau_exponent_max=2.0,
    object_radius=5.0,
    sector_half_width=10.0,
    start_areas="between",
    start_half_width=4.0,
    sector_centres=(30.0, 90.0, 150.0),
    bound_vision="at",
    object_vision="centre",
    camera_origin="J1",
    turn="degrees",
    success="f1_f2",
    run_counting="uninterrupted",
    indicate_angle="narrow",
    f3_time="end",
    ignore_stops="early",
    starts_shared="generation",
    collision_penalty="ratio",
)
"""The first alternative of every entry in the ledger, whatever the default is: what one reading at a time is
compared with, and what a config file means that does not name a reading."""

# `printed` takes the paper at its word wherever the word can run. The plain readings do so already but
# in one place: section VI lists an early end for INDICATE, TOUCH and MOVE, not for IGNORE.
PRESETS: Final = {"default": Readings(), "plain": PLAIN, "printed": replace(PLAIN, ignore_stops="never")}
