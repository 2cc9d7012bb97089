"""`wordarm verify`: whether a run is what its config.toml gives, or an archive what was packed."""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

from tyro.conf import Positional, arg

if TYPE_CHECKING:
    from evolution.runs.folder import RunFolder
    from evolution.trust.verify import Findings

DIFFERS: Final = 1
RANGE: Final = re.compile(r"(\d{1,9})(?:-(\d{1,9}))?")


@dataclass(frozen=True)
class Verify:
    """Compute a run again from its config.toml alone and compare it bit by bit; nothing is written into it.

    Exit code 1 if anything differs or cannot be read. By default every generation is scored again; otherwise
    the others are bred from the fitness that was recorded, and parents and best genotypes are compared.
    An archive of results is compared with its checksums instead, and the first damaged file is named.
    """

    run_folder: Annotated[Positional[Path], arg(metavar="RUN|ARCHIVE")]
    """Run folder, finished or not; or an archive that `wordarm analyse --archive` made."""

    generations: str | None = None
    """Score only these again, such as 100-199, or 42."""

    sample: int | None = None
    """Score only so many again, spread evenly over the run."""

    repair: bool = False
    """Instead of comparing, compute the damaged or missing files again, with the bits they had."""

    unpack: Path | None = None
    """Of an archive that is whole, write its files into a new folder in this one."""

    def run(self) -> int:
        """Compare and print the verdict, or repair."""
        from evolution.trust.archive import SUFFIX, is_archive

        if not self.run_folder.exists():
            raise ValueError(f"{self.run_folder} is not there; give the folder of a run, or an archive")
        if self.run_folder.is_file():
            if not is_archive(self.run_folder):
                raise ValueError(f"{self.run_folder} is no archive of results; give such as results{SUFFIX}")
            return self._check_archive()
        if self.unpack is not None:
            raise ValueError(f"--unpack is about archives, which {self.run_folder} is not")
        if self.repair:
            return self._repair()
        return self._compare()

    def _repair(self) -> int:
        if self.generations is not None or self.sample is not None:
            raise ValueError("--repair scores what is damaged; leave --generations and --sample out")
        from evolution.trust.repair import repair

        n_repaired = repair(self.run_folder, print)
        print(f"{self.run_folder} is sound" + (f": {n_repaired} files repaired" if n_repaired else ""))
        return 0

    def _check_archive(self) -> int:
        """Compare an archive with its checksums, and unpack it if that is asked for."""
        from evolution.runs.storage import DamagedFileError
        from evolution.trust.archive import read_archive, unpack

        if self.repair or self.generations is not None or self.sample is not None:
            raise ValueError("--repair, --generations and --sample are about runs; leave them out")
        try:
            files = read_archive(self.run_folder)
        except DamagedFileError as error:
            print(error)
            return DIFFERS
        print(f"{self.run_folder} is whole: {len(files)} files are as they were packed")
        if self.unpack is not None:
            print(unpack(files, self.unpack))
        return 0

    def _compare(self) -> int:
        from rich.console import Console

        from evolution.commands.progress import shown_progress
        from evolution.runs.folder import RunFolder
        from evolution.trust.verify import reached, verify

        folder = RunFolder.open(self.run_folder)
        total = reached(folder)
        chosen = self._chosen(total)
        if not total:
            raise ValueError(f"{folder.path} has recorded no generation yet; go on with: wordarm evolve")
        with shown_progress(Console(), total) as show:
            findings = verify(folder, chosen, show)
        for sentence in findings.damage:
            print(sentence)
        print(verdict(folder, findings))
        return 0 if findings.agrees else DIFFERS

    def _chosen(self, total: int) -> Collection[int] | None:
        """The generations to be scored again; None for all."""
        if self.generations is not None and self.sample is not None:
            raise ValueError("--generations and --sample exclude each other; give one of them")
        if self.sample is not None:
            if not 1 <= self.sample <= total:
                raise ValueError(f"--sample {self.sample} must lie in [1, {total}], the run's generations")
            return {i * total // self.sample for i in range(self.sample)}
        if self.generations is None:
            return None
        found = RANGE.fullmatch(self.generations)
        first, last = (int(found[1]), int(found[2] or found[1])) if found else (0, -1)
        if not first <= last < total:
            raise ValueError(
                f"--generations {self.generations} is no range of this run's; it has 0-{total - 1}: "
                "give such as 0-99, or 42"
            )
        return range(first, last + 1)


def verdict(folder: RunFolder, findings: Findings) -> str:
    """What came of it, in one sentence."""
    total, asked = findings.walked, folder.config.settings.generations
    how = f"{findings.scored} of {total} generations scored again"
    if findings.difference:
        return f"{folder.path} DIFFERS from what its config.toml gives: {findings.difference}"
    if findings.damage:
        n = len(findings.damage)
        files = "1 file is" if n == 1 else f"{n} files are"
        return f"{folder.path} is not whole: {files} missing or damaged; all else agrees, {how}"
    so_far = "" if total == asked else f" so far, {total} of {asked} generations"
    compared = "parents, best genotypes" + (" and champions" if findings.champions else "")
    return f"{folder.path} agrees to the last bit{so_far}: {how}; {compared} compared in all"
