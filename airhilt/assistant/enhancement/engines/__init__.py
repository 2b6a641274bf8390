"""The speech enhancers: one file an engine, each with its `ENGINE`.

An enhancer of another package is found by an entry point of the group ``airhilt.enhancers`` that
names its `airhilt.engines.Engine`, such as ``mine = "my_package.enhancer:ENGINE"``.
"""
