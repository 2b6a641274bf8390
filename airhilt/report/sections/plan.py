"""The plan view: tracks, the airport below them, and the traffic at the time shown."""

from airhilt.report.sections import Section

SECTION = Section("plan", order=10, module=__file__, within="flight")
