"""Who speaks on each frequency, and what the assistant says aloud, over time."""

from airhilt.report.sections import Section

SECTION = Section("transmissions", order=40, module=__file__, within="flight")
