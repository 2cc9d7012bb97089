"""Experiments whose trials run on a device (`arm2d.device`), with the files and bits of single runs.

- jobs: batches of runs, each in a process of its own, and how these share devices
- stages: what such a process does
- batch: many runs that advance together
- scoring: a generation of all of them in one go; on the processor when the device is lost
- late_tests: the paper's tests, a part of a run at a time
"""
