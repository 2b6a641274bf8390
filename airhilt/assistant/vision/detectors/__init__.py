"""The detectors: one file an engine, each with its `ENGINE`.

A detector of another package is found by an entry point of the group ``airhilt.detectors`` that
names its `airhilt.engines.Engine`, such as ``mine = "my_package.detector:ENGINE"``.
"""
