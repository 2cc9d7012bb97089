"""How far all runs below a folder have come: those that are planned, and those that are found."""

from __future__ import annotations

from pathlib import Path

from evolution.experiments.experiment import open_experiment
from evolution.experiments.plan import Plan
from evolution.experiments.plan_file import read_plan
from evolution.experiments.standing import Standing, standing_of
from evolution.runs.folder import CONFIG, RunFolder

# One run; an experiment; an experiment with variants.
LAYOUTS = (CONFIG, f"*/*/{CONFIG}", f"*/*/*/{CONFIG}")


def experiment_standings(path: Path) -> dict[Path, Standing]:
    """The standing of every run, by its folder: first those of the plan, then others.

    Args:
        path: Folder of an experiment, of one of its variants, or of a run.

    Raises:
        ValueError: If there is neither run nor plan, or one of their files cannot be understood.
    """
    plan = read_plan(path)
    standings = {plan.path(each): plan.standing(each) for each in plan.configs} if plan else {}
    to_be_tested = _tests_belong_to(path, plan)
    for file in sorted(each for layout in LAYOUTS for each in path.glob(layout)):
        folder = file.parent
        if folder not in standings:
            depth = len(folder.relative_to(path).parts)
            variant = folder.parts[-3] if depth == 3 else ""
            config = RunFolder.open(folder).config
            standings[folder] = standing_of(folder, config, variant=variant, to_be_tested=to_be_tested)
    if not standings:
        open_experiment(path)  # says what would be right
    return standings


def _tests_belong_to(path: Path, plan: Plan | None) -> bool:
    """Whether post-evaluation is part of the runs; so it is unless a plan says otherwise."""
    for above in (path, path.parent, path.parent.parent, path.parent.parent.parent):
        plan = plan or read_plan(above)
    return plan.post_evaluate if plan else True
