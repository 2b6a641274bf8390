"""Loads scenario files; every error names the file, the JSON path, what was found and expected."""

from __future__ import annotations

import json
import re
import types
import typing
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel, ValidationError

from airhilt import library
from airhilt.commands import (
    AircraftCommand,
    Command,
    ContinueCommand,
    HoldPositionCommand,
    LandCommand,
    TaxiCommand,
    VehicleCommand,
)
from airhilt.errors import AirhiltError, ScenarioError, first_problem
from airhilt.geodesy.local_frame import onward
from airhilt.geodesy.positions import HoldShortPosition, NodePosition, Position, RunwayPosition
from airhilt.scenario.models import (
    Airborne,
    AircraftSpec,
    AircraftStart,
    CallsignConfused,
    Condition,
    Dropped,
    EngineFailure,
    HoldingShort,
    LinedUp,
    LineEnded,
    ReadbackWrong,
    Scenario,
    Standing,
    StuckMicrophone,
    VehicleSpec,
    WildlifeSpec,
)
from airhilt.scenario.perturbation import Draw, PathError, locate, realise
from airhilt.scenario.vhf_channels import channel_spacing_khz
from airhilt.units import FOOT
from airhilt.world.flight import AircraftType, load_aircraft_type
from airhilt.world.site import ScenarioSite, distance_m
from airhilt.world.surface.kinds import load_kind
from airhilt.world.surface.runway import Place

if TYPE_CHECKING:
    from airhilt.world.surface.layout import Layout

GREATEST_LATITUDE_DEG = 75.0
MAXIMUM_BYTES = 20_000_000
GREATEST_SURFACE_WIND_KT = 40.0
"""Beyond it airports stop: more than the demonstrated crosswind of any type here."""
GREATEST_SURFACE_DISTANCE_M = 10_000.0
"""From the airport's reference point, for what stands on the ground."""
GENERATED_ID = re.compile(
    r"^stuck-microphone\.|\.(?:readback|correction|(?:repeat|say-again)-[0-9]+)$", re.IGNORECASE
)
"""What begins or ends the ids of calls that are not in the script (docs/radio.md)."""


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong in a document."""

    path: str
    text: str

    def __str__(self) -> str:
        return f"{self.path or '(top)'}: {self.text}"


def load(name_or_file: str | Path) -> Scenario:
    """Return a scenario that ships with AIRHILT, by name, or one from a file.

    Raises
    ------
    ScenarioError
        There is none of that name, or it is not valid.
    """
    path = _resolve(name_or_file)
    try:
        if path.stat().st_size > MAXIMUM_BYTES:
            raise ScenarioError(f"{path}: over {MAXIMUM_BYTES // 1_000_000} MB, no scenario is")
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise ScenarioError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise ScenarioError(f"{path}: not UTF-8 text (byte {error.start})") from None
    return parse(text, str(path))


def _resolve(name_or_file: str | Path) -> Path:
    path = Path(name_or_file)
    if path.suffix == ".json" or len(path.parts) > 1 or path.is_file():
        if not path.is_file():
            raise ScenarioError(
                f"{path}: no such file; give the path of a scenario file, or one of these names: "
                f"{', '.join(library.names('scenarios'))}"
            )
        return path
    return library.find("scenarios", str(name_or_file))


def parse(text: str, origin: str) -> Scenario:
    """Return the scenario that a JSON text holds; ``origin`` names it in errors.

    Raises
    ------
    ScenarioError
        It is not JSON, or not a valid scenario.
    """
    try:
        document = json.loads(text)
    except json.JSONDecodeError as error:
        raise ScenarioError(
            f"{origin}:{error.lineno}:{error.colno}: not valid JSON: {error.msg}"
        ) from None
    except ValueError:
        raise ScenarioError(
            f"{origin}: an integer of thousands of digits, no scenario has"
        ) from None
    except RecursionError:
        raise ScenarioError(f"{origin}: nested too deeply") from None
    try:
        scenario = Scenario.model_validate(document)
    except ValidationError as error:
        problems = [describe(problem, Scenario) for problem in _causes(error)]
        raise _report(origin, problems) from None
    check(scenario, origin)
    return scenario


def check(scenario: Scenario, origin: str) -> None:
    """Check what no field can know of another; ``origin`` names the scenario in errors.

    Raises
    ------
    ScenarioError
        Something refers to nothing, or is outside what an aircraft flies.
    """
    problems = list(_cross_checks(scenario))
    if problems:
        raise _report(origin, problems)


def draw(scenario: Scenario, seed: int) -> tuple[Scenario, list[Draw]]:
    """Return a scenario with its perturbations drawn and checked, and the draws.

    Raises
    ------
    ScenarioError
        A draw takes a value out of its range, or makes a scenario that is not valid.
    AirhiltError
        The seed is none.
    """
    if not 0 <= seed < 2**63:
        raise AirhiltError(f"seed {seed}: expected 0 or more, below 2^63")
    try:
        realised, draws = realise(scenario, seed)
    except ValidationError as error:
        raise ScenarioError(
            f"{scenario.name}: with seed {seed} a perturbation goes too far: "
            f"{first_problem(error)}; narrow its distribution"
        ) from None
    check(realised, f"{scenario.name}, as drawn with seed {seed}")
    return realised, draws


def _causes(error: ValidationError) -> list[Any]:
    """Return the errors without those that only follow from others: a list with bad entries."""
    errors = error.errors()
    return [
        one
        for one in errors
        if one["type"] != "too_short"
        or not any(
            len(other["loc"]) > len(one["loc"]) and other["loc"][: len(one["loc"])] == one["loc"]
            for other in errors
        )
    ]


def _report(origin: str, problems: Sequence[Problem]) -> ScenarioError:
    """Return the error for some problems: one line, and all of them for who wants them."""
    lines = tuple(f"{origin}: {problem}" for problem in problems)
    more = f" (and {len(lines) - 1} more: see airhilt validate)" if len(lines) > 1 else ""
    return ScenarioError(lines[0] + more, lines)


# --- errors of the model, in words ---------------------------------------------------------


def describe(error: Any, model: type[BaseModel]) -> Problem:
    """Return one pydantic error as a path, what was found, and what was expected."""
    path, parent = _walk(model, error["loc"])
    found = _short(error["input"])
    context = error.get("ctx", {})
    match error["type"]:
        case "extra_forbidden":
            known = sorted(parent.model_fields) if parent else []
            tail = library.nearest(str(error["loc"][-1]), known)
            return Problem(path, f"unknown field{tail}")
        case "missing":
            return Problem(path, "missing; it is required")
        case "union_tag_not_found":
            return Problem(path, f"field {context['discriminator']} is missing in {found}")
        case "union_tag_invalid":
            known = [tag.strip(" '") for tag in str(context["expected_tags"]).split(",")]
            tail = library.nearest(str(context["tag"]), known)
            field = str(context["discriminator"]).strip("'")
            return Problem(
                f"{path}/{field}", f"found {context['tag']!r}, expected {', '.join(known)}{tail}"
            )
        case "literal_error":
            return Problem(path, f"found {found}, expected {context['expected']}")
        case _:
            message = str(error["msg"])
            return Problem(path, f"found {found}: {message[0].lower()}{message[1:]}")


def _short(value: Any) -> str:
    text = json.dumps(value, default=str)
    return text if len(text) <= 60 else text[:57] + "..."


def _walk(model: type[BaseModel], loc: Sequence[str | int]) -> tuple[str, type[BaseModel] | None]:
    """Return a pydantic location as a JSON path (without union tags) and its last model."""
    annotation: Any = model
    parent: type[BaseModel] | None = None
    chunks: list[str] = []
    for part in loc:
        members = _members(annotation)
        tagged = [member for member in members if _tag(member) == part]
        if len(members) > 1 and tagged:
            annotation = tagged[0]
            continue
        chunks.append(str(part))
        if isinstance(part, int):
            arguments = typing.get_args(annotation)
            annotation = arguments[0] if arguments else None
            continue
        parent = next((member for member in members if _is_model(member)), None)
        field = parent.model_fields.get(part) if parent else None
        annotation = field.annotation if field else None
    return "/".join(chunks), parent


def _members(annotation: Any) -> list[Any]:
    """Return the members of a union, or the annotation alone, stripped of None."""
    while typing.get_origin(annotation) is typing.Annotated:
        annotation = typing.get_args(annotation)[0]
    if typing.get_origin(annotation) in (typing.Union, types.UnionType):
        inner = [a for a in typing.get_args(annotation) if a is not type(None)]
        return [member for a in inner for member in _members(a)]
    return [annotation]


def _is_model(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)


def _tag(annotation: Any) -> str | None:
    """Return the literal by which a member of a discriminated union is known."""
    if _is_model(annotation):
        for field in ("type", "action"):
            if field in annotation.model_fields:
                literals = typing.get_args(annotation.model_fields[field].annotation)
                return str(literals[0]) if literals else None
    return None


# --- what one field cannot know of another --------------------------------------------------


def _cross_checks(scenario: Scenario) -> Iterator[Problem]:
    """Yield what is wrong; while two things share a name, only that is."""
    callsigns = [actor.callsign for actor in scenario.actors]
    line_ids = [line.id for line in scenario.radio.lines]
    shared = [
        *_duplicates("actors", "callsign", callsigns),
        *_duplicates("actors", "icao24", _addresses(scenario)),
        *_duplicates("radio/lines", "id", line_ids, str.lower),
        *_duplicates("cameras", "name", [camera.name for camera in scenario.cameras], str.lower),
    ]
    if shared:
        yield from shared
        return
    try:
        site = ScenarioSite.of(scenario)
    except AirhiltError as error:
        yield Problem("scene/airport", str(error))
        return
    yield from _actors(scenario, site)
    yield from _places(scenario, site)
    yield from _references(scenario, callsigns, line_ids)
    yield from _radio(scenario, line_ids)
    yield from _misfits(scenario)
    if site.layout is not None:
        yield from _wind(scenario)
        yield from _ways(scenario, site, site.layout)
    yield from _failures(scenario, line_ids)
    yield from _perturbations(scenario)


def _duplicates(
    path: str, field: str, values: Sequence[str], form: Callable[[str], str] = str
) -> Iterator[Problem]:
    """Yield values whose ``form`` is that of one before."""
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
    """Return the 24-bit address of each actor; a name that none can have where it has none."""
    return [
        f"{actor.callsign} has none" if isinstance(actor, WildlifeSpec) else actor.icao24
        for actor in scenario.actors
    ]


def _actors(scenario: Scenario, site: ScenarioSite) -> Iterator[Problem]:
    if abs(site.centre.lat_deg) > GREATEST_LATITUDE_DEG:
        yield Problem(
            "scene/centre/lat_deg",
            f"found {site.centre.lat_deg:g}; expected within +-"
            f"{GREATEST_LATITUDE_DEG:g}, where relative motion is exact enough",
        )
    for index, actor in enumerate(scenario.actors):
        path = f"actors/{index}"
        if isinstance(actor, AircraftSpec):
            yield from _aircraft(path, actor, site)
        else:
            yield from _kind(path, actor)


def _kind(path: str, actor: VehicleSpec | WildlifeSpec) -> Iterator[Problem]:
    try:
        load_kind(actor.kind, actor.type)
    except AirhiltError as error:
        yield Problem(f"{path}/kind", str(error))


def _aircraft(path: str, actor: AircraftSpec, site: ScenarioSite) -> Iterator[Problem]:
    try:
        kind = load_aircraft_type(actor.aircraft)
    except AirhiltError as error:
        yield Problem(f"{path}/aircraft", str(error))
        return
    initial, ground_ft = actor.initial, site.ground_m / FOOT
    if not isinstance(initial, Airborne):
        return
    if initial.altitude_ft <= ground_ft:
        where = "the airport" if site.layout else "scene/terrain_elevation_ft"
        yield Problem(
            f"{path}/initial/altitude_ft",
            f"found {initial.altitude_ft:g}, which is not above the ground; expected more "
            f"than {where}, {ground_ft:g}",
        )
    if initial.track_deg is None and not actor.route:
        yield Problem(
            f"{path}/initial/track_deg", "missing; it is required where there is no route"
        )
    yield from _envelope(f"{path}/initial", initial.altitude_ft, initial.cas_kt, kind)


def _wind(scenario: Scenario) -> Iterator[Problem]:
    speed_kt = scenario.weather.wind.speed_kt
    if speed_kt > GREATEST_SURFACE_WIND_KT:
        yield Problem(
            "weather/wind/speed_kt",
            f"found {speed_kt:g}; expected at most {GREATEST_SURFACE_WIND_KT:g} where aircraft "
            "take off, land or taxi",
        )


def _places(scenario: Scenario, site: ScenarioSite) -> Iterator[Problem]:
    """Yield what refers to a runway, a hold-short position or a node that does not exist."""
    for path, model in _models_of(scenario, ""):
        position: Position | None = None
        match model:
            case HoldShortPosition() | NodePosition() | RunwayPosition():
                position = model
            case HoldingShort(runway=runway, taxiway=taxiway):
                position = HoldShortPosition(type="hold_short", runway=runway, taxiway=taxiway)
            case _:
                ident = getattr(model, "runway", None)
                if ident is None:
                    continue
                position = RunwayPosition(type="runway", runway=ident, along_m=0.0)
        try:
            site.place(position)
        except AirhiltError as error:
            yield Problem(path, str(error))
    for index, actor in enumerate(scenario.actors):
        if not isinstance(actor.initial, Standing):
            continue
        try:
            away_m = distance_m(site.place(actor.initial.position), site.place(site.centre))
        except AirhiltError:
            continue  # Named above.
        if site.layout is None or away_m > GREATEST_SURFACE_DISTANCE_M:
            yield Problem(
                f"actors/{index}/initial/position",
                f"found a place {away_m / 1000.0:.1f} km from the centre of "
                f"{'an airport' if site.layout else 'airspace without an airport'}; expected "
                f"an airport, and at most {GREATEST_SURFACE_DISTANCE_M / 1000.0:g} km",
            )


def _models_of(value: Any, path: str) -> Iterator[tuple[str, BaseModel]]:
    """Yield all models inside a value, with their paths."""
    if isinstance(value, BaseModel):
        yield path, value
        for name in type(value).model_fields:
            yield from _models_of(getattr(value, name), f"{path}/{name}".strip("/"))
    elif isinstance(value, tuple):
        for index, entry in enumerate(value):
            yield from _models_of(entry, f"{path}/{index}")


def _told(scenario: Scenario) -> Iterator[tuple[str, str, Command]]:
    """Yield what each actor is told, with its path, in the order of the file."""
    for index, actor in enumerate(scenario.actors):
        if not isinstance(actor, WildlifeSpec):
            for number, command in enumerate(actor.commands):
                yield f"actors/{index}/commands/{number}", actor.callsign, command
    for index, line in enumerate(scenario.radio.lines):
        for number, scripted in enumerate(line.commands):
            path = f"radio/lines/{index}/commands/{number}/command"
            yield path, scripted.actor, scripted.command
    for index, failure in enumerate(scenario.failures):
        if isinstance(failure, ReadbackWrong):
            for number, scripted in enumerate(failure.commands):
                path = f"failures/{index}/commands/{number}/command"
                yield path, scripted.actor, scripted.command


def _misfits(scenario: Scenario) -> Iterator[Problem]:
    """Yield commands that are nothing for who gets them."""
    fitting = {
        "aircraft": typing.get_args(AircraftCommand),
        "vehicle": typing.get_args(VehicleCommand),
        "wildlife": (),
    }
    kinds = {actor.callsign: actor.type for actor in scenario.actors}
    for path, callsign, command in _told(scenario):
        kind = kinds.get(callsign)
        if kind is not None and not isinstance(command, fitting[kind]):
            known = ", ".join(
                str(typing.get_args(model.model_fields["action"].annotation)[0])
                for model in fitting[kind]
            )
            yield Problem(
                f"{path}/action",
                f"found {command.action!r}, which no {kind} does; expected "
                f"{known or 'nothing: nobody tells an animal what to do'}",
            )


def _ways(scenario: Scenario, site: ScenarioSite, layout: Layout) -> Iterator[Problem]:
    """Yield taxi commands without a way, and aircraft that stand off the taxiways.

    After a takeoff or a landing nobody knows where a way begins; then it is one from a stand.
    """
    somewhere = layout.node(layout.stands[0]) if layout.stands else None
    begins: dict[str, Place | None] = {}
    for index, actor in enumerate(scenario.actors):
        begins[actor.callsign] = here = _stands_at(actor.initial, site)
        if here is None or somewhere is None or not isinstance(actor, AircraftSpec):
            continue
        try:
            layout.taxi_route(here, somewhere)
        except AirhiltError as error:
            yield Problem(f"actors/{index}/initial", str(error))
    for path, callsign, command in _told(scenario):
        if isinstance(command, TaxiCommand):
            end = _place(site, command.to)
            if end is None:
                continue  # Named elsewhere.
            try:
                if not command.off_taxiways:
                    layout.taxi_route(begins.get(callsign) or somewhere or end, end, command.via)
            except AirhiltError as error:
                yield Problem(path, str(error))
            begins[callsign] = end
        elif not isinstance(command, HoldPositionCommand | ContinueCommand):
            begins[callsign] = None
        if isinstance(command, LandCommand) and command.exit is not None:
            yield from _exit(path, command.runway, command.exit, layout)


def _exit(path: str, runway: str, name: str, layout: Layout) -> Iterator[Problem]:
    try:
        exits = layout.exits(runway)
    except AirhiltError:
        return  # Named elsewhere.
    if not any(name in (way.taxiway, way.position) for way in exits):
        known = ", ".join(dict.fromkeys(way.position for way in exits)) or "none"
        yield Problem(f"{path}/exit", f"runway {runway} has no exit {name!r}; there are: {known}")


def _stands_at(initial: AircraftStart, site: ScenarioSite) -> Place | None:
    """Return where an actor begins on the ground, None if it does not or nobody knows."""
    match initial:
        case Standing(position=position):
            return _place(site, position)
        case HoldingShort(runway=runway, taxiway=taxiway, before_m=before_m):
            try:
                hold = site.airport.hold(runway, taxiway)
            except AirhiltError:
                return None
            return onward(hold.place, hold.heading_rad, -before_m)
        case LinedUp(runway=runway):
            return _place(site, RunwayPosition(type="runway", runway=runway, along_m=0.0))
    return None


def _place(site: ScenarioSite, position: Position) -> Place | None:
    """Return where a position is, None if it refers to nothing."""
    try:
        return site.place(position)
    except AirhiltError:
        return None


def _radio(scenario: Scenario, line_ids: list[str]) -> Iterator[Problem]:
    """Yield lines with ids or frequencies that they cannot have, or answers to none before them."""
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


def _failures(scenario: Scenario, line_ids: list[str]) -> Iterator[Problem]:
    """Yield failures of lines that do not exist, or of which nothing would be different."""
    lines = {line.id: line for line in scenario.radio.lines}
    for index, failure in enumerate(scenario.failures):
        path = f"failures/{index}"
        if isinstance(failure, EngineFailure):
            yield from _engine(path, failure, scenario)
            continue
        if isinstance(failure, StuckMicrophone):
            yield from _microphone(path, failure, scenario)
            continue
        if failure.line not in lines:
            yield Problem(
                f"{path}/line",
                f"no radio line {failure.line!r}{library.nearest(failure.line, line_ids)}",
            )
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


def _microphone(path: str, failure: StuckMicrophone, scenario: Scenario) -> Iterator[Problem]:
    talks = any(failure.actor in (line.speaker, line.to) for line in scenario.radio.lines)
    if not talks and any(actor.callsign == failure.actor for actor in scenario.actors):
        yield Problem(
            f"{path}/actor",
            f"{failure.actor!r} is on no frequency; expected an actor with a line of its own, or "
            "to it",
        )


def _engine(path: str, failure: EngineFailure, scenario: Scenario) -> Iterator[Problem]:
    actor = next((one for one in scenario.actors if one.callsign == failure.actor), None)
    if actor is None:
        return  # Named elsewhere.
    if not isinstance(actor, AircraftSpec):
        yield Problem(f"{path}/actor", f"found a {actor.type}; expected an aircraft")
        return
    try:
        engines = len(load_aircraft_type(actor.aircraft).mesh.engines_m)
    except AirhiltError:
        return  # Named elsewhere.
    if failure.engine >= engines:
        yield Problem(
            f"{path}/engine",
            f"found {failure.engine}; expected 0 to {engines - 1}, the engines of a "
            f"{actor.aircraft}",
        )


def _envelope(
    path: str, altitude_ft: float, cas_kt: float, kind: AircraftType
) -> Iterator[Problem]:
    speeds = kind.speeds
    if altitude_ft > speeds.service_ceiling_ft:
        yield Problem(
            f"{path}/altitude_ft",
            f"found {altitude_ft:g}; expected at most the service ceiling of a {kind.name}, "
            f"{speeds.service_ceiling_ft:g}",
        )
    if not speeds.minimum_clean_kt <= cas_kt <= speeds.maximum_kt:
        yield Problem(
            f"{path}/cas_kt",
            f"found {cas_kt:g}; expected {speeds.minimum_clean_kt:g} to {speeds.maximum_kt:g}, "
            f"what a {kind.name} flies",
        )


def _references(scenario: Scenario, callsigns: list[str], line_ids: list[str]) -> Iterator[Problem]:
    for path, callsign in _mentioned_actors(scenario):
        if callsign not in callsigns:
            yield Problem(path, f"no actor {callsign!r}{library.nearest(callsign, callsigns)}")
    for path, condition in _conditions(scenario):
        if isinstance(condition, LineEnded) and condition.line not in line_ids:
            yield Problem(
                f"{path}/line",
                f"no radio line {condition.line!r}{library.nearest(condition.line, line_ids)}",
            )
        pair = getattr(condition, "actors", None)
        if pair is not None and pair[0] == pair[1]:
            yield Problem(f"{path}/actors", f"found {pair[0]!r} twice; expected two actors")
    if scenario.conflict is not None and len(set(scenario.conflict.actors)) < 2:
        yield Problem("conflict/actors", "found one actor twice; expected two actors")


def _mentioned_actors(scenario: Scenario) -> Iterator[tuple[str, str]]:
    """Yield every callsign that refers to an actor."""
    for path, model in _models_of(scenario, ""):
        if isinstance(model, AircraftSpec | VehicleSpec | WildlifeSpec):
            continue
        for field in ("actor", "meant", "taken_by"):
            callsign = getattr(model, field, None)
            if callsign is not None:
                yield f"{path}/{field}", callsign
        if model is not scenario:
            for number, callsign in enumerate(getattr(model, "actors", ())):
                yield f"{path}/actors/{number}", callsign


def _conditions(scenario: Scenario) -> Iterator[tuple[str, Condition]]:
    for path, model in _models_of(scenario, ""):
        if isinstance(model, typing.get_args(typing.get_args(Condition)[0])):
            yield path, typing.cast(Condition, model)


def _perturbations(scenario: Scenario) -> Iterator[Problem]:
    document = scenario.model_dump(mode="json")
    for index, perturbation in enumerate(scenario.perturbations):
        path = f"perturbations/{index}/path"
        try:
            container, key = locate(document, perturbation.path)
        except PathError as error:
            tail = library.nearest(error.chunk, error.known)
            yield Problem(
                path, f"{perturbation.path!r} leads nowhere: no {error.chunk!r} there{tail}"
            )
            continue
        value = container[key]
        if not isinstance(value, float):
            yield Problem(
                path,
                f"{perturbation.path!r} is {_short(value)}; expected the path of a number that may "
                "have a fraction",
            )
    yield from _duplicates(
        "perturbations", "path", [perturbation.path for perturbation in scenario.perturbations]
    )
