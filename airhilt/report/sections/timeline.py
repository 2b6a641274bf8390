"""All events of the run in a table."""

from airhilt.report.sections import Section

SECTION = Section("timeline", order=70, module=__file__)
