"""A run that goes on, as its page shows it: changes made of the messages on the bus."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Any

from pydantic import ValidationError

from airhilt.errors import AirhiltError, first_line, first_problem
from airhilt.geodesy.wgs84 import Place
from airhilt.host.text import readable
from airhilt.messages import (
    ActorTruth,
    AdsbReport,
    Advisory,
    AdvisoryAudio,
    Briefing,
    Clock,
    CockpitInstruments,
    Detections,
    EquipmentAlert,
    HearingTruth,
    Message,
    RadarInfo,
    RadarPlot,
    SeatState,
    SpokenTruth,
    SurfaceTrack,
    Transcript,
    Transmission,
    VehiclePosition,
    bus_message,
)
from airhilt.metrics.calls import CallRecords
from airhilt.record import Logged
from airhilt.report.airport import ReportAirport
from airhilt.report.events import event_row
from airhilt.report.tracks import Locate, Projection
from airhilt.station.advisories import AdvisoryRows
from airhilt.station.audiences import NOBODY, Audience, audience_of
from airhilt.station.calls import call_as_json, spoken_as_json
from airhilt.station.cameras import found_as_json, view_as_json
from airhilt.station.changes import Changes
from airhilt.station.latencies import LatencyBars
from airhilt.station.seat_views import SeatViews
from airhilt.station.subscription import sound_name
from airhilt.surveillance.radar import plot_place
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, NAUTICAL_MILE, SECOND_NS

Json = dict[str, Any]
Change = tuple[Any, ...]
"""Kind of a change, and what belongs to it."""


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
    views
        Gets to know what each seat may see, and the changes that only the person there sees:
        ``seat`` (its state), ``cockpit``, and ``state`` of the own vehicle.
    notice
        Is told of the first message of a kind that cannot be read.

    Attributes
    ----------
    is_over
        True once the run has ended.
    """

    def __init__(self, changes: Changes, views: SeatViews, notice: Callable[[str], None]) -> None:
        self.is_over = False
        self._views = views
        self._has_seats = bool(views.own)
        self._notice = notice
        self._unread: set[str] = set()
        """Kinds of messages of which some could not be read."""
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

    def take(self, logged: Logged) -> None:
        """Receive a message; one that is not as this version writes it is left out, and told."""
        model = bus_message(logged.key)
        if model is None:
            return
        try:
            message = model.model_validate_json(logged.data)
            audience = audience_of(logged.key, message)
            for change in self._changes_by(message):
                self._changes.add(*change, audience=audience)
            if (row := event_row(logged._replace(t_ns=message.t_ns))) is not None:
                self._changes.add("event", self._without_engine(row), audience=audience)
            if (bar := self._bars.bar(message)) is not None:
                # Bars name engines, and are thinned over all who send: no seat is told any.
                self._changes.add("latency", bar, audience=NOBODY)
        except ValidationError as error:
            self._leave_out(logged.key, first_problem(error))
        except (ValueError, LookupError, OverflowError) as error:
            self._leave_out(logged.key, first_line(error))

    def _leave_out(self, key: str, why: str) -> None:
        """Tell of the first message of a kind that cannot be read."""
        family = key.partition("/")[0]
        if family not in self._unread:
            self._unread.add(family)
            self._notice(f"{readable(key)}: left out, for it cannot be read: {readable(why)}")

    def lost(self) -> None:
        """Tell that the run is not there any more."""
        if not self.is_over:
            self.is_over = True
            self._changes.add("clock", None, "gone", "")

    def _changes_by(self, message: Message) -> Iterator[Change]:
        """Yield the changes by a message; those of a seat alone go there."""
        match message:
            case Clock():
                self.is_over = message.phase in ("finished", "stopped")
                pace = readable(message.pace)
                yield "clock", _seconds(message.t_ns), message.phase, pace, message.behind_s
            case Briefing():
                yield self._briefing(message)
            case ActorTruth():
                self._has_truth = True
                yield self._truth(message)
            case AdsbReport():
                yield from self._adsb(message)
            case SurfaceTrack():
                yield from self._surface(message)
            case RadarInfo():
                self._radars[message.site] = message
            case RadarPlot() if message.site in self._radars:
                yield "plot", self._plot(message, self._radars[message.site])
            case SpokenTruth() | Transmission() | HearingTruth() | Transcript():
                yield from self._call(message)
            case Advisory() | EquipmentAlert():
                row = self._advisories.add(message)
                # What others are told is not for who has a seat.
                yield "advisory", row | {"texts": row["texts"][-1:]} if self._has_seats else row
            case AdvisoryAudio():
                sound = sound_name(message) if message.samples else None
                yield "spoken", spoken_as_json(message) | {"sound": sound}
            case Detections():
                yield from self._picture(message)
            case SeatState():
                self._views.learn(message)
            case CockpitInstruments():
                shown = message.model_dump(mode="json") | {"mode": readable(message.mode)}
                self._views.own[message.callsign].put("cockpit", shown)
            case VehiclePosition():
                self._views.own[message.callsign].put(*self._own_position(message))

    def _briefing(self, briefing: Briefing) -> Change:
        self._types = {one.callsign: one.type for one in briefing.roster}
        airport = None
        if briefing.airport is not None:
            self._ground_m = briefing.airport.elevation_ft * FOOT
            # An airport that this machine does not have: the traffic is drawn without it.
            with suppress(AirhiltError):
                found = ReportAirport(briefing.airport.icao.lower())
                airport, self._locate = found.as_json(), found.locate
        categories = {readable(one.callsign): one.category for one in briefing.roster}
        return "briefing", readable(briefing.controller), airport, categories

    # --- positions --------------------------------------------------------------------------

    def _truth(self, truth: ActorTruth) -> Change:
        return self._state(
            truth.actor,
            truth.category,
            truth.t_ns,
            (truth.latitude_deg, truth.longitude_deg, truth.altitude_m),
            (
                truth.velocity_east_m_s,
                truth.velocity_north_m_s,
                -truth.velocity_down_m_s / FOOT_PER_MINUTE,
            ),
            truth.heading_deg,
            truth.on_ground,
            truth.phase,
        )

    def _own_position(self, shown: VehiclePosition) -> Change:
        """Return where the vehicle of a driver is; nobody else learns it from this."""
        return self._state(
            shown.callsign,
            "vehicle",
            shown.t_ns,
            (shown.latitude_deg, shown.longitude_deg, self._ground_m),
            _velocity_m_s(shown.heading_deg, shown.ground_speed_kt),
            shown.heading_deg,
            on_ground=True,
        )

    def _adsb(self, report: AdsbReport) -> Iterator[Change]:
        if report.callsign is not None and report.icao24 not in self._callsigns:
            self._callsigns[report.icao24] = report.callsign
            yield "name", report.icao24, readable(report.callsign)
        name = self._callsigns.get(report.icao24, report.icao24)
        category = "vehicle" if (report.emitter_category or "A0")[0] == "C" else "aircraft"
        on_ground, climb_fpm = report.on_ground, (report.vertical_rate_fpm,)
        yield from self._observed(name, category, report, report.t_adsb_in_ns, on_ground, climb_fpm)

    def _surface(self, track: SurfaceTrack) -> Iterator[Change]:
        known = track.icao24 in self._callsigns or track.callsign in self._types
        name = track.callsign or self._callsigns.get(track.icao24 or "") or f"track {track.track}"
        category = "aircraft" if known else "vehicle"
        yield from self._observed(
            name, category, track, track.t_track_ns, track.on_ground is not False
        )

    def _observed(
        self,
        name: str,
        category: str,
        seen: AdsbReport | SurfaceTrack,
        t_ns: int,
        on_ground: bool,
        climb_fpm: tuple[float, ...] = (),
    ) -> Iterator[Change]:
        """Yield a state as a sensor has it, unless the truth is known."""
        if not self._has_truth:
            track_deg = seen.track_deg or 0.0
            yield self._state(
                name,
                category,
                t_ns,
                (seen.latitude_deg, seen.longitude_deg, (seen.altitude_ft or 0.0) * FOOT),
                (*_velocity_m_s(track_deg, seen.ground_speed_kt), *climb_fpm),
                track_deg,
                on_ground,
            )

    def _state(
        self,
        name: str,
        category: str,
        t_ns: int,
        place: tuple[float, float, float],
        velocity: tuple[float, ...],
        heading_deg: float,
        on_ground: bool,
        phase: str = "",
    ) -> Change:
        """Return the change of a state.

        Parameters
        ----------
        place
            Latitude and longitude in degrees, and altitude in m.
        velocity
            East and north in m/s, and the vertical rate in ft/min if it is reported.
        """
        east_m, north_m = self._on_plan((place[0] * DEGREE, place[1] * DEGREE), place[2])
        return (
            "state",
            readable(name),
            category,
            readable(self._types.get(name, "")),
            _seconds(t_ns),
            east_m,
            north_m,
            round(place[2] / FOOT),
            [round(part, 1) for part in velocity],
            round(heading_deg, 1),
            on_ground,
            readable(phase),
        )

    def _plot(self, plot: RadarPlot, info: RadarInfo) -> Json:
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

    # --- radio, events, cameras -------------------------------------------------------------

    def _call(
        self, message: SpokenTruth | Transmission | HearingTruth | Transcript
    ) -> Iterator[Change]:
        self._calls.take(message)
        record = self._calls.get(message.id)
        row = None if record is None else call_as_json(record, names_engines=not self._has_seats)
        if record is not None and row is not None:
            # At a seat a call is heard while it lasts, and nobody else hears it.
            has_sound = bool(record.received and record.received.samples) and not self._has_seats
            yield "call", row | {"has_sound": has_sound}

    def _without_engine(self, row: Json) -> Json:
        """Return an event; with seats no engine is named, which tells which condition there is."""
        return row | {"engine": None} if self._has_seats and "engine" in row else row

    def _picture(self, seen: Detections) -> Iterator[Change]:
        if seen.camera not in self._cameras:
            self._cameras.add(seen.camera)
            self._views.learn_camera(seen.camera, Audience("camera", seen.view.carrier))
            shown = {"carrier", "width_px", "height_px", "horizontal_fov_deg"}
            yield "camera", {"name": readable(seen.camera)} | seen.view.model_dump(include=shown)
        if not seen.missed and self._locate is not None:
            yield (
                "picture",
                seen.camera,
                seen.seq,
                _seconds(seen.t_frame_ns),
                view_as_json(seen.view, self._locate),
                found_as_json(seen),
            )


def _velocity_m_s(heading_deg: float, speed_kt: float) -> tuple[float, float]:
    """Return the velocity east and north."""
    heading_rad, speed_m_s = heading_deg * DEGREE, speed_kt * KNOT
    return speed_m_s * math.sin(heading_rad), speed_m_s * math.cos(heading_rad)


def _seconds(t_ns: int) -> float:
    return round(t_ns / SECOND_NS, 3)
