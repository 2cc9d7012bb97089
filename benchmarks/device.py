"""What a graphics card does with the trials of many runs, and the processor beside it, within eight minutes.

    python -m benchmarks.device [--device cuda] [--output docs/results/device]
    python -m benchmarks.device --device warp-cpu --tiny      whether it runs at all; its numbers say nothing

Writes device.csv and device.md, row by row; they name the machine. "Extrapolated" are times of whole
experiments: what starting takes, and so many generations at the pace of those between the first and the last
part. These are a run's first, in which less is touched than later: compare "random" and "evolved".
What no time is left for is left out.
"""

from __future__ import annotations

import argparse
import csv
import time
from collections.abc import Sequence
from itertools import chain
from pathlib import Path

from arm2d.device.opening import open_device
from benchmarks import device_stages as stages
from benchmarks.device_stages import Bench, Experiment, Sizes
from benchmarks.device_work import populations_on
from evolution.runs.storage import make_folder
from evolution.search.settings import Settings

STAGES = (
    stages.facts,
    stages.same_bits,
    stages.batches,
    stages.limited_registers,
    stages.experiments,
    stages.post_evaluation,
    stages.other_shares,
)
TINY = Sizes(
    evolved=5,
    batches=(1, 2),
    experiments=(Experiment(2, 200, 6000, 2),),
    other_shares=(),
    registers=(128,),
    settings=Settings(population=6, elites=1, parents=3, trials_per_area=1),
    seconds=0.5,
    agents=10,
)
HEADING = ("stage", "what", "found", "after_s")


def main() -> None:
    """Measure, print and write."""
    parser = argparse.ArgumentParser(description="What a device does with the trials of many runs.")
    parser.add_argument("--device", default="cuda")
    parser.add_argument("--output", type=Path, default=Path("device-benchmark"))
    parser.add_argument("--minutes", type=float, default=8.0, help="no stage begins later")
    parser.add_argument("--tiny", action="store_true", help="see whether it runs")
    given = parser.parse_args()
    began, sizes = time.monotonic(), TINY if given.tiny else Sizes()
    device = open_device(given.device)
    random, evolved = populations_on(given.device, sizes.evolved)
    bench, rows = Bench(device, sizes, random, evolved), []
    make_folder(given.output)
    for row in chain.from_iterable(stage(bench) for stage in STAGES):
        spent = time.monotonic() - began
        rows.append((*row, f"{spent:.0f}"))
        print(*rows[-1], sep=" | ", flush=True)
        write(given.output, device.model, rows)
        if spent > 60 * given.minutes:
            print("what would follow is left out, for lack of time")
            break


def write(folder: Path, model: str, rows: Sequence[Sequence[str]]) -> None:
    """The table so far, as CSV and for readers."""
    with (folder / "device.csv").open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([HEADING, *rows])
    lines = [f"# {model}", "", f"| {' | '.join(HEADING)} |", "| --- | --- | --- | --- |"]
    lines += [f"| {' | '.join(row)} |" for row in rows]
    (folder / "device.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
