"""The station: runs in a browser. A server reads a run from outside, and a page shows it.

`airhilt.station.server.serve` opens a page at an address; `airhilt.station.debrief.Debrief` is the
content of the page for a run folder.
"""
