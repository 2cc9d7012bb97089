"""The search for controllers, and the reading of its results.

    settings, config     what determines a run
    randomness           every draw from (seed, purpose, generation)
    algorithm, gaussian  one generation to the next
    scoring              the trials of a generation, and what they are worth
    storage, folder      what a run leaves behind, and how it is read back
    replay               every genotype again, from parents and seeds
    run, repair          a run from first to last generation, and its damaged files again
    evaluation, champion all nine instructions; the agents a run is remembered by
    sources              a run, a file or a name -> genotype, condition and readings
    figures, tables      evaluations and fitness, drawn and written
    cli, commands/       the command line

Modules are imported by their names, such as `from evolution.run import evolve`: the command line
answers `--help` without loading the compiled ones.
"""
