"""The vertical profile: altitude over time."""

from airhilt.report.sections import Section

SECTION = Section("profile", order=20, module=__file__, within="flight")
