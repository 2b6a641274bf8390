"""The speech recognisers: one file an engine, each with its `ENGINE`.

A recogniser of another package is found by an entry point of the group ``airhilt.asr`` that names
its `airhilt.engines.Engine`, such as ``mine = "my_package.asr:ENGINE"``.
"""
