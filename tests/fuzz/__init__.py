"""Malformed inputs for every parser of what users give: files, flags, instructions.

python -m tests.fuzz --inputs 10000
"""
