"""Radio calls with the truth of each, written from FAA and ICAO documents alone.

`calls.corpus` draws the calls. `degrade.degraded` puts the errors of a speech recogniser into them.
"""
