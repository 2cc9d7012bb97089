"""Torture: an experiment is killed, starved and damaged, and must end as if nothing had happened.

`wordarm torture FOLDER` does so on a file system of the user's choice (docs/survival.md).
"""
