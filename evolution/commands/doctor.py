"""`wordarm doctor`: what works on this machine, what does not, and what to do about it."""

from __future__ import annotations

from dataclasses import dataclass

UNWELL = 1


@dataclass(frozen=True)
class Doctor:
    """Examine this machine: packages, drawing without a screen, cores, cache, disk, video encoder, robots."""

    def run(self) -> int:
        """Examine and print; 1 if something that is needed is missing."""
        from mujoco_port.doctor.examination import examine, report
        from mujoco_port.doctor.findings import lacks

        findings = examine()
        print(report(findings))
        return UNWELL if lacks(findings) else 0
