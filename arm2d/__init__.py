"""The planar world of the experiment: instructions, controller, trials.

    import arm2d
    trials = arm2d.draw_trials(["touch green", "move red"], per_area, readings, rng)
    scores = arm2d.run_trials(genotypes, trials, readings)
    record = arm2d.record_trial(genotype, trials[0], readings)

`__init__.pyi` names what is here. A name is loaded when it is first used: whoever only needs `Readings`
(the command line's `--help`) does not wait for Numba.
"""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
