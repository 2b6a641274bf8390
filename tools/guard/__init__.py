"""Comparison of runs with and without the guard against words in doubt."""
