"""The commands of `wordarm`: one file, one frozen record of options each, with a `run` method.

Nothing compiled or slow is imported outside `run`, so that `--help` answers at once.
"""
