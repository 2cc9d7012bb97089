"""`python -m tests.fuzz`: many malformed inputs of every kind, and a tally."""

import argparse
import os
import random
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from tests.fuzz.inputs import KINDS
from tests.fuzz.places import Place
from tests.fuzz.trial import fault_of


def main() -> int:
    """Fuzz; the exit code is 1 if any input was answered badly."""
    options = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    options.add_argument("--inputs", type=int, default=10_000, help="how many, shared by all kinds")
    options.add_argument("--seed", type=int, default=1, help="all inputs follow from it")
    options.add_argument("--kind", choices=KINDS, help="this kind only")
    options.add_argument("--first", type=int, default=0, help="number of the first input, to repeat one")
    asked = options.parse_args()
    kinds = [asked.kind] if asked.kind else list(KINDS)
    with tempfile.TemporaryDirectory() as home:
        os.chdir(home)
        return fuzz(Place(Path(home) / "place"), kinds, asked.seed, asked.first, asked.inputs)


def fuzz(place: Place, kinds: list[str], seed: int, first: int, n: int) -> int:
    """Give each input to its reader; print what was answered badly, and a tally with CPU times."""
    refused, read, faults, slowest = Counter(), Counter(), 0, {}
    for number in range(first, first + n):
        kind = kinds[number % len(kinds)]
        reader = KINDS[kind](random.Random(f"{seed} {kind} {number}"), place)
        began = time.process_time()
        code, fault = fault_of(reader, place)
        slowest[kind] = max(slowest.get(kind, 0.0), time.process_time() - began)
        (refused if code == 2 else read)[kind] += 1
        place.clear()
        if fault:
            faults += 1
            print(f"--seed {seed} --kind {kind!r} --first {number} --inputs 1: {fault}", file=sys.stderr)
    for kind in kinds:
        print(f"{kind}: {refused[kind]} refused, {read[kind]} read; at most {slowest.get(kind, 0.0):.2f} s")
    print(f"{n} inputs, {faults} answered badly")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
