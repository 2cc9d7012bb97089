"""Same bits everywhere: the golden runs on kernels compiled for four generations of processors.

    python -m benchmarks.same_bits

Each target is a process of its own, which compiles once (9 to 13 s of CPU) and computes every run of
tests/evolution/runs/golden.json. The machine must be able to run the target's code.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

GOLDEN = Path(__file__).parents[1] / "tests" / "evolution" / "runs" / "golden.json"
# Name of the target, and LLVM's name for the processor; none for the one at hand.
TARGETS = {"plain x86-64": "x86-64", "SSE4.2": "nehalem", "AVX2": "haswell", "this machine": ""}
SCRIPT = """
import json, golden
from numba.core.registry import cpu_target
print(json.dumps({"target": cpu_target.target_context.codegen().magic_tuple()[1],
                  "bits": golden.fingerprints(golden.RUNS)}))
"""


def main() -> int:
    """Compute and compare; 1 if any run has other bits."""
    stored, differences = json.loads(GOLDEN.read_text(encoding="utf-8")), 0
    for name, processor in TARGETS.items():
        began = time.monotonic()
        found = compute(processor)
        differing = [run for run in stored if found["bits"].get(run) != stored[run]]
        differences += len(differing)
        verdict = f"other bits in {', '.join(differing)}" if differing else "the stored bits"
        took = time.monotonic() - began
        print(f"{name} ({found['target']}): {len(stored)} runs, {verdict}; {took:.0f} s", flush=True)
    return 1 if differences else 0


def compute(processor: str) -> dict:
    """Fingerprints of all golden runs, computed by a new process for a processor."""
    target = {"NUMBA_CPU_NAME": processor, "NUMBA_CPU_FEATURES": ""} if processor else {}
    command = [sys.executable, "-c", SCRIPT]
    done = subprocess.run(
        command, cwd=GOLDEN.parent, env={**os.environ, **target}, stdout=subprocess.PIPE, check=True
    )
    return json.loads(done.stdout)


if __name__ == "__main__":
    sys.exit(main())
