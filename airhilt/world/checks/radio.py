"""Checks of radio lines, of radios, and of the failures that change them."""

from __future__ import annotations

import re
from collections.abc import Iterator

from airhilt.errors import AirhiltError
from airhilt.host import library
from airhilt.messages import ASSISTANT
from airhilt.scenario.conversation import controlling_units, unsayable_lines
from airhilt.scenario.models import (
    AircraftSpec,
    CallsignConfused,
    Dropped,
    EngineFailure,
    Scenario,
    StuckMicrophone,
    WildlifeSpec,
)
from airhilt.scenario.problems import Problem, unknown
from airhilt.world.flight.aircraft_type import load_aircraft_type

GENERATED_ID = re.compile(
    r"^(?:stuck-microphone|microphone|seat|controller|ra|arrival|tells|advisory)\.|"
    r"\.(?:readback|correction|request|contact|end|report-[a-z0-9-]+|(?:repeat|say-again|confirmation)-[0-9]+)$",
    re.IGNORECASE,
)
"""Beginnings and endings of the ids of calls that are not in the script (docs/transmissions.md)."""
CHANNELS_KHZ = tuple(name for name in range(118_000, 136_991, 5) if name % 25 < 20)
"""Names of the channels of the aeronautical VHF band, in kHz: in each 25 kHz one of that spacing,
and three of 8.33 kHz, named 5, 10 and 15 above it (ICAO Annex 10 volume V, table 4-1 bis)."""

GUARD_KHZ = 121_500
"""Emergency channel, for emergencies alone (ICAO Annex 10 volume V, 4.1.3.1.1)."""


def units_on_guard(scenario: Scenario) -> Iterator[Problem]:
    """Yield units that work on the emergency channel, which is valid and hardly meant."""
    for unit, frequencies_khz in controlling_units(scenario).items():
        if GUARD_KHZ in frequencies_khz:
            yield Problem(
                "radio",
                f"{unit!r} works on {GUARD_KHZ} kHz, which is for emergencies alone; expected a "
                "frequency of its own",
            )


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
                "expected an id that neither begins with stuck-microphone., microphone., seat., "
                "controller., ra., arrival., tells. or advisory., nor ends with .readback, "
                ".correction, .request, .contact, .end, .repeat-1, .say-again-1 or "
                ".confirmation-1",
            )
        if line.frequency_khz not in CHANNELS_KHZ:
            yield Problem(f"{path}/frequency_khz", _no_channel(line.frequency_khz))
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
    yield from _strangers(scenario)


def _no_channel(frequency_khz: int) -> str:
    """Return what is wrong with a number that is the name of no channel."""
    nearest = min(CHANNELS_KHZ, key=lambda name: abs(name - frequency_khz))
    return (
        f"{frequency_khz} kHz is no channel; expected {CHANNELS_KHZ[0]} to {CHANNELS_KHZ[-1]} in "
        "25 kHz steps, or 5, 10 or 15 above one of them (8.33 kHz spacing), such as "
        f"{nearest}"
    )


def _strangers(scenario: Scenario) -> Iterator[Problem]:
    """Yield speakers, addressees and radios that are neither of an actor nor of a unit."""
    radio = scenario.radio
    people = [actor.callsign for actor in scenario.actors if not isinstance(actor, WildlifeSpec)]
    known = [*people, radio.controller, *radio.stations, ASSISTANT]
    named = [name for line in radio.lines for name in (line.speaker, line.to) if name]
    for index, line in enumerate(radio.lines):
        for field, name in (("speaker", line.speaker), ("to", line.to)):
            if name is not None and name not in known:
                hint = "; a unit besides the controller is declared in radio/stations: "
                path = f"radio/lines/{index}/{field}"
                yield unknown(path, "actor or unit", name, known, f'{hint}{{"{name}": {{}}}}')
    actors, units = [actor.callsign for actor in scenario.actors], [*named, radio.controller]
    for path, names, known in (
        ("radio/stations", radio.stations, [*actors, *units, ASSISTANT]),
        ("radio/receivers", radio.receivers, [*people, *units]),
    ):
        for name in names:
            if name not in known:
                yield unknown(f"{path}/{name}", "actor or unit", name, list(dict.fromkeys(known)))


def impossible_controllers(scenario: Scenario) -> Iterator[Problem]:
    """Yield controllers of actors, of units that nobody hears, and two on one frequency."""
    actors = [actor.callsign for actor in scenario.actors]
    units = controlling_units(scenario)
    heard = [unit for unit, frequencies_khz in units.items() if frequencies_khz]
    for unit, controller in scenario.controllers.items():
        path = f"controllers/{unit}"
        if unit in actors:
            yield Problem(path, "it is an actor; expected the name of a unit")
        elif unit not in heard and unit != scenario.radio.controller:
            hint = "; the frequency of a unit without radio lines is given in frequencies_khz"
            yield unknown(path, "unit", unit, heard, hint)
        for index, frequency_khz in enumerate(controller.frequencies_khz):
            if frequency_khz not in CHANNELS_KHZ:
                where = f"{path}/frequencies_khz/{index}"
                yield Problem(where, _no_channel(frequency_khz))
    owners: dict[int, str] = {}
    for unit, frequencies_khz in units.items():
        for frequency_khz in frequencies_khz:
            owner = owners.setdefault(frequency_khz, unit)
            if owner != unit:
                yield Problem(
                    f"controllers/{unit}",
                    f"it is on {frequency_khz} kHz, and so is {owner!r}; expected one controller "
                    "on each frequency",
                )


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


def idle_failures(scenario: Scenario) -> Iterator[Problem]:
    """Yield failures of lines that do not exist, and failures that would change nothing."""
    lines = {line.id: line for line in scenario.radio.lines}
    for index, failure in enumerate(scenario.failures):
        path = f"failures/{index}"
        if isinstance(failure, EngineFailure | StuckMicrophone):
            yield from _equipment(path, failure, scenario)
            continue
        if failure.line not in lines:
            yield unknown(f"{path}/line", "radio line", failure.line, lines)
            continue
        told = [scripted.actor for scripted in lines[failure.line].commands]
        field = next((name for name in ("actor", "meant") if hasattr(failure, name)), None)
        if field is not None and getattr(failure, field) not in told:
            yield Problem(
                f"{path}/{field}",
                f"found {getattr(failure, field)!r}, whom line {failure.line!r} tells nothing; "
                f"expected {' or '.join(told) or 'a line with commands'}",
            )
        if isinstance(failure, CallsignConfused) and failure.taken_by == failure.meant:
            yield Problem(f"{path}/taken_by", f"found {failure.meant!r} twice; expected two actors")
        if isinstance(failure, Dropped) and any(
            getattr(other, "line", None) == failure.line
            for number, other in enumerate(scenario.failures)
            if number != index
        ):
            yield Problem(f"{path}/line", f"line {failure.line!r} is dropped and fails otherwise")


def _equipment(
    path: str, failure: EngineFailure | StuckMicrophone, scenario: Scenario
) -> Iterator[Problem]:
    """Yield a microphone that nobody hears, and an engine that is not there."""
    actor = next((one for one in scenario.actors if one.callsign == failure.actor), None)
    if actor is None:
        return  # Named elsewhere.
    if isinstance(failure, StuckMicrophone):
        if not any(failure.actor in (line.speaker, line.to) for line in scenario.radio.lines):
            yield Problem(
                f"{path}/actor",
                f"{failure.actor!r} is on no frequency; expected an actor with a line of its own, "
                "or to it",
            )
        return
    if not isinstance(actor, AircraftSpec):
        yield Problem(f"{path}/actor", f"found a {actor.type}; expected an aircraft")
        return
    try:
        engines = len(load_aircraft_type(actor.aircraft, scenario.files).mesh.engines_m)
    except AirhiltError:
        return  # Named elsewhere.
    if failure.engine >= engines:
        expected = f"expected 0 to {engines - 1}, the engines of a {actor.aircraft}"
        yield Problem(f"{path}/engine", f"found {failure.engine}; {expected}")
