"""The report of a run: one HTML file that needs nothing else to be looked at.

`write_report` reduces a run folder to one JSON object and puts it into ``report.html``, which
lies beside this module and draws it. What comes from a scenario or a worker may be hostile: here
it is only ever data, and the page shows it as text.
"""

from __future__ import annotations

import itertools
import json
import math
from collections import Counter
from collections.abc import Callable, Iterable
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from pydantic import ValidationError

from airhilt.errors import AirhiltError, RunFolderError, first_problem
from airhilt.geodesy.relative_motion import relative
from airhilt.geodesy.wgs84 import offset_m
from airhilt.messages import (
    AdvisoryAudio,
    HearingTruth,
    Message,
    SpokenTruth,
    Status,
    Transcript,
    Transmission,
)
from airhilt.metrics.calls import CallRecord, CallRecords
from airhilt.metrics.summary import ClosestApproach, Summary
from airhilt.metrics.words import align
from airhilt.record import Logged, RunFolder, RunInfo, read_log
from airhilt.report.camera_section import CameraSection
from airhilt.report.sounds import Sounds
from airhilt.report.timelines import Approach, Interval, Intervals, PhaseLane, RunwayLane
from airhilt.shapes.sizes import Size
from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE, SECOND_NS
from airhilt.voices.engine import SAMPLE_RATE_HZ
from airhilt.world.flight import load_aircraft_type
from airhilt.world.surface.kinds import load_kind

if TYPE_CHECKING:
    from airhilt.report.ground_plan import GroundPlan

Json = dict[str, Any]

MOST_POINTS = 600
"""Of one track. A chart is hardly wider in pixels."""
MOST_POINTS_AT_AIRPORT = 1200
"""Of one track there: turns are tight, and the last metres count."""
MOST_POINTS_OF_ALL = 15_000
"""Of all tracks together; they share it, so that the file stays below a megabyte."""
FEWEST_POINTS = 40
MOST_EVENTS = 1500
MOST_CALLS = 500
"""In the table of the radio, and as many spoken advisories."""
MOST_CHARACTERS = 400
"""Of one text; a worker may write as much as it likes."""
BINS_PER_DECADE = 8
LEAST_LATENCY_S = 1e-5
"""Shorter latencies are counted in the first bin of the histogram."""

PLACEHOLDER = "@@RUN@@"


def write_report(run_folder: Path, out: Path | None = None) -> Path:
    """Write the page of a run, by default as ``report.html`` in its folder.

    Parameters
    ----------
    run_folder
        Of a run that has finished, was stopped, was killed or is still going on.
    out
        Where to write instead.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    RunFolderError
        There is no run, its ``run.json`` is damaged, or the page cannot be written.
    """
    folder = RunFolder.open(run_folder)
    html = _page(_reduce(folder, out or folder.report_path))
    if out is None:
        folder.write_report(html)
        return folder.report_path
    try:
        out.write_text(html + "\n", encoding="utf-8")
    except OSError as error:
        raise RunFolderError(f"{out}: cannot be written: {error.strerror}") from None
    return out


def _page(data: Json) -> str:
    template = resources.files("airhilt.report").joinpath("report.html").read_text("utf-8")
    return template.replace(PLACEHOLDER, _embeddable(data))


def _embeddable(data: Json) -> str:
    """Return JSON in which nothing can end the script element that it lies in."""
    text = json.dumps(data, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _reduce(folder: RunFolder, page: Path) -> Json:
    """Return everything that the page shows."""
    info = folder.info()
    notes: list[str] = []
    camera_section = CameraSection(folder, page)
    log = _read(folder, _points_a_track(info), camera_section, notes)
    summary = _summary(folder, notes)
    _note_how_it_ended(info, log, notes)
    if log.events_left_out:
        notes.append(
            f"The timeline shows the first {MOST_EVENTS} events; {log.events_left_out} later ones "
            "are in log.mcap only."
        )
    ground = _ground_plan(info, notes)
    tracks = _flown(log, ground)
    actors = {actor["callsign"]: actor for actor in info.realised.get("actors", ())}
    pair, annotated = _pair(info, summary, tracks)
    return {
        "run": info.run,
        "scenario": _texts(info.realised, "name", "title", "description", "family"),
        "phase": info.phase,
        "cause": _cut(info.cause),
        "options": info.options.model_dump(mode="json")
        | {"assistant": info.assistant, "pace": info.pace},
        "unregistered": info.unregistered_programs,
        "notes": notes,
        "about": _about(info),
        "workers": [
            {
                "name": worker.description.name,
                "modality": worker.description.modality,
                "where": worker.where,
            }
            for worker in info.workers
        ],
        "separation": info.realised.get("separation", {}),
        "has_conflict": info.realised.get("conflict") is not None,
        "pair": pair,
        "pair_is_annotated": annotated,
        "summary": None if summary is None else summary.model_dump(mode="json"),
        "end_s": round(log.end_ns / SECOND_NS, 3),
        "tracks": [
            track.as_json(actor, ground is not None) | _kind(actors.get(actor, {}))
            for actor, track in tracks.items()
        ],
        "separations": _separations(tracks, pair),
        "airport": None if ground is None else ground.as_json(),
        "phases": [
            {"callsign": actor, "spells": [_spell(interval) for interval in lane.intervals()]}
            for actor, lane in log.phases.items()
        ],
        "radio": _radio(log, Sounds(folder.audio_path, page), notes),
        "cameras": _cameras(camera_section, notes),
        "runways": [_runway(lane, log.end_ns, ground, tracks) for lane in log.runways.values()],
        "events": [_with_line(event, info) for event in log.events],
        "latencies": _latencies(folder, notes),
        "draws": info.draws,
    }


# --- what the folder says -------------------------------------------------------------------


def _summary(folder: RunFolder, notes: list[str]) -> Summary | None:
    loaded = folder.summary()
    if loaded is None:
        notes.append(
            "There is no summary.json: the run was killed or is still going on. The numbers below "
            "are missing; charts and timeline show what the log has."
        )
        return None
    try:
        return Summary.model_validate(loaded)
    except ValidationError as error:
        field = "/".join(str(part) for part in error.errors()[0]["loc"])
        notes.append(f"summary.json is not as this version writes it ({field}), and left out.")
        return None


def _note_how_it_ended(info: RunInfo, log: _Log, notes: list[str]) -> None:
    if not log.ended:
        notes.append(
            f"The log breaks off at {log.end_ns / SECOND_NS:.1f} s: what came after is not known."
        )
    if info.phase == "stopped":
        notes.append(f"The run was stopped before its end: {_cut(info.cause)}")


def _about(info: RunInfo) -> list[tuple[str, str]]:
    """Return what it takes to run it again, by name."""
    return [
        *((f"version of {name}", version) for name, version in info.versions.items()),
        *((f"platform, {name}", value) for name, value in info.platform.items()),
        ("started at", info.started_at),
        *((f"SHA-256 of {name}", value) for name, value in info.hashes.items()),
    ]


def _points_a_track(info: RunInfo) -> int:
    share = MOST_POINTS_OF_ALL // max(len(info.realised.get("actors", ())), 1)
    most = MOST_POINTS if _airport(info) is None else MOST_POINTS_AT_AIRPORT
    return max(min(share, most), FEWEST_POINTS)


def _airport(info: RunInfo) -> str | None:
    """Return the name of the airport where the scenario takes place, if it does at one."""
    scene = info.realised.get("scene", {})
    return str(scene["airport"]) if scene.get("type") == "airport" else None


def _ground_plan(info: RunInfo, notes: list[str]) -> GroundPlan | None:
    name = _airport(info)
    if name is None:
        return None
    # Not at the top: reports of other runs do without the libraries behind it.
    from airhilt.report.ground_plan import GroundPlan

    try:
        return GroundPlan(name)
    except AirhiltError as error:
        notes.append(f"The airport cannot be drawn: {_cut(str(error))}")
        return None


def _kind(actor: Json) -> Json:
    """Return what an actor is and how large, as far as its type is still known here."""
    name = str(actor.get("aircraft") or actor.get("kind") or "")
    try:
        size = _dimensions(name, "aircraft" in actor) if name else None
    except AirhiltError:
        size = None
    return {
        "type": name,
        "category": actor.get("type", "aircraft"),
        "length_m": None if size is None else round(size.length_m, 1),
        "span_m": None if size is None else round(size.span_m, 1),
    }


def _dimensions(name: str, is_aircraft: bool) -> Size:
    if is_aircraft:
        return load_aircraft_type(name).dimensions
    return load_kind(name).dimensions


def _with_line(event: Json, info: RunInfo) -> Json:
    """Return an event; if it is a failure of a radio line, with what that was to say."""
    if event["kind"] != "failure":
        return event
    lines = info.realised.get("radio", {}).get("lines", ())
    declared = next((line for line in lines if line["id"] == event["who"]), None)
    if declared is None:
        return event
    return event | {"speaker": declared["speaker"], "line": _cut(declared["text"])}


def _read(
    folder: RunFolder, points_a_track: int, camera_section: CameraSection, notes: list[str]
) -> _Log:
    """Return what the log says, up to where it breaks off; cameras are left to the gallery."""
    log = _Log(points_a_track, camera_section)
    try:
        for logged in read_log(folder.log_path):
            log.take(logged)
    except RunFolderError as error:
        notes.append(f"The log cannot be read, so there is nothing to draw: {_cut(str(error))}")
    except ValidationError as error:
        notes.append(
            f"The log is not as this version writes it ({error.title}: {first_problem(error)}), "
            "and shown up to there."
        )
    return log


# --- the log --------------------------------------------------------------------------------


class _State(NamedTuple):
    """Where an aircraft truly was, as `relative` takes it."""

    t_ns: int
    latitude_rad: float
    longitude_rad: float
    altitude_m: float
    velocity_north_m_s: float
    velocity_east_m_s: float
    heading_deg: float
    on_ground: bool


class _Thinned:
    """Keeps at most so many of the states that it is given, evenly, and the last.

    Messages are kept as bytes: most are thrown away again, and parsing is what takes time.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self._stride = 1
        self._seen = 0
        self._kept: list[bytes] = []
        self._last = b""

    def add(self, data: bytes) -> None:
        if self._seen % self._stride == 0:
            if len(self._kept) == self._most:
                self._kept = self._kept[::2]
                self._stride *= 2
            if self._seen % self._stride == 0:
                self._kept.append(data)
        self._seen += 1
        self._last = data

    def states(self) -> list[_State]:
        last_is_kept = self._kept[-1] is self._last
        kept = self._kept if last_is_kept else [*self._kept, self._last]
        return [_state(data) for data in kept]


def _state(data: bytes) -> _State:
    truth = json.loads(data)
    return _State(
        truth["t_ns"],
        truth["latitude_deg"] * DEGREE,
        truth["longitude_deg"] * DEGREE,
        truth["altitude_m"],
        truth["velocity_north_m_s"],
        truth["velocity_east_m_s"],
        truth["heading_deg"],
        truth["on_ground"],
    )


class _Log:
    """Sorts out the messages of a log."""

    def __init__(self, points_a_track: int, camera_section: CameraSection) -> None:
        self.tracks: dict[str, _Thinned] = {}
        self.phases: dict[str, PhaseLane] = {}
        self.runways: dict[str, RunwayLane] = {}
        self.events: list[Json] = []
        self.events_left_out = 0
        self.calls = CallRecords()
        self.voices: list[AdvisoryAudio] = []
        self.end_ns = 0
        self.ended = False
        """Whether the run said that it was over."""
        self._points_a_track = points_a_track
        self._gallery = camera_section

    def take(self, logged: Logged) -> None:
        """Take in one message."""
        self.end_ns = max(self.end_ns, logged.t_ns)
        if self._gallery.takes(logged.key):
            self._gallery.take(logged)
            return
        if logged.key == "status/vision":
            self._gallery.status(Status.model_validate_json(logged.data))
        family, _, rest = logged.key.partition("/")
        if family == "adsb":
            return
        if family == "tts":
            self.voices.append(AdvisoryAudio.model_validate_json(logged.data))
            return
        model = _message_on_radio(family, rest)
        if model is not None:
            self.calls.take(model.model_validate_json(logged.data))
        if family == "radio":
            return
        if rest.startswith("state/"):
            actor = rest.removeprefix("state/")
            self.tracks.setdefault(actor, _Thinned(self._points_a_track)).add(logged.data)
            self.phases.setdefault(actor, PhaseLane()).take(logged.t_ns, logged.data)
            return
        if rest.startswith("runway/"):
            truth = json.loads(logged.data)
            name = _runway_name(truth["runway"])
            self.runways.setdefault(name, RunwayLane(name)).take(logged.t_ns, truth)
            return
        event = _event(family, rest, logged)
        if event is None:
            return
        self.ended |= event["kind"] in ("finished", "stopped")
        if len(self.events) < MOST_EVENTS or event["kind"] in ("finished", "stopped"):
            self.events.append(event)
        else:
            self.events_left_out += 1


def _message_on_radio(family: str, rest: str) -> type[Message] | None:
    """Return which message a key has, if it is about a call."""
    if family == "radio" and rest.endswith("/tx"):
        return Transmission
    if family == "asr":
        return Transcript
    if rest.startswith("radio/"):
        return SpokenTruth
    return HearingTruth if rest.startswith("hearing/") else None


def _event(family: str, rest: str, logged: Logged) -> Json | None:
    """Return a row of the timeline, or None for what is none."""
    message = json.loads(logged.data)
    if family == "advisory":
        row = _advisory(message)
    elif family == "asr":
        row = {
            "kind": "transcript",
            "who": logged.publisher,
            "text": message["text"],
            "engine": message["engine"],
            "confidence": message["confidence"],
        }
    elif family == "status":
        row = {
            "kind": "status",
            "who": message["modality"],
            "state": message["state"],
            "text": message["cause"],
        }
    elif family == "command":
        row = {"kind": "command", "who": rest, "text": _command(message["command"])}
    elif rest.startswith("radio/"):
        row = _call(message)
    elif rest == "conflict":
        row = _conflict(message)
    elif rest == "event":
        row = {"kind": message["kind"], "who": message["subject"], "text": message["text"]}
        if row["kind"] == "command":
            row["text"] = _command(json.loads(row["text"]))
    else:
        return None
    cut = {name: _cut(value) if isinstance(value, str) else value for name, value in row.items()}
    return {"t": logged.t_ns / SECOND_NS, **cut}


def _advisory(message: Json) -> Json:
    return {
        "kind": "advisory",
        "who": message["recipient"],
        "text": message["message"],
        "id": message["id"],
        "revision": message["revision"],
        "severity": message["severity"],
        "active": message["active"],
        "traffic": message["traffic"],
        "recommendation": message["recommendation"],
    }


def _call(message: Json) -> Json:
    return {
        "kind": "radio",
        "who": message["speaker"],
        "to": message["addressed"],
        "text": message["text"],
        "frequency_khz": message["frequency_khz"],
        "t_tx": message["t_tx_ns"] / SECOND_NS,
    }


def _conflict(message: Json) -> Json:
    return {
        "kind": "conflict",
        "who": " - ".join(message["actors"]),
        "text": "",
        "phase": message["phase"],
        "actors": message["actors"],
        "horizontal_m": message["horizontal_m"],
        "vertical_m": message["vertical_m"],
        "runway": None if message["runway"] is None else _runway_name(message["runway"]),
    }


def _command(command: Json) -> str:
    """Return a command as JSON, with the number of points in the place of a way over many."""
    points = {
        name: len(value)
        for name, value in command.items()
        if name == "route" or (name == "via" and command["action"] == "land")
    }
    return json.dumps(command | points)


def _runway_name(key: str) -> str:
    """Return ``01/19`` for ``01-19``, as a key has it."""
    return key.replace("-", "/")


def _texts(source: Json, *names: str) -> dict[str, str]:
    return {name: str(source.get(name, "")) for name in names}


def _cut(text: str) -> str:
    return text if len(text) <= MOST_CHARACTERS else text[: MOST_CHARACTERS - 1] + "…"


# --- what is drawn --------------------------------------------------------------------------


Locate = Callable[[_State], tuple[float, float]]
"""Returns how far east and north of the plan's centre a state is, in nautical miles."""


def _around_airport(ground: GroundPlan) -> Locate:
    def locate(state: _State) -> tuple[float, float]:
        east_m, north_m = ground.locate(state.latitude_rad, state.longitude_rad)
        return east_m / NAUTICAL_MILE, north_m / NAUTICAL_MILE

    return locate


class _Projection(NamedTuple):
    """A plane that touches the ellipsoid at the traffic's centre."""

    latitude_rad: float
    longitude_rad: float

    @classmethod
    def around(cls, states: Iterable[_State]) -> _Projection:
        """Return the projection whose centre is the middle of what was flown through."""
        known = list(states)
        if not known:
            return cls(0.0, 0.0)
        latitudes = [state.latitude_rad for state in known]
        begin = known[0].longitude_rad
        turns = [_wrapped(state.longitude_rad - begin) for state in known]
        return cls(
            (min(latitudes) + max(latitudes)) / 2.0,
            begin + (min(turns) + max(turns)) / 2.0,
        )

    def nautical_miles(self, state: _State) -> tuple[float, float]:
        """Return how far east and north of the centre a state is, at its height."""
        north_m, east_m = offset_m(
            (self.latitude_rad, self.longitude_rad),
            (state.latitude_rad, state.longitude_rad),
            state.altitude_m,
        )
        return east_m / NAUTICAL_MILE, north_m / NAUTICAL_MILE


def _wrapped(angle_rad: float) -> float:
    return (angle_rad + math.pi) % (2.0 * math.pi) - math.pi


class _Flown(NamedTuple):
    """The track of an aircraft as it is drawn, beside the states that it was made of."""

    states: list[_State]
    east_nm: list[float]
    north_nm: list[float]

    @classmethod
    def of(cls, states: list[_State], locate: Locate) -> _Flown:
        positions = [locate(state) for state in states]
        return cls(states, [east for east, _ in positions], [north for _, north in positions])

    def at(self, t_ns: float) -> tuple[float, float, float]:
        """Return how far east, north and up it was, in metres, linearly between two states."""
        times = [state.t_ns for state in self.states]
        heights_m = [state.altitude_m for state in self.states]
        return (
            float(np.interp(t_ns, times, self.east_nm)) * NAUTICAL_MILE,
            float(np.interp(t_ns, times, self.north_nm)) * NAUTICAL_MILE,
            float(np.interp(t_ns, times, heights_m)),
        )

    def as_json(self, actor: str, at_airport: bool) -> Json:
        digits = 5 if at_airport else 3
        track: Json = {
            "callsign": actor,
            "t": [round(state.t_ns / SECOND_NS, 2) for state in self.states],
            "east_nm": [round(east, digits) for east in self.east_nm],
            "north_nm": [round(north, digits) for north in self.north_nm],
            "altitude_ft": [round(state.altitude_m / FOOT) for state in self.states],
            "on_ground": self._on_ground_s(),
        }
        if at_airport:
            track["heading_deg"] = [round(state.heading_deg) for state in self.states]
        return track

    def _on_ground_s(self) -> list[tuple[float, float]]:
        """Return from when to when it was on the ground."""
        intervals: Intervals[bool] = Intervals()
        for state in self.states:
            intervals.go_on(state.t_ns, [True] if state.on_ground else [])
        return [
            (round(interval.from_ns / SECOND_NS, 2), round(interval.to_ns / SECOND_NS, 2))
            for interval in intervals.until(self.states[-1].t_ns)
        ]


def _flown(log: _Log, ground: GroundPlan | None) -> dict[str, _Flown]:
    states = {actor: track.states() for actor, track in log.tracks.items()}
    locate = _around_airport(ground) if ground is not None else _around_traffic(states.values())
    return {actor: _Flown.of(flown, locate) for actor, flown in states.items()}


def _around_traffic(states: Iterable[list[_State]]) -> Locate:
    return _Projection.around(itertools.chain.from_iterable(states)).nautical_miles


def _pair(
    info: RunInfo, summary: Summary | None, tracks: dict[str, _Flown]
) -> tuple[list[str] | None, bool]:
    """Return the pair whose separation is drawn, and whether the scenario names it."""
    conflict = info.realised.get("conflict")
    if conflict is not None:
        return list(conflict["actors"]), True
    if len(tracks) < 2:
        return None, False
    if len(tracks) == 2:
        return list(tracks), False
    if summary is None or summary.closest_approach is None:
        return None, False
    return _nearest_pair(summary.closest_approach, tracks), False


def _nearest_pair(closest: ClosestApproach, tracks: dict[str, _Flown]) -> list[str]:
    """Return who came as near to each other, and when, as the summary says of the nearest pair."""
    positions = np.array([track.at(closest.t_s * SECOND_NS) for track in tracks.values()])
    apart = np.abs(positions[:, None, :] - positions[None, :, :])
    horizontal_m, vertical_m = np.hypot(apart[..., 0], apart[..., 1]), apart[..., 2]
    error_m = np.hypot(horizontal_m - closest.horizontal_m, vertical_m - closest.vertical_m)
    np.fill_diagonal(error_m, np.inf)
    first, second = np.unravel_index(np.argmin(error_m), error_m.shape)
    actors = list(tracks)
    return [actors[first], actors[second]]


def _separations(tracks: dict[str, _Flown], pair: list[str] | None) -> Json | None:
    """Return how far apart a pair was, at the times at which both are known."""
    if pair is None or not all(actor in tracks for actor in pair):
        return None
    first, second = (tracks[actor].states for actor in pair)
    others = {state.t_ns: state for state in second}
    both = [(own, others[own.t_ns]) for own in first if own.t_ns in others]
    return {
        "t": [round(own.t_ns / SECOND_NS, 2) for own, _ in both],
        "horizontal_nm": [
            round(relative(own, other).distance_m / NAUTICAL_MILE, 4) for own, other in both
        ],
        "vertical_ft": [
            round(abs(own.altitude_m - other.altitude_m) / FOOT, 1) for own, other in both
        ],
    }


# --- lanes over time ------------------------------------------------------------------------


def _spell(interval: Interval[str]) -> Json:
    return {"what": _cut(interval.what), **_from_to(interval)}


def _from_to(interval: Interval[Any]) -> Json:
    return {
        "from": round(interval.from_ns / SECOND_NS, 2),
        "to": round(interval.to_ns / SECOND_NS, 2),
    }


def _runway(
    lane: RunwayLane, end_ns: int, ground: GroundPlan | None, tracks: dict[str, _Flown]
) -> Json:
    return {
        "runway": lane.name,
        "occupants": [_spell(interval) for interval in lane.occupants(end_ns)],
        "approaches": [
            {
                "what": interval.what.actor,
                "runway": interval.what.runway,
                "threshold": _crossed_s(interval, ground, tracks.get(interval.what.actor)),
                **_from_to(interval),
            }
            for interval in lane.approaches(end_ns)
        ],
    }


def _crossed_s(
    interval: Interval[Approach], ground: GroundPlan | None, track: _Flown | None
) -> float | None:
    """Return when an approach came over its threshold."""
    if ground is None or track is None:
        return None
    times_s = [state.t_ns / SECOND_NS for state in track.states]
    first, last = np.searchsorted(
        times_s, (interval.from_ns / SECOND_NS, interval.to_ns / SECOND_NS)
    )
    part = slice(max(first - 1, 0), last + 1)
    metres = ([value * NAUTICAL_MILE for value in axis] for axis in (track.east_nm, track.north_nm))
    east_m, north_m = (values[part] for values in metres)
    try:
        crossed = ground.threshold_crossed_s(interval.what.runway, times_s[part], east_m, north_m)
    except AirhiltError:  # The airport's file has changed since.
        return None
    return None if crossed is None else round(crossed, 2)


# --- the radio ------------------------------------------------------------------------------


def _radio(log: _Log, sounds: Sounds, notes: list[str]) -> Json:
    """Return the calls and the spoken advisories, in the order in which they began."""
    calls = [(call, said) for call in log.calls if (said := call.said) is not None]
    calls.sort(key=lambda call: (call[1].t_tx_ns, call[1].id))
    radio = {
        "calls": [_radio_call(call, said, sounds) for call, said in calls[:MOST_CALLS]],
        "voices": [_voice(voice, sounds) for voice in log.voices[:MOST_CALLS]],
    }
    left_out = max(len(calls) - MOST_CALLS, 0) + max(len(log.voices) - MOST_CALLS, 0)
    if left_out:
        notes.append(
            f"The radio shows the first {MOST_CALLS} calls and voices; {left_out} later ones are "
            "in log.mcap only."
        )
    if sounds.linked:
        notes.append(
            f"There was no room in this file for the sound of {sounds.linked} calls and "
            "advisories: they are links to the audio folder of the run."
        )
    if sounds.missing:
        notes.append(
            f"The sound of {sounds.missing} calls and advisories is missing in the audio folder, "
            "or is not that of this run."
        )
    return radio


def _cameras(camera_section: CameraSection, notes: list[str]) -> Json:
    """Return what cameras have shown."""
    cameras = camera_section.as_json() | {"cause": _cut(camera_section.cause)}
    if camera_section.linked:
        notes.append(
            f"There was no room in this file for {camera_section.linked} pictures: they are links "
            "to the pictures folder of the run."
        )
    return cameras


def _radio_call(call: CallRecord, said: SpokenTruth, sounds: Sounds) -> Json:
    return {
        "id": _cut(said.id),
        "from": round(said.t_tx_ns / SECOND_NS, 3),
        "to": round(said.t_end_ns / SECOND_NS, 3),
        "frequency_khz": said.frequency_khz,
        "who": _cut(said.speaker),
        "addressed": None if said.addressed is None else _cut(said.addressed),
        "said": _cut(said.text),
        "blocked_by": [_cut(name) for name in said.blocked_by],
        "snr_db": said.snr_db,
        "received": call.received is not None,
        "transcripts": [_transcript(transcript, said) for transcript in call.recognised],
        "hearings": [
            {"who": _cut(one.actor), "outcome": one.outcome, "text": _cut(one.text)}
            for one in call.hearings
        ],
        "sound": None if call.received is None else sounds.of(call.received),
    }


def _transcript(transcript: Transcript, said: SpokenTruth) -> Json:
    """Return what was recognised, beside what was said."""
    return {
        "engine": _cut(transcript.engine),
        "confidence": transcript.confidence,
        "after_end_s": (transcript.t_ns - said.t_end_ns) / SECOND_NS,
        "words": [
            {"kind": one.kind, "said": " ".join(one.said), "heard": " ".join(one.heard)}
            for one in align(_cut(said.text), _cut(transcript.text))
        ],
    }


def _voice(voice: AdvisoryAudio, sounds: Sounds) -> Json:
    return {
        "id": _cut(voice.id),
        "revision": voice.revision,
        "from": round(voice.t_ns / SECOND_NS, 3),
        "to": round(voice.t_ns / SECOND_NS + voice.samples / SAMPLE_RATE_HZ, 3),
        "recipient": _cut(voice.recipient),
        "said": _cut(voice.text),
        "engine": _cut(voice.engine),
        "after_decision_s": (voice.t_ns - voice.t_dec_ns) / SECOND_NS,
        "sound": sounds.of(voice),
    }


# --- latencies ------------------------------------------------------------------------------


def _latencies(folder: RunFolder, notes: list[str]) -> list[Json]:
    """Return a histogram of simulated latencies for each worker, over bins of equal ratio."""
    bins: dict[str, Counter[int]] = {}
    for worker, latency_s in _finished_steps(folder, notes):
        bins.setdefault(worker, Counter())[_bin(latency_s)] += 1
    return [
        {
            "worker": worker,
            "n": counts.total(),
            "bins": [
                {"from_s": _edge(index), "to_s": _edge(index + 1), "n": counts[index]}
                for index in sorted(counts)
            ],
        }
        for worker, counts in bins.items()
    ]


def _finished_steps(folder: RunFolder, notes: list[str]) -> Iterable[tuple[str, float]]:
    """Yield worker and latency from input to result, up to where the file breaks off."""
    try:
        lines = folder.latency_path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as error:
        notes.append(f"latency.jsonl cannot be read: {error.strerror}.")
        return
    for line in lines:
        try:
            row = json.loads(line)
        except json.JSONDecodeError:
            return
        if row.get("finished"):
            waited_ns = row["t_start_ns"] - row["t_in_ns"]
            yield row["worker"], (waited_ns + row["latency_ns"]) / SECOND_NS


def _bin(latency_s: float) -> int:
    if latency_s <= LEAST_LATENCY_S:
        return 0
    return math.floor(math.log10(latency_s / LEAST_LATENCY_S) * BINS_PER_DECADE)


def _edge(index: int) -> float:
    return float(f"{LEAST_LATENCY_S * 10.0 ** (index / BINS_PER_DECADE):.4g}")
