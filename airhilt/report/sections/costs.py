"""Costs of the run to the people in it, of the summary."""

from airhilt.report.sections import Section

SECTION = Section("costs", order=27, module=__file__)
