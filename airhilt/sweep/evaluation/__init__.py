"""Evaluations: sweeps that are given by a preset, and the tables that are made of them.

The main path begins at `airhilt.sweep.evaluation.engine.evaluate`. A `Preset` says which sweeps
there are and makes tables of their rows; `scores` has the numbers in the cells.
"""
