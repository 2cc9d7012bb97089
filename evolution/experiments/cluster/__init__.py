"""Runs on other machines: jobs of `evolution.experiments.jobs` as tasks of a Dask cluster (docs/cluster.md).

Dask says who does what; nothing else travels. A task starts its job as a process on the worker's machine, and
all results go where they always go, into a folder that all machines share.
"""
