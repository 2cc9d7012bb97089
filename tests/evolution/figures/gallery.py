"""Every figure of the project, drawn from numbers that are made up or cheap."""

from functools import cache

import numpy as np

from arm2d import Condition, Readings
from evolution.agents.behaviour import record_behaviour
from evolution.agents.lesions import lesion_scores
from evolution.agents.lineage_scores import LineageScores, Skills
from evolution.agents.subtasks import AgentClass
from evolution.agents.variance import shares_by_event
from evolution.figures.behaviour import lesions_figure, trajectories_figure
from evolution.figures.classes import classes_figure
from evolution.figures.compare import compare_figure
from evolution.figures.concept import concept_figure, example
from evolution.figures.fans import Fan, fans_figure
from evolution.figures.generalisers import generalisers_figure
from evolution.figures.learning import learning_figure
from evolution.figures.lineage import lineage_figure
from evolution.figures.neurons import activity_figure, variance_figure
from evolution.figures.paper import fitness_figure, table_figure
from evolution.figures.run import fitness_curve, heat_map
from evolution.figures.states import state_space_figure
from evolution.figures.transitions import transitions_figure
from evolution.results.classes import ClassBehaviour
from evolution.results.learning import LearningCurve
from evolution.runs.history import History
from evolution.runs.sources import find_agent
from evolution.search.evaluation import evaluate
from evolution.study.beyond.comparisons import comparisons
from evolution.study.beyond.figure import cells_figure
from evolution.study.beyond.groups import groups_of
from evolution.study.declared.claim_figure import claim_figure
from evolution.study.declared.confirmation.less_one import Cost
from evolution.study.declared.confirmation.less_one_figure import less_one_figure
from evolution.study.declared.confirmation.verdict import JUDGED
from evolution.study.declared.confirmation.worlds import departures
from evolution.study.declared.levels_figure import levels_figure
from evolution.study.declared.outcomes import OUTCOMES
from evolution.study.declared.regression import N_MAIN, Estimate, Model, level_numbers
from evolution.study.drawn import Drawn
from evolution.study.figure import effects_figure, failures_figure
from models.robots import ROBOTS
from mujoco_port.film.gl import choose_back_end
from tests.evolution.made_up import both_conditions
from tests.evolution.study.beyond.made_up import made_study
from tests.evolution.study.declared.synthetic import configs, made_up, made_up_answers

choose_back_end()  # before anything imports mujoco: other tests draw in this process

from mujoco_port.reach.certificate import Certificate  # noqa: E402
from mujoco_port.reach.certificate_figure import draw_certificate  # noqa: E402

INDICATE = Condition.WITH_INDICATE
ORIGIN = "runs/mutation-sd-0.03/with-indicate/seed-0013, generation 5,999, rank 0, With-Indicate, 28 trials"
LONG = "sector-half-width-3+start-areas-bounds+sector-centres-45-90-135"


@cache
def behaviour():
    agent = find_agent("best-generaliser")
    return record_behaviour(agent.genotype, agent.condition, agent.readings, per_area=3)


@cache
def agent():
    return find_agent("best-generaliser")


def history(n_generations=3000):
    """A run that rises and stays."""
    rise = 2.5 * (1 - np.exp(-np.arange(n_generations) / 300))
    noise = np.random.default_rng(2).normal(0, 0.02, n_generations)
    none = np.zeros((n_generations, 0))
    best = rise + noise
    numbers = (best, 0.5 * best, 0.5 * best, 0 * best)
    return History(np.arange(n_generations, dtype=np.int32), none, none.astype(np.int16), none, *numbers)


def lines(n_generations=3000):
    """A line of ancestors that learn one thing after another."""
    rng, found = np.random.default_rng(3), []
    for n in (9, 3, 3):
        share = np.zeros((n_generations, n))
        for column in range(n):
            start = int(n_generations * rng.uniform(0.001, 0.6))
            share[start : start + 40, column] = 0.8
            share[start + int(n_generations * 0.2) :, column] = 0.9
        found.append(Skills.along(share))
    return LineageScores(INDICATE, 10, 0, *found)


def class_behaviour(kind, n_runs, rng):
    shares = rng.dirichlet((6, 2, 1, 3), size=(n_runs, 3))
    return ClassBehaviour(
        kind, INDICATE, np.arange(n_runs), np.full(n_runs, 295), np.full(n_runs, 10),
        rng.random((n_runs, 9)), rng.random((n_runs, 8, 9)), shares,
        np.zeros((n_runs, 3, 4, 91)), None,
    )  # fmt: skip


def classes():
    rng = np.random.default_rng(4)
    own = {kind: class_behaviour(kind, n, rng) for kind, n in zip(AgentClass, (1, 3, 0), strict=True)}
    return dict.fromkeys(Condition, own)


def variant(name, n_runs=8, seed=5):
    rng = np.random.default_rng([seed, *name.encode()])
    return Drawn(
        name, INDICATE, 3000, np.arange(1, n_runs + 1), rng.uniform(2.0, 2.57, n_runs),
        rng.random(n_runs) < 0.4, rng.random(n_runs), rng.random(n_runs) < 0.3, rng.random((n_runs, 9, 2)),
    )  # fmt: skip


def screening():
    return [variant(name) for name in ("default", "mutation-sd-0.03", "object-radius-8", LONG)]


def on_top():
    """Variants that share a reading, and that reading alone."""
    names = ("bias-ranges-negative", "tau-exponent-max-0", "bias-ranges-negative+tau-exponent-max-0")
    return [variant(f"mutation-sd-0.03+{name}", n) for n, name in enumerate(names, 8)]


def models():
    """Regressions of every outcome with coefficients that are made up."""
    rng, found = np.random.default_rng(6), {}
    for condition in Condition:
        levels = level_numbers([made_up(config) for config in configs(condition)])
        found[condition] = [
            Model(
                outcome, levels, (), np.r_[0.5, rng.normal(0, 0.2, N_MAIN - 1)], 0.01 * np.eye(N_MAIN),
                rng.random(levels.shape[1]) ** 4, {},
            )
            for outcome in OUTCOMES
        ]  # fmt: skip
    return found


def certificate():
    rng, shape = np.random.default_rng(7), (4, 20, 8)
    layers = [rng.uniform(0.001, 0.06, shape) for _ in range(6)]
    return Certificate(
        np.linspace(-30, 210, 20), np.linspace(0, 90, 8), np.zeros((*shape, 7)), np.zeros(shape),
        *layers, 0.0018,
    )  # fmt: skip


def fans(n):
    name = "seed 7, generation 4467, rank 1"
    return [Fan(kind, name, behaviour(), agent().readings) for kind in list(AgentClass)[:n]]


def curves():
    """Three learners, the last of which learns one of the two that are never met."""
    found = []
    for learner, soonest, seed in (("evolution", 1, 1), ("evolution", 2, 2), ("PPO, LSTM", 30, 1)):
        curve = LearningCurve.empty(learner, INDICATE, seed).longer(0, 0.0, [0] * 9)
        for test in range(1, 20):
            counts = np.minimum(80, np.arange(9) * test)
            curve = curve.longer(1000 * test, soonest * test**2, counts)
        found.append(curve)
    return found


def departures_costs():
    """What each departure of the default is worth in each figure, made up."""
    rng = np.random.default_rng(8)
    return [
        Cost(factor, outcome, rng.normal(0, 0.2, 20), Estimate(-0.1, -0.2, 0.1), 0.1, 0.2 * (k % 2), 3, 14)
        for k, factor in enumerate(departures(Readings()))
        for outcome in JUDGED
    ]


FIGURES = {
    "learning": lambda: learning_figure(curves()),
    "heat-map": lambda: heat_map(evaluate(agent().genotype, INDICATE, Readings()), ORIGIN),
    "fitness-curve": lambda: fitness_curve(history(), ORIGIN),
    "fitness": lambda: fitness_figure(both_conditions()),
    "table-ii": lambda: table_figure(both_conditions()),
    "transitions": lambda: transitions_figure(both_conditions()),
    "generalisers": lambda: generalisers_figure(both_conditions()),
    "compare": lambda: compare_figure({"default": both_conditions(), "mutation-sd-0.03": both_conditions()}),
    "classes": lambda: classes_figure(classes()),
    "fans-1": lambda: fans_figure(INDICATE, fans(1)),
    "fans-2": lambda: fans_figure(INDICATE, fans(2)),
    "fans-3": lambda: fans_figure(INDICATE, fans(3)),
    "trajectories": lambda: trajectories_figure(behaviour(), agent().readings, ORIGIN),
    "lesions": lambda: lesions_figure(
        lesion_scores(agent().genotype, INDICATE, agent().readings, per_area=1), ORIGIN
    ),
    "activity": lambda: activity_figure(behaviour(), ORIGIN),
    "variance": lambda: variance_figure(shares_by_event(behaviour()), ORIGIN),
    "state-space": lambda: state_space_figure(behaviour(), ORIGIN),
    "lineage": lambda: lineage_figure(lines(), ORIGIN),
    "concept": lambda: concept_figure(example(agent().genotype, agent().readings)),
    "effects": lambda: effects_figure(screening()),
    "effects-on-top": lambda: effects_figure(on_top(), variant("mutation-sd-0.03")),
    "failures": lambda: failures_figure(screening()),
    "failures-on-top": lambda: failures_figure(on_top(), variant("mutation-sd-0.03")),
    "levels": lambda: levels_figure(models(), "What each reading does when all are mixed", "300 runs"),
    "claim": lambda: claim_figure(made_up_answers(), "Does INDICATE foster compositionality?", "200 runs"),
    "less-one": lambda: less_one_figure(departures_costs(), Readings(), "One departure less", "180 runs"),
    "beyond": lambda: cells_figure(cells := groups_of(made_study(range(201, 209))), comparisons(cells)),
    "workspace": lambda: draw_certificate(certificate(), ROBOTS["icub"]),
}
