"""MAP-Elites as an algorithm of your own: the archive is pyribs', the rest is what a run needs of a search.

It keeps the best genotype of each kind of behaviour: how far agents stretch out, and how long they take.
Needs `pip install ribs`. Run me: python map_elites.py FOLDER
"""

import sys

import numpy as np
from ribs.archives import GridArchive

import arm2d
import evolution
from evolution.search.algorithm import mutate
from evolution.search.randomness import Purpose, generator

CELLS = (20, 20)


class MapElites:
    """Asks for mutated copies of elites; is told their fitness, and looks at their behaviour itself."""

    def __init__(self, config, generation=0, state=None):
        self.config, self.generation = config, generation
        n_genotypes, n_genes = config.settings.population, config.settings.n_genes
        self.archive = GridArchive(solution_dim=n_genes, dims=CELLS, ranges=[(0, 1), (0, 1)])
        if state is None:
            draws = generator(config.seed, Purpose.INITIAL_GENOTYPES)
            self.genotypes = draws.random((n_genotypes, n_genes))
            return
        self.genotypes = state["genotypes"]
        if len(state["elites"]):
            self.archive.add(state["elites"], state["elites_fitness"], state["behaviour"])

    def ask(self):
        """The genotypes to be scored, [P, 84]."""
        return self.genotypes

    def tell(self, fitness):
        """Put them where they belong in the archive, and mutate elites."""
        self.generation += 1
        self.archive.add(self.genotypes, fitness, self.behaviour_of(self.genotypes))
        elites = self.archive.data("solution")
        draws = generator(self.config.seed, Purpose.MUTATION, self.generation)
        chosen = elites[draws.integers(len(elites), size=len(self.genotypes))]
        self.genotypes = mutate(chosen, probability=0.4, sd=0.1, rng=draws)

    def behaviour_of(self, genotypes):
        """Mean F3 and mean duration of seven trials, the same for all genotypes, [P, 2]."""
        starts = np.random.default_rng(0)
        condition, readings = self.config.condition, self.config.readings
        trials = arm2d.draw_trials(condition.experienced, 1, readings, starts, task=condition)
        scores = arm2d.run_trials(genotypes, trials[::2], readings)
        return np.stack([scores.f3.mean(axis=1), scores.steps.mean(axis=1) / 250], axis=1)

    def state(self):
        """Plain arrays: with them and the recorded fitness, a run goes on with the bits it would have had."""
        elites = self.archive.data(["solution", "objective", "measures"])
        return {
            "genotypes": self.genotypes,
            "parents": np.full(len(self.genotypes), -1),
            "elites": elites["solution"],
            "elites_fitness": elites["objective"],
            "behaviour": elites["measures"],
        }


evolution.register_algorithm("map-elites", MapElites)

if __name__ == "__main__":
    settings = evolution.Settings(algorithm="map-elites", generations=300)
    run = evolution.evolve(sys.argv[1], evolution.RunConfig(settings=settings))
    print(f"best fitness after {run.generations} generations: {run.history.best[-1]:.3f}")
