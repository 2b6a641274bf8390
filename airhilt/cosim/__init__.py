"""A run: its setup, who takes part, its simulation, its replay.

The main path of AIRHILT begins at `airhilt.cosim.simulation.run`.
"""
