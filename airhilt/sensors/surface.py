"""Surface surveillance in a run: one track a second for each target at the airport.

Everything that the surface movement radar or multilateration detects is measured at the same
instant, once a second, and published one latency later. A target has one track number until it is
lost. Only a transponder gives a track a name: a truck without one is a position.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from airhilt.geodesy.wgs84 import Place, displaced, distance_m
from airhilt.messages import Message, PlotKind, SurfaceTrack
from airhilt.scenario.models import SurfaceSurveillance, WildlifeSpec
from airhilt.sensors.base import Sensor, SensorContext
from airhilt.sensors.radar import cross_section_m2, plot_kind
from airhilt.sim import Priority
from airhilt.sim.streams import stream
from airhilt.surveillance import surface
from airhilt.surveillance.squitters import ALTITUDE_STEP_FT, quantise
from airhilt.surveillance.transponders import STANDING_BELOW_M_S
from airhilt.units import DEGREE, FOOT, KNOT, bearing_degrees, seconds_to_ns
from airhilt.world.actors.actor import Actor
from airhilt.world.mover import Motion

SPEED_STEP_KT = 0.1
"""Resolution of a track's speed, in kt."""


class SurfaceType:
    """Surface surveillance, if the scenario has it or a worker subscribes to its tracks."""

    name = "surface"
    messages: Mapping[str, type[Message]] = {"surface/{airport}": SurfaceTrack}

    def create(self, context: SensorContext) -> SurfaceSensor | None:
        """Return the sensor of a run; None if nobody asks for it, or there is no airport."""
        declared = context.scenario.surface_surveillance
        is_wanted = declared is not None or self.name in context.subscribed
        if context.site.layout is None or not is_wanted:
            return None
        return SurfaceSensor(context, declared or SurfaceSurveillance())


SENSOR = SurfaceType()


@dataclass
class _Target:
    """An actor as surface surveillance meets it, second by second."""

    actor: Actor
    cross_section_m2: float
    generator: np.random.Generator
    track: int = 0
    """Track number; 0 before the first detection."""
    detected_ns: int = 0
    is_named: bool = False
    """True if the transponder has given the track a name."""
    errors: np.ndarray = field(init=False)
    """North and east error of the position, then of the velocity, in standard deviations."""

    def __post_init__(self) -> None:
        self.errors = self.generator.standard_normal(4)

    def drift(self) -> None:
        """Let the errors change as they do from one second to the next."""
        kept = surface.KEPT_CORRELATION
        fresh = self.generator.standard_normal(4)
        self.errors = kept * self.errors + math.sqrt(1.0 - kept * kept) * fresh

    @property
    def has_transponder(self) -> bool:
        """True if multilateration can locate it."""
        spec = self.actor.spec
        return not isinstance(spec, WildlifeSpec) and spec.transponder.equipped


class SurfaceSensor(Sensor):
    """Measures all targets once a second, and publishes their tracks."""

    def __init__(self, context: SensorContext, declared: SurfaceSurveillance) -> None:
        layout = context.site.airport
        self._director = context.director
        self._publish = context.publish
        self._state_of = context.state_of
        self._airport = layout.airport.icao
        self._declared = declared
        self._numbers = itertools.count(1)
        self._places: list[Place] = [context.site.place(context.site.centre)]
        self._places += [end.start for strip in layout.strips.values() for end in strip.ends]
        self._targets = [
            _Target(
                actor,
                cross_section_m2(actor),
                stream(context.seed, f"surface/{self._airport}/{callsign}"),
            )
            for callsign, actor in context.actors.items()
        ]

    def start(self) -> None:
        """Measure now, and then every second."""
        self._director.every(surface.PERIOD_NS, self._measure, Priority.SENSOR)

    def _measure(self) -> None:
        """Measure all targets, and publish the tracks when they are ready."""
        now_ns = self._director.now_ns
        tracks = [
            track
            for target in self._targets
            if target.actor.body.ended is None
            and (track := self._track(target, self._state_of(target.actor.body), now_ns))
        ]
        out_ns = now_ns + surface.LATENCY_NS

        def publish() -> None:
            for track in tracks:
                stamped = track.model_copy(update={"t_ns": out_ns})
                self._publish(f"surface/{self._airport}", stamped)

        self._director.at(out_ns, publish, Priority.RESULT)

    def _track(self, target: _Target, state: Motion, now_ns: int) -> SurfaceTrack | None:
        """Return the track of a target; None if it is not detected.

        All random numbers are drawn each time, so that no detection changes the draws after it.
        """
        kind = self._detected(target, state, now_ns)
        target.drift()
        if kind is None:
            return None
        if target.track == 0 or now_ns - target.detected_ns > surface.LOST_AFTER_NS:
            target.track, target.is_named = next(self._numbers), False
        target.detected_ns = now_ns
        target.is_named = target.is_named or kind != "primary"
        return self._fused(target, state, kind, now_ns)

    def _detected(self, target: _Target, state: Motion, now_ns: int) -> PlotKind | None:
        """Return by what a target is detected; None if it is not."""
        echo, reply, lost = target.generator.random(3)
        is_out = any(
            seconds_to_ns(begin) <= now_ns < seconds_to_ns(end)
            for begin, end in self._declared.outages_s
        )
        if lost < self._declared.loss_probability or is_out:
            return None
        away_m = min(
            distance_m((state.latitude_rad, state.longitude_rad), place) for place in self._places
        )
        height_m = state.height_agl_m
        has_echo = (
            target.cross_section_m2 >= surface.LEAST_CROSS_SECTION_M2
            and away_m <= surface.RADAR_RANGE_M
            and height_m <= surface.RADAR_HEIGHT_M
            and echo < surface.RADAR_PROBABILITY
        )
        has_reply = (
            target.has_transponder
            and away_m <= surface.TRANSPONDER_RANGE_M
            and height_m <= surface.TRANSPONDER_HEIGHT_M
            and reply < surface.TRANSPONDER_PROBABILITY
        )
        return plot_kind(has_echo, has_reply) if has_echo or has_reply else None

    def _fused(self, target: _Target, state: Motion, kind: PlotKind, now_ns: int) -> SurfaceTrack:
        """Return the track of a detected target, with its errors."""
        spec, on_ground = target.actor.spec, target.actor.body.on_ground
        is_named = target.is_named
        error_m = surface.SURFACE_95_PERCENT_M if on_ground else surface.APPROACH_95_PERCENT_M
        north, east, faster_north, faster_east = target.errors
        latitude, longitude = displaced(
            (state.latitude_rad, state.longitude_rad),
            north * surface.sigma(error_m),
            east * surface.sigma(error_m),
            state.altitude_m,
        )
        stands = state.ground_speed_m_s <= STANDING_BELOW_M_S
        error_m_s = surface.sigma(surface.SPEED_95_PERCENT_M_S)
        velocity = (
            state.velocity_north_m_s + faster_north * error_m_s,
            state.velocity_east_m_s + faster_east * error_m_s,
        )
        speed_kt = quantise(math.hypot(*velocity) / KNOT, SPEED_STEP_KT)
        return SurfaceTrack(
            airport=self._airport,
            track=target.track,
            kind=kind,
            t_track_ns=now_ns,
            latitude_deg=latitude / DEGREE,
            longitude_deg=longitude / DEGREE,
            accuracy_m=error_m,
            altitude_ft=(
                quantise(state.altitude_m / FOOT, ALTITUDE_STEP_FT)
                if is_named and not on_ground
                else None
            ),
            on_ground=on_ground if is_named else None,
            ground_speed_kt=0.0 if stands else speed_kt,
            track_deg=(None if stands else bearing_degrees(math.atan2(velocity[1], velocity[0]))),
            icao24=spec.icao24 if is_named and not isinstance(spec, WildlifeSpec) else None,
            callsign=spec.callsign if is_named else None,
        )
