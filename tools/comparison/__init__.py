"""Comparison of assistants over scenarios and seeds."""
