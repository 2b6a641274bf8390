"""Checks of the radio: ids, times, frequencies, answers and speakers of lines; names of radios."""

from __future__ import annotations

import re
from collections.abc import Iterator

from airhilt.errors import ScenarioError
from airhilt.host import library
from airhilt.messages import ASSISTANT
from airhilt.scenario.conversation import unsayable_lines
from airhilt.scenario.models import Scenario, WildlifeSpec
from airhilt.scenario.problems import Problem, unknown
from airhilt.scenario.vhf_channels import channel_spacing_khz

GENERATED_ID = re.compile(
    r"^stuck-microphone\.|\.(?:readback|correction|(?:repeat|say-again)-[0-9]+)$", re.IGNORECASE
)
"""Beginnings and endings of the ids of calls that are not in the script (docs/radio.md)."""


def impossible_lines(scenario: Scenario) -> Iterator[Problem]:
    """Yield lines that cannot be said as they are, and radios of nobody in the scenario."""
    line_ids = [line.id for line in scenario.radio.lines]
    frequencies: dict[str, int] = {}
    for index, line in enumerate(scenario.radio.lines):
        path = f"radio/lines/{index}"
        if GENERATED_ID.search(line.id):
            yield Problem(
                f"{path}/id",
                f"found {line.id!r}, which is how calls that are not in the script are named; "
                "expected an id that neither begins with stuck-microphone. nor ends with "
                ".readback, .correction, .repeat-1 or .say-again-1",
            )
        try:
            channel_spacing_khz(line.frequency_khz)
        except ScenarioError as error:
            yield Problem(f"{path}/frequency_khz", str(error))
        if line.answers is not None and line.answers not in frequencies:
            tail = library.nearest(line.answers, line_ids)
            yield Problem(f"{path}/answers", f"no line {line.answers!r} before {line.id!r}{tail}")
        elif line.answers is not None and frequencies[line.answers] != line.frequency_khz:
            yield Problem(
                f"{path}/answers",
                f"line {line.answers!r} is on {frequencies[line.answers]} kHz; expected one on "
                f"{line.frequency_khz} kHz",
            )
        frequencies[line.id] = line.frequency_khz
    yield from _unknown_speakers(scenario)
    yield from _unknown_radios(scenario)


def _unknown_speakers(scenario: Scenario) -> Iterator[Problem]:
    """Yield speakers and addressees that are neither actors nor declared units."""
    speaking = [a.callsign for a in scenario.actors if not isinstance(a, WildlifeSpec)]
    radio = scenario.radio
    known = dict.fromkeys([*speaking, radio.controller, *radio.stations, ASSISTANT])
    for index, line in enumerate(radio.lines):
        for field, name in (("speaker", line.speaker), ("to", line.to)):
            if name is not None and name not in known:
                yield unknown(
                    f"radio/lines/{index}/{field}",
                    "actor or unit",
                    name,
                    known,
                    "; a unit besides the controller is declared in radio/stations: "
                    f'{{"{name}": {{}}}}',
                )


def _unknown_radios(scenario: Scenario) -> Iterator[Problem]:
    """Yield stations and receivers of nobody in the scenario; no animal listens."""
    radio = scenario.radio
    named = [name for line in radio.lines for name in (line.speaker, line.to) if name]
    units = [*named, radio.controller]
    actors = [actor.callsign for actor in scenario.actors]
    people = [one.callsign for one in scenario.actors if not isinstance(one, WildlifeSpec)]
    for path, names, known in (
        ("radio/stations", radio.stations, dict.fromkeys([*actors, *units, ASSISTANT])),
        ("radio/receivers", radio.receivers, dict.fromkeys([*people, *units])),
    ):
        for name in names:
            if name not in known:
                yield unknown(f"{path}/{name}", "actor or unit", name, known)


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
