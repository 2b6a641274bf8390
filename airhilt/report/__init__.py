"""The report of a run, made from its run folder."""

from airhilt.report.page import write_report

__all__ = ["write_report"]
