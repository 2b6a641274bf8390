"""A run that goes on, as its page shows it: changes made of the messages on the bus."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from pydantic import ValidationError

from airhilt.errors import AirhiltError, first_line, first_problem
from airhilt.geodesy.wgs84 import Place
from airhilt.host.text import readable
from airhilt.messages import (
    ActorCommand,
    ActorTruth,
    AdsbReport,
    Advisory,
    AdvisoryAudio,
    Briefing,
    CameraView,
    Clock,
    CockpitInstruments,
    ConflictTruth,
    Detections,
    EquipmentAlert,
    Event,
    HearingTruth,
    Message,
    RadarInfo,
    RadarPlot,
    SeatState,
    SpokenTruth,
    Status,
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


class Received(NamedTuple):
    """A message of the run, parsed, and who may see what it says."""

    logged: Logged
    message: Any
    audience: Audience


Maker = Callable[[Received], None]


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
        self._makers = self._makers_of_kinds()

    def _makers_of_kinds(self) -> dict[type[Message], tuple[Maker, ...]]:
        """Return the methods that make the changes of each kind of message, in their order."""
        return {
            Clock: (self._clock,),
            Briefing: (self._briefing,),
            ActorTruth: (self._truth,),
            AdsbReport: (self._adsb, self._latency),
            SurfaceTrack: (self._surface,),
            RadarInfo: (self._radar,),
            RadarPlot: (self._plot,),
            SpokenTruth: (self._call, self._event),
            Transmission: (self._call,),
            HearingTruth: (self._call,),
            Transcript: (self._call, self._event, self._latency),
            Advisory: (self._advisory, self._event, self._latency),
            EquipmentAlert: (self._advisory, self._event),
            AdvisoryAudio: (self._spoken, self._latency),
            Status: (self._event,),
            ActorCommand: (self._event,),
            ConflictTruth: (self._event,),
            Event: (self._event,),
            Detections: (self._vision, self._latency),
            SeatState: (self._seat,),
            CockpitInstruments: (self._cockpit,),
            VehiclePosition: (self._own_position,),
        }

    def take(self, logged: Logged) -> None:
        """Receive a message; one that is not as this version writes it is left out, and told."""
        model = bus_message(logged.key)
        if model is None or (makers := self._makers.get(model)) is None:
            return
        try:
            message = model.model_validate_json(logged.data)
            audience = audience_of(logged.key, message)
            received = Received(logged._replace(t_ns=message.t_ns), message, audience)
            for make in makers:
                make(received)
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

    def _clock(self, received: Received) -> None:
        clock: Clock = received.message
        self.is_over = clock.phase in ("finished", "stopped")
        shown = _seconds(clock.t_ns), clock.phase, readable(clock.pace), clock.behind_s
        self._changes.add("clock", *shown)

    def _briefing(self, received: Received) -> None:
        briefing: Briefing = received.message
        self._types = {one.callsign: one.type for one in briefing.roster}
        airport = None
        if briefing.airport is not None:
            self._ground_m = briefing.airport.elevation_ft * FOOT
            try:
                found = ReportAirport(briefing.airport.icao.lower())
            except AirhiltError:
                pass  # It is not one of this machine's: the traffic is drawn without it.
            else:
                airport, self._locate = found.as_json(), found.locate
        categories = {readable(one.callsign): one.category for one in briefing.roster}
        self._changes.add("briefing", readable(briefing.controller), airport, categories)

    # --- positions --------------------------------------------------------------------------

    def _truth(self, received: Received) -> None:
        truth: ActorTruth = received.message
        self._has_truth = True
        self._changes.add(
            "state",
            *self._state(
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
            ),
            audience=received.audience,
        )

    def _adsb(self, received: Received) -> None:
        report: AdsbReport = received.message
        if report.callsign is not None and report.icao24 not in self._callsigns:
            self._callsigns[report.icao24] = report.callsign
            self._changes.add(
                "name", report.icao24, readable(report.callsign), audience=received.audience
            )
        category = (report.emitter_category or "A0")[0]
        self._observed(
            self._callsigns.get(report.icao24, report.icao24),
            "vehicle" if category == "C" else "aircraft",
            report,
            report.t_adsb_in_ns,
            report.on_ground,
            received.audience,
        )

    def _surface(self, received: Received) -> None:
        track: SurfaceTrack = received.message
        known = track.icao24 in self._callsigns or track.callsign in self._types
        name = track.callsign or self._callsigns.get(track.icao24 or "") or f"track {track.track}"
        category = "aircraft" if known else "vehicle"
        on_ground = track.on_ground is not False
        self._observed(name, category, track, track.t_track_ns, on_ground, received.audience)

    def _radar(self, received: Received) -> None:
        info: RadarInfo = received.message
        self._radars[info.site] = info

    def _plot(self, received: Received) -> None:
        """Add a plot of a radar whose place is known."""
        plot: RadarPlot = received.message
        info = self._radars.get(plot.site)
        if info is None:
            return
        east_m, north_m = self._on_plan(*plot_place(info, plot))
        shown = {
            "t": _seconds(plot.t_plot_ns),
            "kind": plot.kind,
            "east": east_m,
            "north": north_m,
            "code": plot.mode_a,
            "altitude_ft": plot.mode_c_ft,
            "turn_s": info.rotation_s,
        }
        self._changes.add("plot", shown, audience=received.audience)

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
        velocity: tuple[float, ...] = (
            speed_m_s * math.sin(track_rad),
            speed_m_s * math.cos(track_rad),
        )
        if isinstance(seen, AdsbReport):
            velocity = (*velocity, seen.vertical_rate_fpm)
        self._changes.add(
            "state",
            *self._state(
                name,
                category,
                t_ns,
                (seen.latitude_deg, seen.longitude_deg, (seen.altitude_ft or 0.0) * FOOT),
                velocity,
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
        velocity: tuple[float, ...],
        heading_deg: float,
        on_ground: bool,
        phase: str,
    ) -> tuple[Any, ...]:
        """Return a state as the page has it.

        Parameters
        ----------
        velocity
            East and north in m/s, and the vertical rate in ft/min if it is reported.
        """
        east_m, north_m = self._on_plan((place[0] * DEGREE, place[1] * DEGREE), place[2])
        return (
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

    # --- radio, advisories, events ----------------------------------------------------------

    def _call(self, received: Received) -> None:
        message = received.message
        self._calls.take(message)
        record = self._calls.get(message.id)
        row = None if record is None else call_as_json(record, names_engines=not self._has_seats)
        if record is not None and row is not None:
            # At a seat a call is heard while it lasts, and nobody else hears it.
            has_sound = bool(record.received and record.received.samples) and not self._has_seats
            self._changes.add("call", row | {"has_sound": has_sound}, audience=received.audience)

    def _spoken(self, received: Received) -> None:
        audio: AdvisoryAudio = received.message
        sound = sound_name(audio) if audio.samples else None
        row = spoken_as_json(audio) | {"sound": sound}
        self._changes.add("spoken", row, audience=received.audience)

    def _advisory(self, received: Received) -> None:
        row = self._advisories.add(received.message)
        if self._has_seats:  # What others are told is not for who has a seat.
            row = row | {"texts": row["texts"][-1:]}
        self._changes.add("advisory", row, audience=received.audience)

    def _event(self, received: Received) -> None:
        row = event_row(received.logged, received.message.model_dump(mode="json"))
        if row is None:
            return
        if (
            self._has_seats and "engine" in row
        ):  # It would tell participants which condition they have.
            row = row | {"engine": None}
        self._changes.add("event", row, audience=received.audience)

    def _latency(self, received: Received) -> None:
        if (bar := self._bars.bar(received.message)) is not None:
            # Bars name engines, and are thinned over all who send: no seat is told any.
            self._changes.add("latency", bar, audience=NOBODY)

    def _seat(self, received: Received) -> None:
        state: SeatState = received.message
        self._views.learn(state)

    def _own_position(self, received: Received) -> None:
        """Tell a driver where the own vehicle is; nobody else learns it from this."""
        shown: VehiclePosition = received.message
        heading_rad, speed_m_s = shown.heading_deg * DEGREE, shown.ground_speed_kt * KNOT
        self._views.own[shown.callsign].put(
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

    def _cockpit(self, received: Received) -> None:
        shown: CockpitInstruments = received.message
        self._views.own[shown.callsign].put(
            "cockpit", shown.model_dump(mode="json") | {"mode": readable(shown.mode)}
        )

    # --- cameras ----------------------------------------------------------------------------

    def _vision(self, received: Received) -> None:
        seen: Detections = received.message
        self._camera(seen.camera, seen.view, received.audience)
        if not seen.missed and self._locate is not None:
            self._changes.add(
                "picture",
                seen.camera,
                seen.seq,
                _seconds(seen.t_frame_ns),
                view_as_json(seen.view, self._locate),
                found_as_json(seen),
                audience=received.audience,
            )

    def _camera(self, name: str, view: CameraView, audience: Audience) -> None:
        if name not in self._cameras:
            self._cameras.add(name)
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


def _seconds(t_ns: int) -> float:
    return round(t_ns / SECOND_NS, 3)
