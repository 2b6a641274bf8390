"""Checks of the radio: ids, times, frequencies, answers and speakers of lines; names of radios."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator

from airhilt.errors import ScenarioError
from airhilt.host import library
from airhilt.messages import ASSISTANT
from airhilt.scenario.models import Scenario, WildlifeSpec
from airhilt.scenario.problems import Problem
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
    yield from _unknown_stations(scenario)
    yield from _unknown_receivers(scenario)


def _unknown_speakers(scenario: Scenario) -> Iterator[Problem]:
    """Yield speakers and addressees that are neither actors nor declared units."""
    speaking = [a.callsign for a in scenario.actors if not isinstance(a, WildlifeSpec)]
    radio = scenario.radio
    known = dict.fromkeys([*speaking, radio.controller, *radio.stations, ASSISTANT])
    for index, line in enumerate(radio.lines):
        for field, name in (("speaker", line.speaker), ("to", line.to)):
            if name is not None and name not in known:
                tail = library.nearest(name, list(known))
                yield Problem(
                    f"radio/lines/{index}/{field}",
                    f"no actor or unit {name!r}{tail}; a unit besides the controller is declared "
                    f'in radio/stations: {{"{name}": {{}}}}',
                )


def _unknown_stations(scenario: Scenario) -> Iterator[Problem]:
    """Yield the stations of speakers that are not in the scenario."""
    callsigns = [actor.callsign for actor in scenario.actors]
    known = dict.fromkeys([*callsigns, *_units(scenario), ASSISTANT])
    yield from _not_among(known, scenario.radio.stations, "radio/stations")


def _unknown_receivers(scenario: Scenario) -> Iterator[Problem]:
    """Yield the receivers of listeners that are not in the scenario; no animal listens."""
    people = [one.callsign for one in scenario.actors if not isinstance(one, WildlifeSpec)]
    known = dict.fromkeys([*people, *_units(scenario)])
    yield from _not_among(known, scenario.radio.receivers, "radio/receivers")


def _units(scenario: Scenario) -> list[str]:
    """Return the controller, and all who speak or are addressed."""
    radio = scenario.radio
    named = [name for line in radio.lines for name in (line.speaker, line.to) if name]
    return [*named, radio.controller]


def _not_among(known: Collection[str], names: Iterable[str], path: str) -> Iterator[Problem]:
    for name in names:
        if name not in known:
            tail = library.nearest(name, list(known))
            yield Problem(f"{path}/{name}", f"no actor or unit {name!r}{tail}")
