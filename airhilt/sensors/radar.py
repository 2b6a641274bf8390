"""Surveillance radar in a run: antennas that turn, and the plots that they give.

An antenna turns steadily, from an azimuth that is drawn for each site. A turn has 32 sectors. At
the end of each, the radar measures every target that the beam has passed in it, each at the instant
of passing, and publishes the plots in the order of these instants. A plot does not say what it is
of.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from airhilt.messages import Message, PlotKind, RadarInfo, RadarPlot
from airhilt.scenario.models import AircraftSpec, Radar
from airhilt.sensors.base import Sensor, SensorContext, SensorGroup
from airhilt.sim import Priority
from airhilt.sim.streams import stream
from airhilt.surveillance.horizon import radio_horizon_m
from airhilt.surveillance.radar import (
    AIRCRAFT_CROSS_SECTION_M2,
    AZIMUTH_STEP_DEG,
    MAXIMUM_ELEVATION_RAD,
    MODE_A_PROBABILITY,
    MODE_C_PROBABILITY,
    PRIMARY_ACCURACY,
    RADARS,
    RANGE_STEP_M,
    SECONDARY_ACCURACY,
    SECONDARY_PROBABILITY,
    Antenna,
    LineOfSight,
    mode_c_ft,
)
from airhilt.surveillance.squitters import quantise
from airhilt.units import DEGREE, FOOT, SECOND_NS, seconds_to_ns
from airhilt.world.actors.actor import Actor
from airhilt.world.mover import Motion, carried_on
from airhilt.world.surface.kinds import load_kind

SECTORS = 32
"""Sectors of a turn, at whose ends plots are published (EUROCONTROL ASTERIX category 034)."""


class RadarType:
    """The surveillance radars of a scenario."""

    name = "radar"
    messages: Mapping[str, type[Message]] = {
        "radar/{site}/info": RadarInfo,
        "radar/{site}": RadarPlot,
    }

    def create(self, context: SensorContext) -> SensorGroup | None:
        """Return the radars of a run; None if the scenario has none."""
        radars = [TurningRadar(declared, context) for declared in context.scenario.radars]
        return SensorGroup(radars) if radars else None


SENSOR = RadarType()


@dataclass
class _Target:
    """An actor as one radar meets it, turn by turn."""

    actor: Actor
    cross_section_m2: float
    generator: np.random.Generator
    behind_rad: float | None = None
    """Angle by which the beam was past the target at the end of the last sector."""


class TurningRadar(Sensor):
    """One radar: turns its antenna and publishes its plots."""

    def __init__(self, declared: Radar, context: SensorContext) -> None:
        self._site = declared.name
        self._kind = declared.kind
        self._model = RADARS[declared.kind]
        self._director = context.director
        self._state_of = context.state_of
        self._publish = context.publish
        self._ground_m = context.site.ground_m
        self._antenna_height_m = declared.antenna_height_ft * FOOT
        self._antenna = Antenna(
            *context.site.place(declared.position), self._ground_m + self._antenna_height_m
        )
        self._first_azimuth_rad = stream(context.seed, f"radar/{self._site}").uniform(0.0, math.tau)
        self._targets = [
            _Target(
                actor,
                cross_section_m2(actor),
                stream(context.seed, f"radar/{self._site}/{callsign}"),
            )
            for callsign, actor in context.actors.items()
        ]

    def start(self) -> None:
        """Publish what never changes, and turn the antenna."""
        model, antenna = self._model, self._antenna
        self._publish(
            f"radar/{self._site}/info",
            RadarInfo(
                t_ns=self._director.now_ns,
                site=self._site,
                kind=self._kind,
                latitude_deg=antenna.latitude_rad / DEGREE,
                longitude_deg=antenna.longitude_rad / DEGREE,
                altitude_m=antenna.altitude_m,
                rotation_s=model.rotation_s,
                primary_range_m=model.primary_range_m,
                secondary_range_m=model.secondary_range_m,
            ),
        )
        sector_ns = seconds_to_ns(model.rotation_s / SECTORS)
        self._director.every(sector_ns, self._sweep, Priority.SENSOR)

    def _sweep(self) -> None:
        """Measure the targets that the beam has passed in the sector that ends now."""
        now_ns = self._director.now_ns
        beam_rad = self._first_azimuth_rad + math.tau * (
            now_ns / SECOND_NS / self._model.rotation_s
        )
        plots = []
        for target in self._targets:
            body = target.actor.body
            if body.ended is not None:
                continue
            azimuth_rad = self._antenna.to(self._state_of(body)).azimuth_rad
            behind_rad = (beam_rad - azimuth_rad) % math.tau
            before_rad, target.behind_rad = target.behind_rad, behind_rad
            if before_rad is None or behind_rad > before_rad - math.pi:
                continue
            passed_s = behind_rad / math.tau * self._model.rotation_s
            state = self._state_of(body, passed_s)
            plot = self._measure(target, state, now_ns - seconds_to_ns(passed_s))
            if plot is not None:
                plots.append(plot)
        for plot in sorted(plots, key=lambda plot: plot.t_plot_ns):
            self._publish(f"radar/{self._site}", plot)

    def _measure(self, target: _Target, state: Motion, t_plot_ns: int) -> RadarPlot | None:
        """Return the plot of a target at an instant; None if it is not detected.

        All random numbers are drawn each time, so that no detection changes the draws after it.
        """
        model, draw = self._model, target.generator
        echo, reply, mode_a_valid, mode_c_valid = draw.random(4)
        range_error, azimuth_error = draw.standard_normal(2)
        line = self._antenna.to(state)
        if not self._in_view(target, state, line):
            return None
        has_echo = self._returns_echo(state, line) and (
            echo < model.detection_probability(target.cross_section_m2, line.range_m)
        )
        squawk = target.actor.squawk
        has_reply = (
            squawk is not None
            and not target.actor.body.on_ground
            and line.range_m <= model.secondary_range_m
            and reply < SECONDARY_PROBABILITY
        )
        if not (has_echo or has_reply):
            return None
        accuracy = SECONDARY_ACCURACY if has_reply else PRIMARY_ACCURACY
        return RadarPlot(
            t_ns=self._director.now_ns,
            site=self._site,
            kind=plot_kind(has_echo, has_reply),
            t_plot_ns=t_plot_ns,
            range_m=quantise(line.range_m + accuracy.range_m * range_error, RANGE_STEP_M),
            azimuth_deg=quantise(
                line.azimuth_rad / DEGREE + accuracy.azimuth_deg * azimuth_error, AZIMUTH_STEP_DEG
            )
            % 360.0,
            mode_a=squawk if has_reply and mode_a_valid < MODE_A_PROBABILITY else None,
            mode_c_ft=(
                mode_c_ft(state.altitude_m)
                if has_reply and mode_c_valid < MODE_C_PROBABILITY
                else None
            ),
        )

    def _in_view(self, target: _Target, state: Motion, line: LineOfSight) -> bool:
        """Return whether a target is above the horizon, outside the cone of silence, and not near.

        The middle of a target on the ground must be above the horizon.
        """
        model = self._model
        height_m = max(
            state.altitude_m - self._ground_m, 0.5 * target.actor.body.dimensions.height_m
        )
        return (
            line.range_m >= model.minimum_range_m
            and line.elevation_rad <= MAXIMUM_ELEVATION_RAD
            and line.horizontal_m <= radio_horizon_m(self._antenna_height_m, height_m)
        )

    def _returns_echo(self, state: Motion, line: LineOfSight) -> bool:
        """Return whether a target is in primary range and stands out from the ground.

        Where the antenna sees the ground, what hardly moves towards it or away is taken for ground.
        """
        if line.range_m > self._model.primary_range_m:
            return False
        if line.horizontal_m > radio_horizon_m(self._antenna_height_m):
            return True
        second_later = self._antenna.to(carried_on(state, 1.0))
        return abs(second_later.range_m - line.range_m) >= self._model.clutter_speed_m_s


def cross_section_m2(actor: Actor) -> float:
    """Return the radar cross section of an actor, in square metres."""
    if isinstance(actor.spec, AircraftSpec):
        return AIRCRAFT_CROSS_SECTION_M2[actor.emitter_category]
    return load_kind(actor.spec.kind).radar_cross_section_m2


def plot_kind(has_echo: bool, has_reply: bool) -> PlotKind:
    """Return the kind of a detection by an echo, a reply, or both."""
    if has_echo and has_reply:
        return "combined"
    return "secondary" if has_reply else "primary"
