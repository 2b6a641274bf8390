"""ADS-B in a run: when transponders squitter, and when a report leaves the receiver.

Every actor with a transponder squitters its position, its velocity and its identification, each at
its own random intervals. The receivers of the scenario hear some of it; a report leaves one
receiver latency after the squitter that completes it.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from functools import partial

from airhilt.geodesy.positions import RelativePosition
from airhilt.messages import AdsbReport, DeclaredLatency, Message
from airhilt.scenario.models import (
    AdsbReceiver,
    AircraftSpec,
    Scenario,
    VehicleSpec,
    WildlifeSpec,
)
from airhilt.sensors.base import Sensor, SensorContext
from airhilt.sim import Priority, StepRecord
from airhilt.sim.streams import stream
from airhilt.surveillance.receivers import Decoded, Receiver
from airhilt.surveillance.squitters import Squitter
from airhilt.surveillance.transponders import (
    IDENTIFICATION_INTERVAL_S,
    POSITION_INTERVAL_S,
    STATIONARY_IDENTIFICATION_INTERVAL_S,
    STATIONARY_POSITION_INTERVAL_S,
    VELOCITY_INTERVAL_S,
    SurfaceRate,
    Transponder,
)
from airhilt.units import FOOT, NAUTICAL_MILE, SECOND_NS, seconds_to_ns
from airhilt.world.actors.actor import Actor
from airhilt.world.mover import Motion, goes_on
from airhilt.world.site import FixedSite, ScenarioSite

STAGE = "adsb"
"""Name of the receivers in the latency log."""
DECLARED_LATENCY = DeclaredLatency(median_s=0.05, sigma=0.3)
"""Latency of a receiver from the end of a squitter to its report, where it is not measured."""
LOOK_NS = SECOND_NS // 2
"""Period at which a transponder that stands checks for movement, or one to come if it is there, in
ns."""


class AdsbType:
    """The ADS-B receivers of a scenario; they are there if any actor has a transponder."""

    name = "adsb"
    messages: Mapping[str, type[Message]] = {"adsb/{icao24}": AdsbReport}

    def create(self, context: SensorContext) -> AdsbSensor | None:
        """Return the sensor of a run; None if no actor has a transponder."""
        sensor = AdsbSensor(context)
        return sensor if sensor.sources else None


SENSOR = AdsbType()


class AdsbSensor(Sensor):
    """Schedules the squitters of all transponders, and publishes what the receivers report."""

    def __init__(self, context: SensorContext) -> None:
        scenario = context.scenario
        self._director = context.director
        self._state_of = context.state_of
        self._publish = context.publish
        self._done = context.step_done
        self._latency = context.latency.of(STAGE).source(
            STAGE, context.seed, DECLARED_LATENCY.median_s, DECLARED_LATENCY.sigma
        )
        self._seq = 0
        self._in_flight: dict[int, StepRecord] = {}
        self._receivers = [_receiver(declared, context.site) for declared in _declared(scenario)]
        self._loss_probability = scenario.adsb.loss_probability
        self._outages_ns = [
            (seconds_to_ns(begin), seconds_to_ns(end)) for begin, end in scenario.adsb.outages_s
        ]
        self.sources = [
            _Source(actor, spec, context.seed)
            for actor in context.actors.values()
            if not isinstance(spec := actor.spec, WildlifeSpec) and spec.transponder.has_adsb
        ]

    def start(self) -> None:
        """Schedule the first squitters of all transponders."""
        for source in self.sources:
            for squitter, (within_s, _) in (
                (source.position, POSITION_INTERVAL_S),
                (source.velocity, VELOCITY_INTERVAL_S),
                (source.identification, IDENTIFICATION_INTERVAL_S),
            ):
                self._repeat(source, squitter, source.first_ns(within_s))

    def unfinished(self) -> list[StepRecord]:
        """Return the latency records of reports that are still in a receiver."""
        return [step._replace(outputs=0, finished=False) for step in self._in_flight.values()]

    def _repeat(self, source: _Source, squitter: _Squitterer, first_ns: int) -> None:
        """Call ``squitter`` at a time, then each time after the wait it returns, until the end."""
        call = partial(self._squit, source, squitter)
        self._director.at(first_ns, call, Priority.SENSOR)

    def _squit(self, source: _Source, squitter: _Squitterer) -> None:
        body = source.actor.body
        if not goes_on(body):
            return
        if body.ended is not None:
            self._repeat(source, squitter, self._director.now_ns + LOOK_NS)
            return
        source.transponder.squawk = source.actor.squawk
        source.transponder.emergency = source.actor.emergency
        now_ns = self._director.now_ns
        send = partial(self._receive, source.transponder)
        wait_ns = squitter(self._state_of(body), now_ns, send)
        self._repeat(source, squitter, now_ns + wait_ns)

    def _receive(self, sender: Transponder, squitter: Squitter, state: Motion) -> None:
        now_ns, begun = self._director.now_ns, time.perf_counter()
        decoded = self._decoded(sender, squitter, state, now_ns)
        compute_s = time.perf_counter() - begun
        if decoded is None:
            return
        known_ns = self._latency.known_ns(self._seq)
        if known_ns is None:
            known_ns = self._latency.settled_ns(compute_s, 1)
        out_ns = now_ns + known_ns
        step = StepRecord(STAGE, self._seq, now_ns, now_ns, known_ns, compute_s, 1)
        self._in_flight[self._seq] = step
        self._seq += 1

        def leave() -> None:
            self._done(step)
            del self._in_flight[step.seq]
            self._publish(f"adsb/{sender.icao24}", decoded.report(out_ns))

        self._director.at(out_ns, leave, Priority.RESULT)

    def _decoded(
        self, sender: Transponder, squitter: Squitter, state: Motion, t_ns: int
    ) -> Decoded | None:
        """Return the state vector that the first receiver in view of the sender completes.

        The draws do not depend on what is received, so an outage changes nothing after it.
        """
        is_lost = sender.generator.random() < self._loss_probability
        if is_lost or any(begin <= t_ns < end for begin, end in self._outages_ns):
            return None
        in_view = (receiver for receiver in self._receivers if receiver.in_view(state))
        receiver = next(in_view, None)
        return None if receiver is None else receiver.decode(sender, squitter, t_ns)


_Send = Callable[[Squitter, Motion], None]
"""Sends a squitter; the loss on the way is drawn from the transponder's own generator."""
_Squitterer = Callable[[Motion, int, _Send], int]
"""Sends a squitter for a state at a time (ns), and returns the wait until the next one (ns)."""


class _Source:
    """An actor with its transponder: sends squitters and draws the intervals between them."""

    def __init__(self, actor: Actor, spec: AircraftSpec | VehicleSpec, seed: int) -> None:
        self.actor = actor
        self.transponder = Transponder(
            spec.icao24,
            spec.callsign,
            spec.transponder.nacp,
            spec.transponder.nacv,
            stream(seed, f"adsb/{spec.icao24}"),
            actor.emitter_category,
            spec.transponder.nic,
            spec.transponder.sil,
        )
        self._rate = SurfaceRate()
        self._position_due_ns = 0

    def position(self, state: Motion, now_ns: int, send: _Send) -> int:
        """Send the position if it is due, or if the actor has begun to move."""
        stationary = self._is_stationary(state, now_ns)
        if now_ns >= self._position_due_ns or not stationary:
            on_ground, transponder = self.actor.body.on_ground, self.transponder
            encode = transponder.surface_position if on_ground else transponder.position
            send(encode(state, now_ns), state)
            self._position_due_ns = now_ns + self._draw_ns(
                STATIONARY_POSITION_INTERVAL_S if stationary else POSITION_INTERVAL_S
            )
        wait_ns = self._position_due_ns - now_ns
        return min(wait_ns, LOOK_NS) if stationary else wait_ns

    def velocity(self, state: Motion, now_ns: int, send: _Send) -> int:  # noqa: ARG002
        """Send the velocity in the air; the surface position brings its own."""
        if not self.actor.body.on_ground:
            send(self.transponder.velocity(state), state)
        return self._draw_ns(VELOCITY_INTERVAL_S)

    def identification(self, state: Motion, now_ns: int, send: _Send) -> int:
        """Send callsign and emitter category."""
        send(self.transponder.identification(), state)
        return self._draw_ns(
            STATIONARY_IDENTIFICATION_INTERVAL_S
            if self._is_stationary(state, now_ns)
            else IDENTIFICATION_INTERVAL_S
        )

    def first_ns(self, within_s: float) -> int:
        """Return the time of the first squitter, drawn from the start of the run."""
        return self._draw_ns((0.0, within_s))

    def _is_stationary(self, state: Motion, now_ns: int) -> bool:
        return self.actor.body.on_ground and self._rate.is_stationary(state, now_ns)

    def _draw_ns(self, interval_s: tuple[float, float]) -> int:
        low_s, high_s = interval_s  # As `Generator.uniform` draws, at a third of its cost.
        return seconds_to_ns(low_s + (high_s - low_s) * self.transponder.generator.random())


def _declared(scenario: Scenario) -> tuple[AdsbReceiver, ...]:
    """Return the receivers of a scenario, or one at its centre."""
    centre = RelativePosition(type="from_centre", bearing_deg=0.0, distance_nm=0.0)
    return scenario.adsb.receivers or (AdsbReceiver(name="centre", position=centre),)


def _receiver(declared: AdsbReceiver, site: ScenarioSite) -> Receiver:
    antenna = FixedSite(
        *site.place(declared.position),
        altitude_m=site.ground_m + declared.antenna_height_ft * FOOT,
    )
    range_m = declared.range_nm * NAUTICAL_MILE
    return Receiver(declared.name, antenna, range_m, ground_m=site.ground_m)
