"""Reads a run folder: what all sections of its report share."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

import numpy as np
from pydantic import ValidationError

from airhilt.errors import AirhiltError, RunFolderError, first_line
from airhilt.geodesy.relative_motion import horizontal_distance_m
from airhilt.host.text import readable
from airhilt.metrics.summary import ClosestApproach, Summary
from airhilt.record import Logged, Run, RunFolder, RunInfo
from airhilt.report.events import MOST_EVENTS, Events
from airhilt.report.intervals import seconds
from airhilt.report.tracks import (
    Locate,
    Phases,
    Projection,
    State,
    ThinnedStates,
    Track,
    parse_state,
)
from airhilt.report.unread import CANNOT_READ, UnreadMessages
from airhilt.shapes.sizes import Size
from airhilt.units import FOOT, NAUTICAL_MILE, SECOND_NS
from airhilt.world.flight import load_aircraft_type
from airhilt.world.surface.kinds import load_kind

if TYPE_CHECKING:
    from airhilt.report.airport import ReportAirport
    from airhilt.report.sections import GuardedContent

Json = dict[str, Any]

STATE = "truth/state/"
"""Beginning of the keys of the actors' true states."""
MOST_POINTS = 600
"""Largest number of points of one track: a chart is hardly wider in pixels."""
MOST_POINTS_AT_AIRPORT = 1200
"""Largest number of points of one track at an airport: turns are tight there."""
MOST_POINTS_OF_ALL = 15_000
"""Largest number of points of all tracks together, so that the page stays below a megabyte."""
FEWEST_POINTS = 40
"""Least number of points that a track may have, however many tracks there are."""


@dataclass(frozen=True)
class RunData:
    """A run as its report shows it."""

    folder: RunFolder
    page: Path
    """File that the page is written to; links lead from there."""
    info: RunInfo
    summary: Summary | None
    """The numbers, None if the run did not write them."""
    notes: list[str]
    """Sentences above the page on what is missing. Sections may append to them."""
    end_ns: int
    """Time of the last message in the log."""
    events: Events
    locate: Locate
    """Returns where a place lies on the plan, in NM east and north of its centre."""
    tracks: dict[str, Track]
    pair: list[str] | None
    """The two actors whose separation is drawn, None if there is no such pair."""
    pair_is_annotated: bool
    airport: ReportAirport | None
    """The airport of the scenario, None where there is none or it cannot be drawn."""

    def link(self, path: Path) -> str:
        """Return a link from the page to a file of the run."""
        return quote(os.path.relpath(path, self.page.parent).replace(os.sep, "/"))

    def as_json(self) -> Json:
        """Return what all sections share.

        It raises `RunFolderError` if ``run.json`` describes the scenario in another shape than a
        run writes.
        """
        with _of_record(self.folder):
            info, realised = self.info, self.info.realised
            files = realised.get("files", {})
            actors = {actor["callsign"]: actor for actor in realised.get("actors", ())}
            at_airport = self.airport is not None
            texts = ("name", "title", "description", "family")
            return {
                "run": info.run,
                "scenario": {name: str(realised.get(name, "")) for name in texts},
                "phase": info.phase,
                "cause": readable(info.cause),
                "options": info.options.model_dump(mode="json")
                | {"assistant": info.assistant, "pace": info.pace},
                "unregistered": info.unregistered_programs,
                "notes": self.notes,
                "separation": realised.get("separation", {}),
                "has_conflict": realised.get("conflict") is not None,
                "pair": self.pair,
                "pair_is_annotated": self.pair_is_annotated,
                "summary": None if self.summary is None else self.summary.model_dump(mode="json"),
                "end_s": round(self.end_ns / SECOND_NS, 3),
                "tracks": [
                    track.as_json(actor, at_airport) | _kind(actors.get(actor, {}), files)
                    for actor, track in self.tracks.items()
                ],
                "separations": _separations(self.tracks, self.pair),
                "airport": None if self.airport is None else self.airport.as_json(),
                "events": self.events.as_json(info),
            }


def read_run(recorded: Run, page: Path, contents: Sequence[GuardedContent]) -> RunData:
    """Read a run folder, and give the messages of its log to the sections that ask for them.

    The page is the file that is written. It raises `RunFolderError` if the log cannot be read; else
    as `RunData.as_json`.
    """
    with _of_record(recorded.paths):
        info, folder = recorded.info, recorded.paths
        notes = [f"Damaged: {readable(line)}." for line in recorded.damage]
        log = _Log(_points_a_track(info), contents)
        log.read(recorded, notes)
        summary = _summary(folder, notes)
        _note_how_it_ended(info, log, notes)
        airport = _airport(info, notes)
        around = Projection.around(chain.from_iterable(log.states.values()))
        locate = around.locate if airport is None else airport.locate
        tracks = {
            actor: Track.of(states, log.phases[actor].as_json(), locate)
            for actor, states in log.states.items()
        }
        pair, annotated = _pair(info, summary, tracks)
        return RunData(
            folder=folder,
            page=page,
            info=info,
            summary=summary,
            notes=notes,
            end_ns=log.end_ns,
            events=log.events,
            locate=locate,
            tracks=tracks,
            pair=pair,
            pair_is_annotated=annotated,
            airport=airport,
        )


@contextmanager
def _of_record(folder: RunFolder) -> Iterator[None]:
    """Name ``run.json`` where what it says of the scenario is not what a run writes."""
    try:
        yield
    except AirhiltError:
        raise
    except CANNOT_READ as error:
        raise RunFolderError(
            f"{folder.info_path}: what it says of the scenario cannot be shown "
            f"({first_line(error)}); expected it as a run writes it"
        ) from error


class _Log:
    """Sorts the messages of a log."""

    def __init__(self, points_a_track: int, contents: Sequence[GuardedContent]) -> None:
        self.states: dict[str, list[State]] = {}
        self.phases: dict[str, Phases] = {}
        self.events = Events()
        self.end_ns = 0
        self._points_a_track = points_a_track
        self._thinned: dict[str, ThinnedStates] = {}
        self._unread = UnreadMessages()
        self._contents = contents
        self._receivers: dict[str, list[GuardedContent]] = {}

    def read(self, recorded: Run, notes: list[str]) -> None:
        """Read the log up to where it breaks off."""
        try:
            for logged in recorded.log():
                self._take(logged)
        except RunFolderError as error:
            notes.append(
                f"The log cannot be read, so there is nothing to draw: {readable(str(error))}"
            )
        for thinned in self._thinned.values():
            for logged in thinned.messages():
                self._unread.attempt(self._parse_state, logged)
        if note := self._unread.note():
            notes.append(note)

    def _take(self, logged: Logged) -> None:
        self.end_ns = max(self.end_ns, logged.t_ns)
        if logged.key not in self._receivers:
            self._receivers[logged.key] = [
                content for content in self._contents if logged.key.startswith(content.section.keys)
            ]
        for content in self._receivers[logged.key]:
            self._unread.attempt(content.take, logged)
        take = self._take_state if logged.key.startswith(STATE) else self.events.take
        self._unread.attempt(take, logged)

    def _take_state(self, logged: Logged) -> None:
        actor = logged.key.removeprefix(STATE)
        self.phases.setdefault(actor, Phases()).add(logged.t_ns, logged.data)
        self._thinned.setdefault(actor, ThinnedStates(self._points_a_track)).add(logged)

    def _parse_state(self, logged: Logged) -> None:
        state = parse_state(logged.data)
        self.states.setdefault(logged.key.removeprefix(STATE), []).append(state)


# --- the summary, and how the run ended -----------------------------------------------------


def _summary(folder: RunFolder, notes: list[str]) -> Summary | None:
    try:
        loaded = folder.summary()
    except RunFolderError as error:
        notes.append(f"The numbers below are missing: {readable(str(error))}")
        return None
    if loaded is None:
        notes.append(
            "There is no summary.json: the run was killed or is still going on. The numbers below "
            "are missing; charts and timeline show what the log has."
        )
        return None
    try:
        summary = Summary.model_validate(loaded)
    except ValidationError as error:
        field = "/".join(str(part) for part in error.errors()[0]["loc"])
        notes.append(f"summary.json is not as this version writes it ({field}), and left out.")
        return None
    notes.extend(map(readable, summary.too_slow))
    return summary


def _note_how_it_ended(info: RunInfo, log: _Log, notes: list[str]) -> None:
    if not log.events.ended:
        notes.append(
            f"The log breaks off at {log.end_ns / SECOND_NS:.1f} s: what came after is not known."
        )
    if info.phase == "stopped":
        notes.append(f"The run was stopped before its end: {readable(info.cause)}")
    if log.events.left_out:
        notes.append(
            f"The timeline shows the first {MOST_EVENTS} events; {log.events.left_out} later ones "
            "are in log.mcap only."
        )


# --- tracks ---------------------------------------------------------------------------------


def _points_a_track(info: RunInfo) -> int:
    share = MOST_POINTS_OF_ALL // max(len(info.realised.get("actors", ())), 1)
    is_at_airport = info.realised.get("scene", {}).get("type") == "airport"
    most = MOST_POINTS_AT_AIRPORT if is_at_airport else MOST_POINTS
    return max(min(share, most), FEWEST_POINTS)


def _airport(info: RunInfo, notes: list[str]) -> ReportAirport | None:
    scene = info.realised.get("scene", {})
    if scene.get("type") != "airport":
        return None
    # Not at the top: reports of other runs do without the libraries behind it.
    from airhilt.report.airport import ReportAirport

    try:
        return ReportAirport(str(scene["airport"]), info.realised.get("files", {}))
    except AirhiltError as error:
        notes.append(f"The airport cannot be drawn: {readable(str(error))}")
        return None


def _kind(actor: Json, files: Json) -> Json:
    """Return the type of an actor, and its size as far as the type is still known here."""
    name = str(actor.get("aircraft") or actor.get("kind") or "")
    size: Size | None = None
    with suppress(AirhiltError):
        if "aircraft" in actor:
            size = load_aircraft_type(name, files).dimensions
        elif name:
            size = load_kind(name).dimensions
    return {
        "type": name,
        "category": actor.get("type", "aircraft"),
        "length_m": None if size is None else round(size.length_m, 1),
        "span_m": None if size is None else round(size.span_m, 1),
    }


# --- the pair -------------------------------------------------------------------------------


def _pair(
    info: RunInfo, summary: Summary | None, tracks: dict[str, Track]
) -> tuple[list[str] | None, bool]:
    """Return the pair whose separation is drawn, and True if the scenario names it."""
    conflict = info.realised.get("conflict")
    if conflict is not None:
        return list(conflict["actors"]), True
    if len(tracks) == 2:
        return list(tracks), False
    if len(tracks) > 2 and summary is not None and summary.closest_approach is not None:
        return _nearest_pair(summary.closest_approach, tracks), False
    return None, False


def _nearest_pair(closest: ClosestApproach, tracks: dict[str, Track]) -> list[str]:
    """Return the two actors whose distance at that time is the one in the summary."""
    t_ns = [round(closest.t_s * SECOND_NS)]
    positions = np.array([np.ravel(track.positions_m(t_ns)) for track in tracks.values()])
    apart = np.abs(positions[:, None, :] - positions[None, :, :])
    horizontal_m, vertical_m = np.hypot(apart[..., 0], apart[..., 1]), apart[..., 2]
    error_m = np.hypot(horizontal_m - closest.horizontal_m, vertical_m - closest.vertical_m)
    np.fill_diagonal(error_m, np.inf)
    first, second = np.unravel_index(np.argmin(error_m), error_m.shape)
    actors = list(tracks)
    return [actors[first], actors[second]]


def _separations(tracks: dict[str, Track], pair: Iterable[str] | None) -> Json | None:
    """Return the separation of a pair at the times at which both states are known."""
    if pair is None or not all(actor in tracks for actor in pair):
        return None
    first, second = (tracks[actor].states for actor in pair)
    others = {state.t_ns: state for state in second}
    both = [(own, others[own.t_ns]) for own in first if own.t_ns in others]
    return {
        "t": [seconds(own.t_ns) for own, _ in both],
        "horizontal_nm": [
            round(horizontal_distance_m(own, other) / NAUTICAL_MILE, 4) for own, other in both
        ],
        "vertical_ft": [
            round(abs(own.altitude_m - other.altitude_m) / FOOT, 1) for own, other in both
        ],
    }
