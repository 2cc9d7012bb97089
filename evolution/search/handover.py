"""What an algorithm hands over to a run in each generation, held against what a run can take.

It has to be scored, written and gone on from, and is kept as plain arrays: an algorithm of a user's own that
is wrong is told so at once, not by a damaged checkpoint. Axes: P genotypes of a generation, G genes.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from arm2d import check_genotypes
from evolution.search.ask_tell import Algorithm
from evolution.search.config import RunConfig
from evolution.search.settings import Settings

# More than these would make checkpoints that are not read again.
MOST_IN_A_STATE: Final = 64
LARGEST_STATE: Final = 32 * 2**20


def handed_over(
    algorithm: Algorithm, config: RunConfig, generation: int
) -> tuple[NDArray[np.float64], NDArray[np.int64], dict[str, NDArray]]:
    """What an algorithm asks for, in the form in which it is kept: genotypes [P, G], parents [P], memory.

    Raises:
        ValueError: If it is at another generation, or gives what cannot be scored, written or gone on from.
    """
    name, settings = config.settings.algorithm, config.settings
    _check_generation(name, algorithm, generation)
    asked, state = algorithm.ask(), _arrays(name, algorithm.state())
    genotypes = _sound_genotypes(name, state.pop("genotypes"), settings)
    parents = _sound_parents(name, state.pop("parents"), settings.population)
    if not np.array_equal(asked, genotypes):
        raise ValueError(
            f"the algorithm {name} gave other genotypes in state() than in ask(), not the same ones"
        )
    return genotypes, parents, state


def _check_generation(name: str, algorithm: Algorithm, due: int) -> None:
    """Refuse what is no algorithm, and one that counts otherwise."""
    for part in ("generation", "ask", "tell", "state"):
        if not hasattr(algorithm, part):
            raise ValueError(f"the algorithm {name} has no {part}; give it generation, ask, tell and state")
    if algorithm.generation != due:
        raise ValueError(
            f"the algorithm {name} is at generation {algorithm.generation}, not {due}; its maker must begin "
            "with the generation it is given, and each tell add 1"
        )


def _arrays(name: str, state: Mapping[str, Any]) -> dict[str, NDArray]:
    """A state as arrays of finite numbers by name, `genotypes` and `parents` among them."""
    if not isinstance(state, Mapping):
        raise ValueError(f"the algorithm {name} gave {type(state).__name__} as its state, not arrays by name")
    if not {"genotypes", "parents"} <= state.keys():
        held = ", ".join(map(str, state)) or "nothing"
        raise ValueError(f"the algorithm {name} gave a state of {held}, not one with genotypes and parents")
    arrays = {key: _array(name, key, value) for key, value in state.items()}
    size = sum(each.nbytes for each in arrays.values()) - arrays["genotypes"].nbytes
    if len(arrays) > MOST_IN_A_STATE or size > LARGEST_STATE:
        raise ValueError(
            f"the algorithm {name} gave a state of {len(arrays)} arrays with {size:,} bytes beside the "
            f"genotypes, not of at most {MOST_IN_A_STATE} with {LARGEST_STATE:,}"
        )
    return arrays


def _array(name: str, key: str, value: Any) -> NDArray:
    """A value of a state as an array; a number, or lists of numbers, will do."""
    if not isinstance(key, str) or not key.isprintable():
        raise ValueError(f"the algorithm {name} gave {key!r} as a name in its state, not plain text")
    try:
        array = np.asarray(value, order="C")
    except (TypeError, ValueError):  # such as lists of different lengths
        array = None
    if array is None or array.dtype.kind not in "fiub":
        raise ValueError(f"the algorithm {name} gave {key} as {_kind(value)}, not as numbers")
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        raise ValueError(f"the algorithm {name} gave {key} with what is no number, not finite numbers alone")
    return array


def _kind(value: Any) -> str:
    """What something is, for a message."""
    found = type(value).__name__
    return f"{found} of {value.dtype}" if isinstance(value, np.ndarray) else found


def _sound_genotypes(name: str, genotypes: NDArray, settings: Settings) -> NDArray[np.float64]:
    """Genotypes as float64 [P, G] within [0, 1]."""
    if genotypes.ndim != 2 or len(genotypes) != settings.population:
        right = (settings.population, settings.n_genes)
        raise ValueError(f"the algorithm {name} gave genotypes of shape {genotypes.shape}, not {right}")
    try:
        return check_genotypes(genotypes, settings.inter_neurons)
    except ValueError as error:
        raise ValueError(f"the algorithm {name} gave genotypes that cannot be scored: {error}") from None


def _sound_parents(name: str, parents: NDArray, size: int) -> NDArray[np.int64]:
    """Parents as int64 [P], each an index below P, or -1."""
    if parents.shape != (size,) or parents.dtype.kind not in "iu":
        raise ValueError(
            f"the algorithm {name} gave parents as {parents.dtype} of shape {parents.shape}, "
            f"not whole numbers of shape {(size,)}"
        )
    low, high = int(parents.min()), int(parents.max())
    if low < -1 or high >= size:
        raise ValueError(f"the algorithm {name} gave parents from {low} to {high}, not from -1 to {size - 1}")
    return parents.astype(np.int64, copy=False)
