"""An airfield with two runways that cross, and traffic on it with real transponders."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np

from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.messages import (
    Advisory,
    AirportBriefing,
    Briefing,
    RosterEntry,
    RunwayBriefing,
    Severity,
    TransmissionOpened,
    VisibleClass,
)
from airhilt.sim import Input
from airhilt.surveillance.receivers import Receiver
from airhilt.surveillance.squitters import PositionSquitter, SurfacePositionSquitter
from airhilt.surveillance.transponders import Transponder
from airhilt.units import DEGREE, FOOT, SECOND_NS
from airhilt.world.site import FixedSite
from decisions import reference, transcript
from projected import Body, Camera

FIELD = LocalFrame((38.85 * DEGREE, -77.04 * DEGREE))
ELEVATION_M = 5.0
HOLD_M = 76.0
WIDTH_M = 45.0
HALF_SECOND_NS = SECOND_NS // 2


@dataclass(frozen=True)
class Axis:
    """One direction of a runway: metres along it and to the right of it, from its threshold."""

    ident: str
    east_m: float
    north_m: float
    course_deg: float
    length_m: float

    def local(self, along_m: float, across_m: float) -> tuple[float, float]:
        sin, cos = math.sin(self.course_deg * DEGREE), math.cos(self.course_deg * DEGREE)
        return (
            self.east_m + along_m * sin + across_m * cos,
            self.north_m + along_m * cos - across_m * sin,
        )

    def back(self, ident: str) -> Axis:
        end = self.local(self.length_m, 0.0)
        return Axis(ident, *end, self.course_deg + 180.0, self.length_m)


NORTH = Axis("01", 0.0, -1000.0, 4.0, 2100.0)
SOUTH = NORTH.back("19")
SOUTHEAST = Axis("15", -500.0, 1100.0, 149.0, 1700.0)
NORTHWEST = SOUTHEAST.back("33")


def degrees(local: tuple[float, float]) -> tuple[float, float]:
    latitude, longitude = FIELD.to_place(*local)
    return latitude / DEGREE, longitude / DEGREE


def charted(axis: Axis) -> RunwayBriefing:
    corners = [(-60.0, -HOLD_M), (-60.0, HOLD_M)]
    corners += [(axis.length_m + 60.0, HOLD_M), (axis.length_m + 60.0, -HOLD_M)]
    return RunwayBriefing(
        ident=axis.ident,
        threshold=degrees(axis.local(0.0, 0.0)),
        end=degrees(axis.local(axis.length_m, 0.0)),
        elevation_ft=ELEVATION_M / FOOT,
        width_m=WIDTH_M,
        protected_area=tuple(degrees(axis.local(*corner)) for corner in corners),
    )


BRIEFING = Briefing(
    controller="Tower",
    horizontal_separation_nm=3.0,
    vertical_separation_ft=1000.0,
    roster=(
        RosterEntry(callsign="AAL123", category="aircraft", type="B737"),
        RosterEntry(callsign="DAL456", category="aircraft", type="B737"),
        RosterEntry(callsign="OPS1", category="vehicle", type="follow_me"),
    ),
    airport=AirportBriefing(
        icao="XFLD",
        elevation_ft=ELEVATION_M / FOOT,
        runways=tuple(charted(axis) for axis in (NORTH, SOUTH, SOUTHEAST, NORTHWEST)),
    ),
)

Spot = tuple[float, float, float | None]
"""Along, across, and height above the field; None on the ground."""


@dataclass(frozen=True)
class State(FixedSite):
    velocity_down_m_s: float = 0.0
    heading_rad: float = 0.0


@dataclass
class Mover:
    """Somebody whose place on an axis is a function of time."""

    callsign: str
    axis: Axis
    spot: Callable[[float], Spot]
    heading_deg: float | None = None
    """While it stands, relative to the axis."""
    category: str = "A3"
    seed: int = 1
    nacp: int = 9
    equipped: bool = True

    def __post_init__(self) -> None:
        self.icao24 = f"{sum(256**i * b for i, b in enumerate(self.callsign.encode()[-3:])):06x}"
        generator = np.random.default_rng((self.seed, *self.callsign.encode()))
        self.transponder = Transponder(
            self.icao24, self.callsign, self.nacp, 2, generator, cast(Any, self.category)
        )
        self._heading_rad = ((self.heading_deg or 0.0) + self.axis.course_deg) * DEGREE

    def body(self, label: VisibleClass, sizes: tuple[float, float, float]) -> Body:
        """Return what is to be seen of it."""

        def at(t_s: float) -> tuple[tuple[float, float, float], float]:
            along, across, height = self.spot(t_s)
            state = self.state(t_s)
            return (*self.axis.local(along, across), height or 0.0), state.heading_rad

        return Body(label, *sizes, at)

    def is_on_ground(self, t_s: float) -> bool:
        return self.spot(t_s)[2] is None

    def state(self, t_s: float) -> State:
        along, across, height = self.spot(t_s)
        before = self.spot(t_s - 0.1)
        east, north = self.axis.local(along, across)
        was_east, was_north = self.axis.local(before[0], before[1])
        v_east, v_north = (east - was_east) / 0.1, (north - was_north) / 0.1
        if math.hypot(v_east, v_north) > 0.2:
            self._heading_rad = math.atan2(v_east, v_north)
        latitude, longitude = FIELD.to_place(east, north)
        return State(
            latitude, longitude, ELEVATION_M + (height or 0.0), v_north, v_east,
            ((before[2] or 0.0) - (height or 0.0)) / 0.1, self._heading_rad,
        )  # fmt: skip


# --- what they do ---------------------------------------------------------------------------

APPROACH_M_S = 70.0
TOUCHDOWN_M = 400.0
EXIT_M = 1700.0
TAXI_M_S = 8.0


def lands(
    at_s: float, leaves_at_m: float = EXIT_M, stops_at_m: float | None = None
) -> Callable[[float], Spot]:
    """Cross the threshold at a time, land, and turn off to the left, or stop on the runway."""
    braking = 1.8
    down_s = at_s + TOUCHDOWN_M / APPROACH_M_S
    slow_s = down_s + (APPROACH_M_S - TAXI_M_S) / braking
    slow_m = TOUCHDOWN_M + (APPROACH_M_S**2 - TAXI_M_S**2) / (2.0 * braking)

    def spot(t_s: float) -> Spot:
        if t_s < down_s:
            along = (t_s - at_s) * APPROACH_M_S
            return along, 0.0, (TOUCHDOWN_M - along) * math.tan(3.0 * DEGREE)
        if t_s < slow_s:
            rolled = t_s - down_s
            return TOUCHDOWN_M + APPROACH_M_S * rolled - braking * rolled**2 / 2.0, 0.0, None
        along = slow_m + (t_s - slow_s) * TAXI_M_S
        if stops_at_m is not None:
            return min(along, max(stops_at_m, slow_m)), 0.0, None
        off_m = max(slow_m, leaves_at_m)
        return min(along, off_m), -min(max(along - off_m, 0.0), 130.0), None

    return spot


def goes_around(at_s: float, from_m: float) -> Callable[[float], Spot]:
    """Fly the approach of `lands`, and climb from a distance before the threshold."""

    def spot(t_s: float) -> Spot:
        along = (t_s - at_s) * APPROACH_M_S
        height = (TOUCHDOWN_M - along) * math.tan(3.0 * DEGREE)
        if along > -from_m:
            height = (TOUCHDOWN_M + from_m) * math.tan(3.0 * DEGREE) + (along + from_m) * 0.13
        return along, 0.0, height

    return spot


def takes_off(rolls_at_s: float, along_m: float = 50.0) -> Callable[[float], Spot]:
    """Stand lined up, and roll from a time on."""
    faster, lift_off, climb = 2.0, 75.0, 10.0

    def spot(t_s: float) -> Spot:
        rolled = max(t_s - rolls_at_s, 0.0)
        if rolled < lift_off / faster:
            return along_m + faster * rolled**2 / 2.0, 0.0, None
        flown = rolled - lift_off / faster
        return along_m + lift_off**2 / (2.0 * faster) + lift_off * flown, 0.0, climb * flown

    return spot


def lines_up_and_goes(enters_at_s: float, rolls_at_s: float) -> Callable[[float], Spot]:
    """Hold short, taxi to the centre line at the threshold, wait, and take off."""
    roll = takes_off(rolls_at_s)

    def spot(t_s: float) -> Spot:
        across = min(-100.0 + 6.0 * max(t_s - enters_at_s, 0.0), 0.0)
        if across < 0.0:
            return 40.0, across, None
        return (
            roll(t_s)
            if t_s > enters_at_s + 25.0
            else (40.0 + (t_s > enters_at_s + 19.0), 0.0, None)
        )

    return spot


def stands(along_m: float, across_m: float = 0.0) -> Callable[[float], Spot]:
    """Stand on the ground."""
    return lambda _: (along_m, across_m, None)


def drives(
    starts_at_s: float,
    along_m: float = 800.0,
    from_m: float = -250.0,
    to_m: float = 250.0,
    speed_m_s: float = TAXI_M_S,
    braking: float = 3.0,
) -> Callable[[float], Spot]:
    """Drive across the axis from a time on, and brake to stop at ``to_m``."""
    stop_m = speed_m_s**2 / (2.0 * braking)
    brake_s = starts_at_s + (to_m - from_m - stop_m) / speed_m_s

    def spot(t_s: float) -> Spot:
        driven = max(min(t_s, brake_s) - starts_at_s, 0.0) * speed_m_s
        braked = min(max(t_s - brake_s, 0.0), speed_m_s / braking)
        return along_m, from_m + driven + speed_m_s * braked - braking * braked**2 / 2.0, None

    return spot


# --- what the worker makes of it ------------------------------------------------------------


@dataclass
class Airfield:
    """Feeds what a receiver on the field hears of some movers, and calls, to a worker."""

    movers: list[Mover]
    calls: list[tuple[float, str]] = field(default_factory=list)
    """When each call ends, and its words; one with a question mark is unsure."""
    worker: DecisionWorker = field(default_factory=reference)
    told: list[tuple[float, Advisory]] = field(default_factory=list)
    cameras: list[Camera] = field(default_factory=list)
    briefing: Briefing = BRIEFING
    openings_are_heard: bool = False
    """True if the worker is told when a transmission begins, 3 s before its end."""
    recognition_s: float = 0.0
    """Time from the end of a call to its words."""

    def run(self, seconds: float) -> Airfield:
        station = Receiver("field", State(*FIELD.origin, 20.0), 1e6, ground_m=ELEVATION_M)
        self._step(0, [Input("briefing", 0, self.briefing.model_dump_json().encode())])
        for step in range(round(2 * seconds)):
            t_ns = step * HALF_SECOND_NS
            inputs = [
                made
                for mover in self.movers
                if mover.equipped
                for made in self._report(station, mover, t_ns, step)
            ]
            self._step(t_ns, inputs + self._openings(t_ns) + self._transcripts(t_ns))
            seen = [
                item
                for camera in self.cameras
                for item in camera.inputs(t_ns, t_ns + HALF_SECOND_NS)
            ]
            for item in sorted(seen, key=lambda item: item.t_in_ns):
                self._step(item.t_in_ns, [item])
        return self

    def _report(self, station: Receiver, mover: Mover, t_ns: int, step: int) -> list[Input]:
        sender, state = mover.transponder, mover.state(t_ns / SECOND_NS)
        speed = math.hypot(state.velocity_north_m_s, state.velocity_east_m_s)
        grounded = mover.is_on_ground(t_ns / SECOND_NS)
        if grounded and speed < 0.1 and step > 4 and step % 10:
            return []
        if step < 3:
            station.decode(sender, sender.identification(), t_ns)
        squitter: SurfacePositionSquitter | PositionSquitter
        if grounded:
            squitter = sender.surface_position(state, t_ns)
        else:
            station.decode(sender, sender.velocity(state), t_ns)
            squitter = sender.position(state, t_ns)
        decoded = station.decode(sender, squitter, t_ns)
        if decoded is None:
            return []
        payload = decoded.report(t_ns).model_dump_json().encode()
        return [Input(f"adsb/{mover.icao24}", t_ns, payload)]

    def _openings(self, t_ns: int) -> list[Input]:
        return [
            Input(
                "radio/119100/audio", t_ns, b"",
                TransmissionOpened(
                    id=str(number), frequency_khz=119100, t_tx_ns=t_ns
                ).model_dump(mode="json"),
            )
            for number, (end_s, _) in enumerate(self.calls)
            if self.openings_are_heard and round((end_s - 3.0) * SECOND_NS) == t_ns
        ]  # fmt: skip

    def _transcripts(self, t_ns: int) -> list[Input]:
        inputs = []
        for number, (end_s, text) in enumerate(self.calls):
            if round((end_s + self.recognition_s) * SECOND_NS) == t_ns:
                end_ns = round(end_s * SECOND_NS)
                heard = transcript(str(number), 119100, end_ns - 3 * SECOND_NS, end_ns, text)
                inputs.append(Input("asr/119100", t_ns, heard.model_dump_json().encode()))
        return inputs

    def _step(self, t_ns: int, inputs: list[Input]) -> None:
        for output in self.worker.step(t_ns, inputs).outputs:
            advisory = Advisory.model_validate_json(output.payload)
            assert output.key == f"advisory/{advisory.recipient}"
            self.told.append((t_ns / SECOND_NS, advisory))

    def to(self, recipient: str) -> list[Advisory]:
        return [advisory for _, advisory in self.told if advisory.recipient == recipient]

    def first(self, severity: str, kind: str = "runway_conflict") -> tuple[float, Advisory]:
        """Return when the controller was first told of that severity, and what."""
        return next(
            (t_s, advisory)
            for t_s, advisory in self.told
            if advisory.recipient == "ATC"
            and advisory.severity == severity
            and advisory.kind == kind
        )

    def advice(self, recipient: str) -> list[tuple[str, str]]:
        """Return what somebody was recommended, and for which runway."""
        return [
            (advisory.recommendation.action, getattr(advisory.recommendation, "runway", ""))
            for advisory in self.to(recipient)
            if advisory.recommendation is not None
        ]

    @property
    def worst(self) -> Severity:
        """The highest severity that was told."""
        return max(
            (advisory.severity for _, advisory in self.told if advisory.active),
            key=lambda severity: severity.rank,
            default=Severity.INFO,
        )
