"""The wordings: one file an engine, each with its `ENGINE`.

A wording of another package is found by an entry point of the group ``airhilt.wording`` that names
its `airhilt.engines.Engine`, such as ``mine = "my_package.wording:ENGINE"``.
"""
