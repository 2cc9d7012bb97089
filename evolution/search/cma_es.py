"""CMA-ES (package `cmaes`) as one that asks and is told, begun anew with more candidates where it is stuck.

An iteration draws candidates from a normal distribution, clipped to [0, 1], and moves the distribution
towards the better ones. The first search draws as many as a generation has genotypes; after `cma_patience`
iterations that brought nothing better another one begins, with twice as many, whose iterations are shared out
over two generations, then four. Every generation meets trials of its own, so candidates are compared by how
far they lie above the mean of their generation.

What is drawn is drawn from the run's seed and the generation, and linear algebra is done by one thread: a run
gone on with has the bits it would have had. Another processor's NumPy may round otherwise. Axes: L candidates
of an iteration, P of a generation, G genes (84 for three inter-neurons).
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from functools import cache
from typing import Final

import numpy as np
from cmaes import CMA
from numpy.typing import NDArray
from threadpoolctl import ThreadpoolController

from arm2d.constants import N_GENES
from evolution.search.algorithm import mean_in_order
from evolution.search.ask_tell import State, taken
from evolution.search.config import RunConfig
from evolution.search.randomness import Purpose, generator
from evolution.search.settings import CMA_ES

# What counts as better, as a share of the largest fitness: less is what fresh trials alone bring about.
LEAST_GAIN: Final = 0.005
# A search that has come so near to the largest fitness is not stuck; share of it.
SOLVED: Final = 0.97
# What of the package's optimiser changes from one iteration to the next, besides mean, sigma and covariance.
PATHS: Final = {"path_sigma": "_p_sigma", "path_covariance": "_pc", "iteration": "_g"}
# Beyond, no search gets more candidates: the package makes L matrices of G x G at a time. 3200 of 84 genes.
MOST_NUMBERS: Final = 3200 * N_GENES * N_GENES


class CmaEs:
    """CMA-ES with restarts.

    Its state: the distribution (`mean`, `sigma`, `covariance`, two paths, `iteration`), the candidates of the
    iteration at hand and how far those told lie above the mean (`candidates` [L, G], `above`), the best
    fitness of the iteration so far (`level`), the highest level of this search, and for how many iterations
    it has stood (`highest`, `idle`).

    Raises:
        ValueError: At a state that is another algorithm's.
    """

    def __init__(self, config: RunConfig, generation: int = 0, state: State | None = None) -> None:
        self._config, self.generation = config, generation
        self._size, self._n_genes = config.settings.population, config.settings.n_genes
        if state is None:
            self._begin_search(self._size)
            return
        self._state = taken(CMA_ES, state, _shapes(self._size, self._n_genes))
        done, n_candidates = len(self._state["above"]), len(self._state["candidates"])
        if n_candidates % self._size or done % self._size or not done < n_candidates:
            raise ValueError(
                f"this is no state of the algorithm {CMA_ES}: of {n_candidates} candidates {done} are told, "
                f"but {self._size} are at a time"
            )

    def ask(self) -> NDArray[np.float64]:
        """The next [P, G] of the iteration's candidates."""
        return self._state["genotypes"]

    def tell(self, fitness: NDArray[np.float64]) -> None:
        """Note how good they are; when all of the iteration are known, move the distribution."""
        state = self._state
        self.generation += 1
        state["above"] = np.append(state["above"], fitness - mean_in_order(fitness))
        state["level"] = np.array(max(float(state["level"]), float(fitness.max())))
        if len(state["above"]) < len(state["candidates"]):
            self._show()
            return
        self._note_level()
        if state["idle"] >= self._config.settings.cma_patience:
            n_candidates = len(state["candidates"])
            twice = 2 * n_candidates
            self._begin_search(twice if twice * self._n_genes**2 <= MOST_NUMBERS else n_candidates)
        else:
            self._move()

    def state(self) -> dict[str, NDArray]:
        """See the class."""
        return dict(self._state)

    def _note_level(self) -> None:
        """Count for how long nothing has been better; one that is nearly perfect need not become better."""
        state = self._state
        largest = self._config.task.largest_fitness
        better = state["level"] >= state["highest"] + LEAST_GAIN * largest
        if better:
            state["highest"] = state["level"]
        stands = not better and state["level"] < SOLVED * largest
        state["idle"] = np.array(int(state["idle"]) + 1 if stands else 0)

    def _begin_search(self, n_candidates: int) -> None:
        """Candidates of a new search, around a mean drawn from the middle half of each gene."""
        draws = generator(self._config.seed, Purpose.CMA_ES_MEAN, self.generation)
        self._state = {
            "highest": np.array(0.0),
            "idle": np.array(0),
            "mean": 0.25 + 0.5 * draws.random(self._n_genes),
            "sigma": np.array(self._config.settings.cma_sigma),
            "covariance": np.eye(self._n_genes),
            "path_sigma": np.zeros(self._n_genes),
            "path_covariance": np.zeros(self._n_genes),
            "iteration": np.array(0),
        }
        self._draw(n_candidates)

    def _move(self) -> None:
        """Tell the package what the candidates are worth, and draw those of the next iteration."""
        state = self._state
        with _one_thread():
            optimiser = self._optimiser(len(state["candidates"]))
            losses = (-state["above"]).tolist()  # the package minimises
            optimiser.tell(list(zip(state["candidates"], losses, strict=True)))
        # A mean of what lies in [0, 1] may be rounded out of it.
        state["mean"] = np.clip(optimiser.mean, 0.0, 1.0)
        state["sigma"], state["covariance"] = np.array(float(optimiser._sigma)), optimiser._C
        state |= {name: np.array(getattr(optimiser, own)) for name, own in PATHS.items()}
        self._draw(len(state["candidates"]))

    def _draw(self, n_candidates: int) -> None:
        """Draw the candidates of an iteration."""
        draws = generator(self._config.seed, Purpose.CMA_ES, self.generation)
        with _one_thread():
            optimiser = self._optimiser(n_candidates)
            optimiser.reseed_rng(int(draws.integers(2**32)))
            candidates = np.array([optimiser.ask() for _ in range(n_candidates)])
        self._state |= {"candidates": candidates, "above": np.empty(0), "level": np.array(0.0)}
        self._show()

    def _show(self) -> None:
        """Ask for the next of the candidates."""
        done = len(self._state["above"])
        self._state["genotypes"] = self._state["candidates"][done : done + self._size].copy()
        self._state["parents"] = np.full(self._size, -1)

    def _optimiser(self, n_candidates: int) -> CMA:
        """The package's optimiser with our state.

        It is made anew whenever it is used, so that a run gone on with and one never left go the same way.
        """
        state = self._state
        optimiser = CMA(
            mean=state["mean"],
            sigma=float(state["sigma"]),
            cov=state["covariance"].copy(),
            bounds=np.tile([0.0, 1.0], (len(state["mean"]), 1)),
            # Candidates outside are clipped: with dozens of genes hardly any lies inside by itself.
            n_max_resampling=0,
            population_size=n_candidates,
        )
        for name, own in PATHS.items():
            assert hasattr(optimiser, own), "another cmaes than the one this was written for"  # noqa: S101
            setattr(optimiser, own, state[name].copy() if state[name].ndim else int(state[name]))
        return optimiser


def _shapes(size: int, n_genes: int) -> dict[str, tuple[int, ...]]:
    """Of the arrays of a state; -1 for the numbers of an iteration's candidates."""
    numbers = ("highest", "idle", "sigma", "iteration", "level")
    return {
        **dict.fromkeys(numbers, ()),
        **dict.fromkeys(("mean", "path_sigma", "path_covariance"), (n_genes,)),
        "covariance": (n_genes, n_genes),
        "candidates": (-1, n_genes),
        "above": (-1,),
        "genotypes": (size, n_genes),
        "parents": (size,),
    }


def _one_thread() -> AbstractContextManager[object]:
    """While open, linear algebra keeps to one thread: sums then have one order, and small ones are faster."""
    return _libraries().limit(limits=1, user_api="blas")


@cache
def _libraries() -> ThreadpoolController:
    return ThreadpoolController()
