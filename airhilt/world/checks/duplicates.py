"""Checks of names that must differ: callsigns, addresses, ids of radio lines, cameras, stations."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from airhilt.scenario.models import Scenario, WildlifeSpec
from airhilt.scenario.problems import Problem


def shared_names(scenario: Scenario) -> Iterator[Problem]:
    """Yield names that two actors, radio lines, cameras, stations or radars share."""
    callsigns = [actor.callsign for actor in scenario.actors]
    line_ids = [line.id for line in scenario.radio.lines]
    cameras = [camera.name for camera in scenario.cameras]
    yield from duplicates("actors", "callsign", callsigns)
    yield from duplicates("actors", "icao24", _addresses(scenario))
    yield from duplicates("radio/lines", "id", line_ids, str.lower)
    yield from duplicates("cameras", "name", cameras, str.lower)
    receivers = [receiver.name for receiver in scenario.adsb.receivers]
    yield from duplicates("adsb/receivers", "name", receivers)
    if scenario.radio.controller in callsigns:
        yield Problem(
            "radio/controller",
            f"found {scenario.radio.controller!r}, which is an actor; expected a unit's name",
        )
    yield from duplicates("radars", "name", [radar.name for radar in scenario.radars])


def duplicates(
    path: str, field: str, values: Sequence[str], form: Callable[[str], str] = str
) -> Iterator[Problem]:
    """Yield values whose ``form`` is the form of an earlier value."""
    forms = [form(value) for value in values]
    for index, value in enumerate(values):
        first = forms.index(forms[index])
        if first < index:
            written = "" if values[first] == value else f", as {values[first]!r}"
            yield Problem(
                f"{path}/{index}/{field}",
                f"found {value!r}, which {path}/{first} has already{written}; expected a "
                "different one for each",
            )


def _addresses(scenario: Scenario) -> list[str]:
    """Return the 24-bit address of each actor; where it has none, a text that is no address."""
    return [
        f"{actor.callsign} has none" if isinstance(actor, WildlifeSpec) else actor.icao24
        for actor in scenario.actors
    ]
