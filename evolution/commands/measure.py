"""`wordarm measure`: the numbers by which studies compare a run."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tyro.conf import Positional


@dataclass(frozen=True)
class Measure:
    """Say by which numbers a study compares a run: plateau, first solution, Table II's top category.

    Of the late generations every tenth is tested; `wordarm postevaluate` tests all of them.
    """

    run_folder: Positional[Path]
    """Folder of a finished run."""

    transitions: bool = False
    """Test the same agents with words that change in mid-trial, too."""

    def run(self) -> int:
        """Measure, keep what was simulated beside the run, and print."""
        from evolution.agents.subtasks import SUBTASKS
        from evolution.runs.folder import RunFolder
        from evolution.runs.lock import locked
        from evolution.study.late_transitions import passed_transitions
        from evolution.study.measures import measure

        run = RunFolder.open(self.run_folder)
        with locked(run.path):
            found = measure(run)
            passed = passed_transitions(run, found) if self.transitions else ()
        first = found.first_solved if found.first_solved >= 0 else "never"
        print(f"plateau of the best fitness: {found.plateau:.3f}")
        print(f"first generation in which one genotype carried out all trials: {first}")
        print(f"late generations in which one did: {100 * found.solved_late:.1f} %")
        for name, share in zip(SUBTASKS, found.top_shares, strict=True):
            print(f"late agents in category 10 of sub-task {name}: {100 * share:.1f} %")
        for kind, share in found.class_shares.items():
            print(f"{kind} agents: {100 * share:.1f} %")
        for kind, counts in zip(found.class_shares, passed, strict=False):
            print(f"{kind} agents that pass action and object transitions: {counts[0]}, {counts[1]}")
        return 0
