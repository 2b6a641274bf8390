"""Checks of a scenario file for radio lines that are never said."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.scenario.conversation import unsayable_lines
from airhilt.scenario.models import Scenario
from airhilt.scenario.problems import Problem


def unsaid_lines(scenario: Scenario) -> Iterator[Problem]:
    """Yield lines after the end of the run, and lines whose condition can never come true."""
    unsayable = unsayable_lines(scenario)
    for index, line in enumerate(scenario.radio.lines):
        path = f"radio/lines/{index}"
        if line.at_s >= scenario.duration_s:
            yield Problem(
                f"{path}/at_s",
                f"found {line.at_s:g}, when the run has ended; expected less than duration_s, "
                f"{scenario.duration_s:g}",
            )
        if line.id in unsayable:
            yield Problem(
                f"{path}/when",
                "found a condition that never comes true: it waits for this line itself, for "
                "lines that wait for it, or for a time after the run",
            )
