"""Checks of names: those that must differ, and those that must lead to something."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from airhilt.host import library
from airhilt.scenario.models import (
    AircraftSpec,
    LineBegun,
    LineEnded,
    Scenario,
    VehicleSpec,
    WildlifeSpec,
)
from airhilt.scenario.perturbation import PathError, locate, numbers
from airhilt.scenario.problems import Problem, short_json, unknown
from airhilt.scenario.spreads import usual_spread
from airhilt.world.checks.walk import models_of


def shared_names(scenario: Scenario) -> Iterator[Problem]:
    """Yield names that two actors, radio lines, cameras, stations or radars share."""
    callsigns = [actor.callsign for actor in scenario.actors]
    addresses = [
        f"{actor.callsign} has none" if isinstance(actor, WildlifeSpec) else actor.icao24
        for actor in scenario.actors
    ]
    yield from _duplicates("actors", "callsign", callsigns)
    yield from _duplicates("actors", "icao24", addresses)
    yield from _duplicates("radio/lines", "id", [one.id for one in scenario.radio.lines], str.lower)
    yield from _duplicates("cameras", "name", [one.name for one in scenario.cameras], str.lower)
    yield from _duplicates("adsb/receivers", "name", [one.name for one in scenario.adsb.receivers])
    if scenario.radio.controller in callsigns:
        yield Problem(
            "radio/controller",
            f"found {scenario.radio.controller!r}, which is an actor; expected a unit's name",
        )
    yield from _duplicates("radars", "name", [radar.name for radar in scenario.radars])


def _duplicates(
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


def dangling_references(scenario: Scenario) -> Iterator[Problem]:
    """Yield references to actors and lines that do not exist, and pairs of one actor."""
    callsigns = [actor.callsign for actor in scenario.actors]
    line_ids = [line.id for line in scenario.radio.lines]
    for path, model in models_of(scenario):
        if isinstance(model, Scenario | AircraftSpec | VehicleSpec | WildlifeSpec):
            continue
        named = {field: getattr(model, field, None) for field in ("actor", "meant", "taken_by")}
        pair: tuple[str, ...] = getattr(model, "actors", ())
        named |= {f"actors/{number}": callsign for number, callsign in enumerate(pair)}
        for field, callsign in named.items():
            if callsign is not None and callsign not in callsigns:
                yield unknown(f"{path}/{field}", "actor", callsign, callsigns)
        if len(set(pair)) < len(pair):
            yield Problem(f"{path}/actors", f"found {pair[0]!r} twice; expected two actors")
        if isinstance(model, LineBegun | LineEnded) and model.line not in line_ids:
            yield unknown(f"{path}/line", "radio line", model.line, line_ids)
    aircraft = {one.callsign: one for one in scenario.actors if isinstance(one, AircraftSpec)}
    for field, listed in (("cockpits", scenario.cockpits), ("tcas", scenario.tcas)):
        for index, callsign in enumerate(listed):
            path = f"{field}/{index}"
            if callsign not in aircraft:
                yield unknown(path, "aircraft", callsign, aircraft)
            elif field == "tcas" and not aircraft[callsign].transponder.has_adsb:
                found = f"{callsign!r} has no Mode S transponder"
                yield Problem(path, f"{found}; expected one: TCAS II coordinates by it")


def misplaced_perturbations(scenario: Scenario) -> Iterator[Problem]:
    """Yield perturbations that lead to no number, have no distribution, or share a path."""
    document = scenario.model_dump(mode="json")
    for index, perturbation in enumerate(scenario.perturbations):
        path = f"perturbations/{index}/path"
        try:
            reached = numbers(document, perturbation.path)
            values = [locate(document, each) for each in reached]
        except PathError as error:
            tail = library.nearest(error.chunk, error.known)
            yield Problem(
                path, f"{perturbation.path!r} leads nowhere: no {error.chunk!r} there{tail}"
            )
            continue
        for each, (container, key) in zip(reached, values, strict=True):
            value = container[key]
            if not isinstance(value, float):
                yield Problem(
                    path,
                    f"{each!r} is {short_json(value)}; expected the path of a number that "
                    "may have a fraction",
                )
            elif perturbation.distribution is None and usual_spread(each) is None:
                yield Problem(
                    path,
                    f"{each!r} is of no kind that has a usual spread; expected a distribution",
                )
    paths = [perturbation.path for perturbation in scenario.perturbations]
    yield from _duplicates("perturbations", "path", paths)
