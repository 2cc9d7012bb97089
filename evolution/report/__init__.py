"""Rows, tables, sentences and the HTML page."""
