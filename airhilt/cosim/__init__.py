"""A run: its setup, who takes part, its simulation, its replay."""
