"""Before any test loads NumPy: linear algebra has one thread, as `wordarm` itself has it.

Its other threads would turn round and round for the processors on which other tests run.
"""

import os

for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")
