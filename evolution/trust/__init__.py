"""Runs computed again, repaired, and killed on purpose: may the results be believed?"""
