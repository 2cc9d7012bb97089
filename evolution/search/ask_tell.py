"""What a search algorithm is: it asks for genotypes and is told their fitness, generation after generation.

    algorithm = begin(config)
    while algorithm.generation < config.settings.generations:
        genotypes = algorithm.ask()                     # [P, G]
        algorithm.tell(score(genotypes))                # [P]

All it has learnt is its state, plain arrays by name, and its random numbers follow from the run's seed and
the generation. So a run can be left and gone on with, and every generation asked for again from the recorded
fitness alone. Axes: P genotypes of a generation, G genes
(84 for three inter-neurons, else what `settings.n_genes` says).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from inspect import signature
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from evolution.search.config import RunConfig
from evolution.search.settings import CMA_ES, GENETIC, NAME

State = Mapping[str, NDArray]

# Where a package tells of algorithms of its own, so that every process of ours finds them.
ENTRY_POINTS: Final = "wordarm.algorithms"


class Algorithm(Protocol):
    """A search in the middle of a run.

    A run makes it anew before every `tell`, from its state alone: what is not in there is lost.

    Attributes:
        generation: Of the genotypes it asks for; the one it was made with, and one more after each `tell`.
    """

    generation: int

    def ask(self) -> NDArray[np.float64]:
        """The genotypes to be scored, [P, G] within [0, 1]; the same ones until they are scored."""
        ...

    def tell(self, fitness: NDArray[np.float64]) -> None:
        """Take the fitness [P] of the genotypes that were asked for, and go on to the next generation."""
        ...

    def state(self) -> dict[str, NDArray]:
        """All that `tell` and the generations after it need, as arrays of numbers by name.

        Two are always among them: `genotypes` [P, G], as asked for, and `parents` [P], which genotype of the
        generation before each descends from; -1 where it descends from none. They come back read-only.
        """
        ...


Maker = Callable[[RunConfig, int, State | None], Algorithm]
"""Makes the algorithm of a run: (the run, the generation, its state then; None in generation 0)."""

_BUILT_IN: Final = {
    GENETIC: "evolution.search.genetic:GeneticAlgorithm",
    CMA_ES: "evolution.search.cma_es:CmaEs",
}
_registered: Final[dict[str, Maker]] = {}


def register_algorithm(name: str, maker: Maker) -> None:
    """Let runs of this process use an algorithm of your own, by its name in their settings.

    Other processes, such as the workers of an experiment, find those that an installed package names among
    its entry points, in the group `wordarm.algorithms`.

    Args:
        name: Small letters, digits and dashes, a letter first.
        maker: Takes (config, generation, state); a class will do.

    Raises:
        ValueError: If the name is one of ours or none that settings can have, or the maker takes other
            arguments.
    """
    if not isinstance(name, str) or not NAME.fullmatch(name):
        raise ValueError(
            f"the algorithm cannot be called {name!r}; give at most 40 small letters, digits and dashes, "
            "a letter first"
        )
    if name in _BUILT_IN:
        raise ValueError(f"the algorithm {name} is one of wordarm's; give yours another name")
    _registered[name] = _checked_maker(name, maker)


def _checked_maker(name: str, maker: Maker) -> Maker:
    """The maker, if it can be called as one; raises `ValueError`."""
    try:
        signature(maker).bind(None, 0, None)
    except TypeError:
        called = getattr(maker, "__name__", repr(maker))
        raise ValueError(
            f"the algorithm {name} cannot be made by {called}; give a class or a function that takes "
            "(config, generation, state)"
        ) from None
    except ValueError:
        pass  # something compiled, which does not tell what it takes
    return maker


def maker_of(config: RunConfig) -> Maker:
    """What makes the algorithm of a run.

    Raises:
        ValueError: If there is no algorithm of that name, or a package's takes other arguments.
    """
    name = config.settings.algorithm
    if name in _BUILT_IN:
        module, _, attribute = _BUILT_IN[name].partition(":")
        return getattr(import_module(module), attribute)
    if name in _registered:
        return _registered[name]
    offered = _offered()
    if name in offered:
        return _checked_maker(name, offered[name].load())
    known = ", ".join([*_BUILT_IN, *_registered, *offered])
    raise ValueError(
        f"the algorithm {name!r} is not known here; there are {known}; one of your own is made known with "
        "evolution.register_algorithm or by its package (docs/how-to/algorithm.md)"
    )


def is_known(config: RunConfig) -> bool:
    """Whether there is an algorithm of the name that a run's settings give."""
    name = config.settings.algorithm
    return name in _BUILT_IN or name in _registered or name in _offered()


def _offered() -> dict[str, EntryPoint]:
    """What installed packages name, by name."""
    return {each.name: each for each in entry_points(group=ENTRY_POINTS)}


def begin(config: RunConfig) -> Algorithm:
    """The algorithm of a run at its generation 0; raises as `maker_of`."""
    return maker_of(config)(config, 0, None)


def taken(name: str, state: State, shapes: Mapping[str, tuple[int, ...]]) -> dict[str, NDArray]:
    """The arrays of a state, refused if they are not those of the algorithm called `name`.

    Args:
        name: Of the algorithm, for the message.
        state: Arrays by name.
        shapes: What they should be; -1 stands for any length.

    Raises:
        ValueError: If one is missing, unknown, of another shape, or holds what is no finite number.
    """
    if state.keys() != shapes.keys():
        raise ValueError(
            f"this is no state of the algorithm {name}: it holds {', '.join(state)}, not {', '.join(shapes)}"
        )
    for key, shape in shapes.items():
        array = state[key]
        fits = len(shape) == array.ndim and all(m in (-1, n) for m, n in zip(shape, array.shape, strict=True))
        if not fits or array.dtype.kind not in "fiub" or not np.isfinite(array).all():
            raise ValueError(f"this is no state of the algorithm {name}: its {key} cannot be {_told(array)}")
    return {key: np.array(state[key]) for key in shapes}


def _told(array: NDArray) -> str:
    sound = array.dtype.kind in "fiub" and np.isfinite(array).all()
    return f"{array.dtype} {array.shape}" + ("" if sound else " with what is no number")
