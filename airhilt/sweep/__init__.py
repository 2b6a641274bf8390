"""Sweeps: thousands of runs over parameters, seeds and assistants, on Dask.

The main path begins at `airhilt.sweep.engine.sweep`. A `Specification` says what is run, `cases`
makes of it one `Case` a run, workers turn each case into an `Outcome`, and the sweep folder keeps
the outcomes and makes the tables of them.
"""
