"""The player, and the charts over time and space that it moves."""

from airhilt.report.sections import Section

SECTION = Section("flight", order=30, module=__file__)
