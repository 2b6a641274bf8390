"""A run that goes on, as its page shows it: changes made of the messages on the bus."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from pydantic import ValidationError

from airhilt.errors import AirhiltError
from airhilt.geodesy.wgs84 import Place
from airhilt.messages import (
    ActorTruth,
    AdsbReport,
    AdvisoryAudio,
    Briefing,
    CameraView,
    Clock,
    CockpitInstruments,
    Detections,
    RadarInfo,
    RadarPlot,
    SeatInfo,
    SeatNotice,
    SurfaceTrack,
    TaskCard,
    VehiclePosition,
    WorkloadAnswer,
    WorkloadQuestion,
)
from airhilt.metrics.calls import CallRecords, call_message
from airhilt.record import Logged
from airhilt.report.airport import ReportAirport
from airhilt.report.events import Events
from airhilt.report.tracks import Locate, Projection
from airhilt.sensors.radio.hearing import key_chunk
from airhilt.station.advisories import AdvisoryRows
from airhilt.station.audiences import NOBODY, SURVEILLANCE, Audience, SeatViews, audience_of
from airhilt.station.calls import call_as_json, spoken_as_json
from airhilt.station.cameras import found_as_json, view_as_json
from airhilt.station.changes import Changes, SeatChanges
from airhilt.station.latencies import LatencyBars
from airhilt.station.subscription import sound_name
from airhilt.surveillance.radar import plot_place
from airhilt.text import readable
from airhilt.units import DEGREE, FOOT, KNOT, NAUTICAL_MILE, SECOND_NS

Json = dict[str, Any]
Maker = Callable[[Logged], None]


class LiveRun:
    """Makes changes of the messages of a run; called on one thread.

    The changes are ``[kind, ...]``: ``clock``, ``briefing``, ``state``, ``name`` (an actor has
    another one from now on), ``plot``, ``call``, ``spoken``, ``advisory``, ``event``, ``camera``,
    ``picture`` and ``latency``. Positions come from the truth where it is shared, else from ADS-B
    and surface surveillance.

    Parameters
    ----------
    changes
        Gets the changes.
    seats
        Gets the changes that only the person at a seat sees: ``task``, ``cockpit``, ``info``,
        ``notice``, ``question`` and ``answered``.
    notice
        Is told of the first message of a kind that cannot be read.
    views
        Gets to know what each seat may see.

    Attributes
    ----------
    is_over
        True once the run has ended.
    """

    def __init__(
        self,
        changes: Changes,
        seats: Mapping[str, SeatChanges] = MappingProxyType({}),
        notice: Callable[[str], None] = lambda _: None,
        views: SeatViews | None = None,
    ) -> None:
        self.is_over = False
        self._views = views or SeatViews(seats)
        self._notice = notice
        self._unread: set[str] = set()
        """Kinds of messages of which some could not be read."""
        self._seats = seats
        self._changes = changes
        self._calls = CallRecords()
        self._bars = LatencyBars()
        self._advisories = AdvisoryRows()
        self._locate: Locate | None = None
        self._types: dict[str, str] = {}
        self._has_truth = False
        self._ground_m = 0.0
        """Height of the airport, in m."""
        self._callsigns: dict[str, str] = {}
        """Callsigns by icao24, as far as ADS-B has told."""
        self._radars: dict[str, RadarInfo] = {}
        self._cameras: set[str] = set()
        self._makers: dict[str, Maker] = {
            "clock": self._clock,
            "briefing": self._briefing,
            "adsb": self._adsb,
            "surface": self._surface,
            "radar": self._radar,
            "advisory": self._advisory,
            "equipment": self._advisory,
            "tts": self._spoken,
            "vision": self._vision,
            "task": self._task,
            "seat": self._seat_info,
            "notice": self._notice_of_seat,
            "cockpit": self._cockpit,
            "question": self._question,
            "workload": self._answered,
        }

    def take(self, logged: Logged) -> None:
        """Receive a message; one that is not as this version writes it is left out, and told."""
        family = logged.key.partition("/")[0]
        try:
            audience = audience_of(logged)
            if logged.key.startswith("truth/state/"):
                self._truth(logged)
            elif (model := call_message(logged.key)) not in (None, AdvisoryAudio):
                self._call(model.model_validate_json(logged.data), audience)
            elif family in self._makers:
                self._makers[family](logged)
            self._event(logged, audience)
            if (bar := self._bars.bar(logged)) is not None:
                # Bars name engines, and are thinned over all who send: no seat is told any.
                self._changes.add("latency", bar, audience=NOBODY)
        except (ValidationError, ValueError, LookupError, TypeError, RecursionError) as error:
            if family not in self._unread:
                self._unread.add(family)
                why = readable(f"{type(error).__name__}: {error}".partition("\n")[0])
                self._notice(f"{readable(logged.key)}: left out, for it cannot be read: {why}")

    def lost(self) -> None:
        """Tell that the run is not there any more."""
        if not self.is_over:
            self.is_over = True
            self._changes.add("clock", None, "gone", "")

    def _clock(self, logged: Logged) -> None:
        clock = Clock.model_validate_json(logged.data)
        self.is_over = clock.phase in ("finished", "stopped")
        shown = _seconds(clock.t_ns), clock.phase, readable(clock.pace), clock.behind_s
        self._changes.add("clock", *shown)

    def _briefing(self, logged: Logged) -> None:
        briefing = Briefing.model_validate_json(logged.data)
        self._types = {one.callsign: one.type for one in briefing.roster}
        airport = None
        if briefing.airport is not None:
            self._ground_m = briefing.airport.elevation_ft * FOOT
        if briefing.airport is not None:
            try:
                found = ReportAirport(briefing.airport.icao.lower())
            except AirhiltError:
                pass  # It is not one of this machine's: the traffic is drawn without it.
            else:
                airport, self._locate = found.as_json(), found.locate
        categories = {readable(one.callsign): one.category for one in briefing.roster}
        self._changes.add("briefing", readable(briefing.controller), airport, categories)

    # --- positions --------------------------------------------------------------------------

    def _truth(self, logged: Logged) -> None:
        truth = ActorTruth.model_validate_json(logged.data)
        self._has_truth = True
        self._changes.add(
            "state",
            *self._state(
                truth.actor,
                truth.category,
                truth.t_ns,
                (truth.latitude_deg, truth.longitude_deg, truth.altitude_m),
                (truth.velocity_east_m_s, truth.velocity_north_m_s),
                truth.heading_deg,
                truth.on_ground,
                truth.phase,
            ),
            audience=NOBODY,
        )

    def _adsb(self, logged: Logged) -> None:
        report = AdsbReport.model_validate_json(logged.data)
        if report.callsign is not None and report.icao24 not in self._callsigns:
            self._callsigns[report.icao24] = report.callsign
            self._changes.add(
                "name", report.icao24, readable(report.callsign), audience=_adsb_of(report)
            )
        category = (report.emitter_category or "A0")[0]
        self._observed(
            self._callsigns.get(report.icao24, report.icao24),
            "vehicle" if category == "C" else "aircraft",
            report,
            report.t_adsb_in_ns,
            report.on_ground,
            _adsb_of(report),
        )

    def _surface(self, logged: Logged) -> None:
        track = SurfaceTrack.model_validate_json(logged.data)
        known = track.icao24 in self._callsigns or track.callsign in self._types
        name = track.callsign or self._callsigns.get(track.icao24 or "") or f"track {track.track}"
        category = "aircraft" if known else "vehicle"
        on_ground = track.on_ground is not False
        self._observed(name, category, track, track.t_track_ns, on_ground, SURVEILLANCE)

    def _radar(self, logged: Logged) -> None:
        """Add a plot of a radar whose place is known."""
        match logged.key.split("/"):
            case ["radar", site, "info"]:
                self._radars[site] = RadarInfo.model_validate_json(logged.data)
            case ["radar", site] if site in self._radars:
                plot = RadarPlot.model_validate_json(logged.data)
                self._changes.add(
                    "plot", self._plot(self._radars[site], plot), audience=SURVEILLANCE
                )

    def _plot(self, info: RadarInfo, plot: RadarPlot) -> Json:
        east_m, north_m = self._on_plan(*plot_place(info, plot))
        return {
            "t": _seconds(plot.t_plot_ns),
            "kind": plot.kind,
            "east": east_m,
            "north": north_m,
            "code": plot.mode_a,
            "altitude_ft": plot.mode_c_ft,
            "turn_s": info.rotation_s,
        }

    def _on_plan(self, place: Place, height_m: float) -> tuple[float, float]:
        """Return how far east and north of the centre of the plan a place is, in m."""
        if self._locate is None:
            self._locate = Projection(*place).locate
        east_nm, north_nm = self._locate(place, height_m)
        return round(east_nm * NAUTICAL_MILE, 1), round(north_nm * NAUTICAL_MILE, 1)

    def _observed(
        self,
        name: str,
        category: str,
        seen: AdsbReport | SurfaceTrack,
        t_ns: int,
        on_ground: bool,
        audience: Audience,
    ) -> None:
        """Add a state as a sensor has it, unless the truth is known."""
        if self._has_truth:
            return
        track_rad = (seen.track_deg or 0.0) * DEGREE
        speed_m_s = seen.ground_speed_kt * KNOT
        self._changes.add(
            "state",
            *self._state(
                name,
                category,
                t_ns,
                (seen.latitude_deg, seen.longitude_deg, (seen.altitude_ft or 0.0) * FOOT),
                (speed_m_s * math.sin(track_rad), speed_m_s * math.cos(track_rad)),
                seen.track_deg or 0.0,
                on_ground,
                "",
            ),
            audience=audience,
        )

    def _state(
        self,
        name: str,
        category: str,
        t_ns: int,
        place: tuple[float, float, float],
        velocity_m_s: tuple[float, float],
        heading_deg: float,
        on_ground: bool,
        phase: str,
    ) -> tuple[Any, ...]:
        east_m, north_m = self._on_plan((place[0] * DEGREE, place[1] * DEGREE), place[2])
        return (
            readable(name),
            category,
            readable(self._types.get(name, "")),
            _seconds(t_ns),
            east_m,
            north_m,
            round(place[2] / FOOT),
            [round(part, 1) for part in velocity_m_s],
            round(heading_deg, 1),
            on_ground,
            readable(phase),
        )

    # --- radio, advisories, events ----------------------------------------------------------

    def _call(self, message: Any, audience: Audience) -> None:
        self._calls.take(message)
        record = self._calls.get(message.id)
        row = None if record is None else call_as_json(record)
        if row is not None:
            received = None if record is None else record.received
            # At a seat a call is heard while it lasts, and nobody else hears it.
            has_sound = received is not None and received.samples > 0 and not self._seats
            self._changes.add("call", row | {"has_sound": has_sound}, audience=audience)

    def _spoken(self, logged: Logged) -> None:
        audio = AdvisoryAudio.model_validate_json(logged.data)
        sound = sound_name(audio.model_dump()) if audio.samples else None
        row = spoken_as_json(audio) | {"sound": sound}
        self._changes.add("spoken", row, audience=Audience("advisory", audio.recipient))

    def _advisory(self, logged: Logged) -> None:
        row = self._advisories.add(logged)
        if self._seats:  # What others are told is not for who has a seat.
            row = row | {"texts": row["texts"][-1:]}
        self._changes.add("advisory", row, audience=audience_of(logged))

    def _event(self, logged: Logged, audience: Audience) -> None:
        events = Events()
        events.take(logged)
        for row in events.rows:
            self._changes.add("event", row, audience=audience)

    def _task(self, logged: Logged) -> None:
        card = TaskCard.model_validate_json(logged.data)
        self._seats[card.seat].add(
            "task",
            {
                "line": readable(card.line),
                "seat": readable(card.seat),
                "t": _seconds(card.t_ns),
                "addressed": None if card.addressed is None else readable(card.addressed),
                "text": readable(card.text),
                "done": card.is_done,
            },
        )

    def _seat_info(self, logged: Logged) -> None:
        info = SeatInfo.model_validate_json(logged.data)
        self._views.learn(info)
        self._seats[info.seat].add("info", info.model_dump(mode="json", exclude={"t_ns"}))

    def _notice_of_seat(self, logged: Logged) -> None:
        notice = SeatNotice.model_validate_json(logged.data)
        self._seats[notice.seat].add("notice", _seconds(notice.t_ns), readable(notice.text))

    def _own_position(self, logged: Logged) -> None:
        """Tell a driver where the own vehicle is; nobody else learns it from this."""
        shown = VehiclePosition.model_validate_json(logged.data)
        heading_rad, speed_m_s = shown.heading_deg * DEGREE, shown.ground_speed_kt * KNOT
        self._seats[shown.callsign].add(
            "state",
            *self._state(
                shown.callsign,
                "vehicle",
                shown.t_ns,
                (shown.latitude_deg, shown.longitude_deg, self._ground_m),
                (speed_m_s * math.sin(heading_rad), speed_m_s * math.cos(heading_rad)),
                shown.heading_deg,
                True,
                "",
            ),
        )

    def _question(self, logged: Logged) -> None:
        question = WorkloadQuestion.model_validate_json(logged.data)
        self._seats[question.seat].add(
            "question", question.number, question.scale, _seconds(question.t_ns)
        )

    def _answered(self, logged: Logged) -> None:
        answer = WorkloadAnswer.model_validate_json(logged.data)
        for seat, changes in self._seats.items():
            if logged.key == f"workload/{key_chunk(seat)}":
                changes.add("answered", answer.question)

    def _cockpit(self, logged: Logged) -> None:
        if logged.key.endswith("/position"):
            self._own_position(logged)
            return
        shown = CockpitInstruments.model_validate_json(logged.data)
        self._seats[shown.callsign].add(
            "cockpit", shown.model_dump(mode="json") | {"mode": readable(shown.mode)}
        )

    # --- cameras ----------------------------------------------------------------------------

    def _vision(self, logged: Logged) -> None:
        seen = Detections.model_validate_json(logged.data)
        self._camera(seen.camera, seen.view)
        if not seen.missed and self._locate is not None:
            self._changes.add(
                "picture",
                seen.camera,
                seen.seq,
                _seconds(seen.t_frame_ns),
                view_as_json(seen.view, self._locate),
                found_as_json(seen),
                audience=Audience("camera", seen.view.carrier),
            )

    def _camera(self, name: str, view: CameraView) -> None:
        if name not in self._cameras:
            self._cameras.add(name)
            audience = Audience("camera", view.carrier)
            self._views.learn_camera(name, audience)
            self._changes.add(
                "camera",
                {
                    "name": readable(name),
                    "carrier": view.carrier,
                    "width_px": view.width_px,
                    "height_px": view.height_px,
                    "horizontal_fov_deg": view.horizontal_fov_deg,
                },
                audience=audience,
            )


def _adsb_of(report: AdsbReport) -> Audience:
    return Audience("adsb", report.icao24)


def _seconds(t_ns: int) -> float:
    return round(t_ns / SECOND_NS, 3)
