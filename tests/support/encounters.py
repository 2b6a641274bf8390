"""Encounters for the decision engine: straight flight, real transponders, seeded noise."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from geographiclib.geodesic import Geodesic

from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.relative_motion import relative
from airhilt.messages import Advisory, Briefing, Climb, MaintainLevel, VisibleClass
from airhilt.sim import Input
from airhilt.surveillance.receivers import Receiver
from airhilt.surveillance.transponders import Transponder
from airhilt.units import DEGREE, FOOT, KNOT, NAUTICAL_MILE, SECOND_NS
from airhilt.world.site import FixedSite
from decisions import reference, transcript
from projected import Body, Camera, Place

CENTRE = (38.9, -77.0)
FRAME = LocalFrame((CENTRE[0] * DEGREE, CENTRE[1] * DEGREE))
GROUND_M = 90.0
HALF_SECOND_NS = SECOND_NS // 2
CAPTURE_PER_S = 0.12
"""Rate at which an autopilot levels off, for each foot that is still to go."""


@dataclass(frozen=True)
class State(FixedSite):
    velocity_down_m_s: float = 0.0
    heading_rad: float = 0.0


@dataclass
class Flight:
    """Flies along a geodesic through a point near the centre, and climbs as told.

    ``distance_nm`` is how far before that point it begins; ``offset_nm`` how far the point lies to
    the right of the centre. Its level wavers by tens of feet, as in light turbulence.
    """

    callsign: str
    icao24: str
    track_deg: float
    distance_nm: float
    altitude_ft: float
    speed_kt: float = 480.0
    offset_nm: float = 0.0
    rate_fpm: float = 0.0
    target_ft: float | None = None
    seed: int = 1
    waver_ft: float = 15.0
    equipped: bool = True

    def __post_init__(self) -> None:
        self.transponder = Transponder(
            self.icao24, self.callsign, 9, 2, np.random.default_rng((self.seed, *self.name))
        )
        abeam = Geodesic.WGS84.Direct(
            *CENTRE, (self.track_deg + 90.0) % 360.0, self.offset_nm * NAUTICAL_MILE
        )
        self._line = Geodesic.WGS84.Line(abeam["lat2"], abeam["lon2"], self.track_deg)
        self._phase = self.transponder.generator.uniform(0.0, 2.0 * math.pi)

    @property
    def name(self) -> tuple[int, ...]:
        return tuple(self.callsign.encode())

    def climb(self, target_ft: float, rate_fpm: float) -> None:
        """Fly to a level from now on."""
        self.target_ft, self.rate_fpm = target_ft, rate_fpm

    def advance(self, step_s: float) -> None:
        self.altitude_ft += self._rate_ft_s() * step_s

    def _rate_ft_s(self) -> float:
        """Towards the target, ever slower just before it."""
        if self.target_ft is None:
            return 0.0
        to_go, most = self.target_ft - self.altitude_ft, self.rate_fpm / 60.0
        return max(-most, min(most, CAPTURE_PER_S * to_go))

    def state(self, time_s: float) -> State:
        flown = self.speed_kt * KNOT * time_s - self.distance_nm * NAUTICAL_MILE
        place = self._line.Position(flown)
        azimuth = place["azi2"] * DEGREE
        speed = self.speed_kt * KNOT
        angle = 2.0 * math.pi * time_s / 60.0 + self._phase
        rate = self._rate_ft_s() * FOOT
        rate += self.waver_ft * FOOT * math.cos(angle) * 2.0 * math.pi / 60.0
        return State(
            place["lat2"] * DEGREE,
            place["lon2"] * DEGREE,
            (self.altitude_ft + self.waver_ft * math.sin(angle)) * FOOT,
            speed * math.cos(azimuth),
            speed * math.sin(azimuth),
            velocity_down_m_s=-rate,
        )

    def place(self, time_s: float) -> tuple[Place, float]:
        """Return where it is above the ground, and its track (rad)."""
        state = self.state(time_s)
        east, north = FRAME.to_local((state.latitude_rad, state.longitude_rad))
        track = math.atan2(state.velocity_east_m_s, state.velocity_north_m_s)
        return (east, north, state.altitude_m - GROUND_M), track

    def body(self, label: VisibleClass, sizes: tuple[float, float, float]) -> Body:
        """Return what is to be seen of it."""
        return Body(label, *sizes, self.place)

    def nose(self, *bodies: Body, **how: Any) -> Camera:
        """Return a camera on its nose, while it rolls and pitches a little."""

        def look(time_s: float) -> tuple[Place, tuple[float, float, float]]:
            place, track = self.place(time_s)
            pitch = (3.0 + math.sin(time_s)) * DEGREE
            return place, (track, pitch, 3.0 * DEGREE * math.sin(0.7 * time_s))

        wide: dict[str, Any] = {"fov_deg": 25.0, "width_px": 1280, "height_px": 720} | how
        return Camera(f"nose_{self.callsign}", FRAME, look, list(bodies), self.callsign, **wide)


@dataclass
class Encounter:
    """Feeds what a receiver hears of some flights to a decision worker, twice a second."""

    flights: list[Flight]
    seconds: float
    worker: DecisionWorker = field(default_factory=reference)
    calls: list[tuple[float, float, str]] = field(default_factory=list)
    """When each call begins and ends, and its words."""
    told: list[tuple[float, Advisory]] = field(default_factory=list)
    obey: Callable[[Advisory], bool] = lambda _: False
    silent_after_s: float = math.inf
    """From when on no report is received."""
    late_s: float = 0.0
    """Time from when reports are received until they arrive."""
    least: dict[tuple[str, str], float] = field(default_factory=dict)
    """Least distance of each pair in units of 5 NM and 1000 ft."""
    cameras: list[Camera] = field(default_factory=list)
    minima: tuple[float, float] | None = None
    """Separation minima of the briefing, in NM and ft; None: there is no briefing."""

    def fly(self) -> Encounter:
        station = Receiver("all", State(CENTRE[0] * DEGREE, CENTRE[1] * DEGREE, 1e4), 1e6)
        begun = self._reports(station, 0, -2)  # an even and an odd position before the start
        assert not begun
        if self.minima is not None:
            self._step(0, [self._briefing(*self.minima)])
        underway: list[list[Input]] = [[] for _ in range(round(2 * self.late_s))]
        for step in range(round(2 * self.seconds)):
            t_ns = step * HALF_SECOND_NS
            heard = t_ns < self.silent_after_s * SECOND_NS
            underway.append(self._reports(station, t_ns, step) if heard else [])
            inputs = underway.pop(0) + self._transcripts(t_ns)
            for flight in self.flights:
                flight.advance(0.5)
            self._measure(t_ns)
            self._step(t_ns, inputs)
            seen = [
                item
                for camera in self.cameras
                for item in camera.inputs(t_ns, t_ns + HALF_SECOND_NS)
            ]
            for item in sorted(seen, key=lambda item: item.t_in_ns):
                self._step(item.t_in_ns, [item])
        return self

    def _step(self, t_ns: int, inputs: list[Input]) -> None:
        for output in self.worker.step(t_ns, inputs).outputs:
            advisory = Advisory.model_validate_json(output.payload)
            assert output.key == f"advisory/{advisory.recipient}"
            self.told.append((t_ns / SECOND_NS, advisory))
            self._follow(advisory)

    def _briefing(self, horizontal_nm: float, vertical_ft: float) -> Input:
        briefing = Briefing(
            t_ns=0, controller="Potomac Approach", horizontal_separation_nm=horizontal_nm,
            vertical_separation_ft=vertical_ft,
        )  # fmt: skip
        return Input("briefing", 0, briefing.model_dump_json().encode())

    def _reports(self, station: Receiver, t_ns: int, step: int) -> list[Input]:
        inputs = []
        for flight in self.flights:
            if not flight.equipped:
                continue
            state, sender = flight.state(t_ns / SECOND_NS), flight.transponder
            if step <= 0:
                station.decode(sender, sender.identification(), t_ns)
            station.decode(sender, sender.velocity(state), t_ns)
            decoded = station.decode(sender, sender.position(state, t_ns), t_ns)
            if decoded is not None:
                payload = decoded.report(t_ns).model_dump_json().encode()
                inputs.append(Input(f"adsb/{flight.icao24}", t_ns, payload))
        return inputs

    def _transcripts(self, t_ns: int) -> list[Input]:
        inputs = []
        for number, (begin_s, end_s, text) in enumerate(self.calls):
            if round(end_s * SECOND_NS) == t_ns:
                begin_ns = round(begin_s * SECOND_NS)
                heard = transcript(str(number), 134325, begin_ns, t_ns, text)
                inputs.append(Input("asr/134325", t_ns, heard.model_dump_json().encode()))
        return inputs

    def _measure(self, t_ns: int) -> None:
        states = {flight.callsign: flight.state(t_ns / SECOND_NS) for flight in self.flights}
        names = list(states)
        for index, one in enumerate(names):
            for other in names[index + 1 :]:
                horizontal = relative(states[one], states[other]).distance_m / (5 * NAUTICAL_MILE)
                vertical = abs(states[one].altitude_m - states[other].altitude_m) / (1000 * FOOT)
                pair = (one, other)
                ratio = max(horizontal, vertical)
                self.least[pair] = min(self.least.get(pair, math.inf), ratio)

    def _follow(self, advisory: Advisory) -> None:
        recommendation = advisory.recommendation
        if not advisory.active or not self.obey(advisory):
            return
        for flight in self.flights:
            if flight.callsign == advisory.recipient:
                match recommendation:
                    case Climb(altitude_ft=level, vertical_rate_fpm=rate):
                        flight.climb(level, rate)
                    case MaintainLevel(altitude_ft=level):
                        flight.climb(level, flight.rate_fpm or 1500.0)

    def to(self, recipient: str) -> list[Advisory]:
        """Return what one recipient was told."""
        return [advisory for _, advisory in self.told if advisory.recipient == recipient]

    def severities(self, recipient: str) -> list[str]:
        return [str(advisory.severity) for advisory in self.to(recipient) if advisory.active]


def head_on(seconds: float, seed: int = 1, **second: Any) -> Encounter:
    """Two at FL350, some 60 NM apart, that meet over the centre after 230 s."""
    other: dict[str, Any] = {
        "callsign": "DAL456", "icao24": "a4d5e6", "track_deg": 270.0, "distance_nm": 30.7,
        "altitude_ft": 35_000.0, "seed": seed,
    }  # fmt: skip
    flights = [
        Flight("AAL123", "a1b2c3", 90.0, 30.7, 35_000, seed=seed),
        Flight(**(other | second)),
    ]
    return Encounter(flights, seconds)
