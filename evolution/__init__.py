"""The search for controllers, and the reading of its results.

    import evolution
    run = evolution.evolve("run", evolution.RunConfig("with-indicate", seed=1))
    run.history.best                                # [G], also mean, median, worst
    champion = run.champions[0]
    champion.evaluate()                             # on all nine instructions, two of which it never met
    champion.record("touch green")                  # a trial, step by step

The way of the data is the way of the rooms:

    search        from one generation to the next: settings, randomness, the genetic algorithm, scoring
    runs          one run on disk: the loop that evolves (run.py), history, checkpoint, replay
    agents        what evolved agents do: the paper's tests, ancestors, behaviour, lesions
    experiments   many runs: the file that names them, plan, processes, other machines
    results       from run folders to numbers: analysis, statistics, the paper's numbers
    figures       one module for each kind of figure
    report        rows, tables, sentences, the page
    study         which reading of the paper comes nearest
    trust         verify, repair, torture
    commands      the command line

`library.py` holds what a user holds: runs and agents. `__init__.pyi` names what is here; a name is loaded
when it is first used, so that the command line answers `--help` without the compiled modules.
"""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
