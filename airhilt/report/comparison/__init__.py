"""Comparisons: of two runs, of two sweeps, or of two assistants of one sweep."""

from airhilt.report.comparison.compare import compare

__all__ = ["compare"]
