"""Recorded traffic: reads the files of receivers and archives, one module a format.

Two names matter: `reading.read_traffic` reads a file, and `importing.scenario_of` makes a scenario
of what it has.
"""
