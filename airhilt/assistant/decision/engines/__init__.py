"""The decision engines: one file an engine, each with its `ENGINE`.

An engine of another package is found by an entry point of the group ``airhilt.assistants`` that
names its `airhilt.engines.Engine`, such as ``mine = "my_package.assistant:ENGINE"``.
"""
