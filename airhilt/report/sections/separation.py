"""The separation of the pair over time."""

from airhilt.report.sections import Section

SECTION = Section("separation", order=30, module=__file__, within="flight")
