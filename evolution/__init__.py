"""The search for controllers, and the reading of its results.

    settings, config     what determines a run
    randomness           every draw from (seed, purpose, generation)
    algorithm, gaussian  one generation to the next: pure functions on arrays
    population           a generation, and the one that follows it
    scoring              the trials of a generation, and what they are worth
    history              what is kept of scored generations
    storage, folder      files that are whole or refused, and those of a run
    checkpoint, lock     where a run can go on, and that one process does
    recorded, replay     what a run has recorded; every genotype again, without a trial
    run, repair          a run from first to last generation; its damaged files again
    verify               a run computed again and compared
    grid, experiment_spec, variants, plan         many runs: the file that names them, what it asks for, their
                         names, their folders and jobs
    plan_runner, jobs    a plan carried out, one process for each run; workers, fork_server: the processes
    standing, live_table how far runs have come, and how that is shown
    evaluation, champion all nine instructions; the agents a run is remembered by
    sources, recording   a run, a file or a name -> genotype and its world -> a recorded trial
    figures, tables      evaluations and fitness, drawn and written
    style, drawings      what all figures share; PNG, and SVG that stays small
    postevaluation, transition_test, solving      the tests of a run's late agents, kept beside it
    transitions, subtasks                         what these tests ask; categories and classes of agents
    experiment, tested_runs                       runs that belong together; those that can be analysed
    analysis, results, comparisons, statistics    files to numbers; the numbers; the conditions compared
    generalisers, notable                         compositional agents over time; single ones to look at
    result_files, result_rows, figures_...        tables and figures
    lineage, lineage_scores, innovations          an agent's ancestors, and when each skill came
    behaviour, events, variance, lesions          what an agent does, and which word it needs when
    class_observation, class_results, class_files the same for classes of agents, the run as the unit
    key_numbers, published                        an experiment in a few numbers; the paper's
    report, report_...                            the page
    plan, jobs, workers, reproduce, stage_times   the whole paper in processes of their own
    study/               many readings against the published figures, and what each changes by itself
    cluster/, torture/   the same runs on other machines; kills and damage, to see what they survive
    meta, progress       with what a run was computed; how it gets on
    cli, commands/       the command line

Modules are imported by their names, such as `from evolution.runs.run import evolve`: the command line
answers `--help` without loading the compiled ones.
"""
