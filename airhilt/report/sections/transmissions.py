"""The transmissions on each frequency, and the spoken advisories, over time."""

from airhilt.report.sections import Section

SECTION = Section("transmissions", order=40, module=__file__, within="flight")
