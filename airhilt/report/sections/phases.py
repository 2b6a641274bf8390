"""The phases of each actor over time."""

from airhilt.report.sections import Section

SECTION = Section("phases", order=60, module=__file__, within="flight")
