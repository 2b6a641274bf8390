"""The report of a sweep, made from its folder."""

from airhilt.report.sweeps.page import write_sweep_report

__all__ = ["write_sweep_report"]
