"""ADS-B in a run: when transponders squitter, and when a report leaves the receiver."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import replace

from airhilt.geodesy.positions import RelativePosition
from airhilt.messages import AdsbReport, DeclaredLatency
from airhilt.scenario.models import (
    AdsbReceiver,
    AircraftSpec,
    Scenario,
    VehicleSpec,
    WildlifeSpec,
)
from airhilt.sim import Director, LatencySpec, Priority, StepRecord
from airhilt.sim.streams import stream
from airhilt.surveillance.adsb import (
    IDENTIFICATION_INTERVAL_S,
    POSITION_INTERVAL_S,
    STATIONARY_IDENTIFICATION_INTERVAL_S,
    STATIONARY_POSITION_INTERVAL_S,
    VELOCITY_INTERVAL_S,
    Receiver,
    Reception,
    Squitter,
    SurfaceRate,
    Transponder,
)
from airhilt.units import FOOT, NAUTICAL_MILE, SECOND_NS, seconds_to_ns
from airhilt.world.actors.actor import Actor
from airhilt.world.mover import Motion, Mover, carried_on
from airhilt.world.site import FixedSite, ScenarioSite

STAGE = "adsb"
DECLARED_LATENCY = DeclaredLatency(median_s=0.05, sigma=0.3)
"""Of a receiver from the end of a squitter to its report, where it is not measured."""
LOOK_NS = SECOND_NS // 2
"""How often a transponder that stands on the ground looks whether it has begun to move."""


class AdsbSensor:
    """Schedules the squitters of all that are equipped and gives out what is received.

    Parameters
    ----------
    publish
        Called with each report when it leaves the receiver.
    done
        Called with the latency record of each report.
    """

    def __init__(
        self,
        director: Director,
        scenario: Scenario,
        site: ScenarioSite,
        actors: Mapping[str, Actor],
        latency: LatencySpec,
        seed: int,
        state_at_ns: Callable[[], int],
        publish: Callable[[AdsbReport], None],
        done: Callable[[StepRecord], None],
    ) -> None:
        self._director = director
        self._state_at_ns = state_at_ns
        self._publish = publish
        self._done = done
        self._latency = latency.source(
            STAGE, seed, DECLARED_LATENCY.median_s, DECLARED_LATENCY.sigma
        )
        self._seq = 0
        self._in_flight: dict[int, StepRecord] = {}
        self._reception = Reception(
            [_receiver(declared, site) for declared in _declared(scenario)],
            scenario.adsb.loss_probability,
            [(seconds_to_ns(a), seconds_to_ns(b)) for a, b in scenario.adsb.outages_s],
        )
        for actor in actors.values():
            spec = actor.spec
            if not isinstance(spec, WildlifeSpec) and spec.transponder.equipped:
                self._equip(actor, spec, seed)

    def _equip(self, actor: Actor, spec: AircraftSpec | VehicleSpec, seed: int) -> None:
        transponder = Transponder(
            spec.icao24,
            spec.callsign,
            spec.transponder.nacp,
            spec.transponder.nacv,
            stream(seed, f"adsb/{spec.icao24}"),
            actor.emitter_category,
        )
        body, rate, uniform = actor.body, SurfaceRate(), transponder.generator.uniform
        position_due_ns = 0

        def is_stationary(state: Motion) -> bool:
            return body.on_ground and rate.is_stationary(state, self._director.now_ns)

        def position(state: Motion) -> int:
            """Squitter if it is time to; who begins to move is not silent for seconds."""
            nonlocal position_due_ns
            now_ns, stationary = self._director.now_ns, is_stationary(state)
            if now_ns >= position_due_ns or not stationary:
                make = transponder.surface_position if body.on_ground else transponder.position
                self._receive(transponder, make(state, now_ns), state)
                interval_s = STATIONARY_POSITION_INTERVAL_S if stationary else POSITION_INTERVAL_S
                position_due_ns = now_ns + seconds_to_ns(uniform(*interval_s))
            return (
                min(position_due_ns - now_ns, LOOK_NS) if stationary else position_due_ns - now_ns
            )

        def velocity(state: Motion) -> int:
            if not body.on_ground:
                self._receive(transponder, transponder.velocity(state), state)
            return seconds_to_ns(uniform(*VELOCITY_INTERVAL_S))

        def identification(state: Motion) -> int:
            self._receive(transponder, transponder.identification(), state)
            return seconds_to_ns(
                uniform(
                    *STATIONARY_IDENTIFICATION_INTERVAL_S
                    if is_stationary(state)
                    else IDENTIFICATION_INTERVAL_S
                )
            )

        for squitter, (first_s, _) in (
            (position, POSITION_INTERVAL_S),
            (velocity, VELOCITY_INTERVAL_S),
            (identification, IDENTIFICATION_INTERVAL_S),
        ):
            self._repeat(body, squitter, seconds_to_ns(uniform(0.0, first_s)))

    def _repeat(self, body: Mover, squitter: Callable[[Motion], int], first_ns: int) -> None:
        """Call ``squitter``, which says after how many nanoseconds again, until the body ends."""

        def call() -> None:
            if body.ended is not None:
                return
            now_ns = self._director.now_ns
            state = carried_on(body.state, (now_ns - self._state_at_ns()) / SECOND_NS)
            self._director.at(now_ns + squitter(state), call, Priority.SENSOR)

        self._director.at(first_ns, call, Priority.SENSOR)

    def _receive(self, sender: Transponder, squitter: Squitter, state: Motion) -> None:
        now_ns, begun = self._director.now_ns, time.perf_counter()
        decoded = self._reception.receive(sender, squitter, state, now_ns)
        compute_s = time.perf_counter() - begun
        if decoded is None:
            return
        known_ns = self._latency.known_ns(self._seq)
        latency_ns = seconds_to_ns(compute_s) if known_ns is None else known_ns
        out_ns = now_ns + latency_ns
        step = StepRecord(STAGE, self._seq, now_ns, now_ns, latency_ns, compute_s, 1)
        self._in_flight[self._seq] = step
        self._seq += 1

        def leave() -> None:
            self._done(step)
            del self._in_flight[step.seq]
            self._publish(decoded.report(out_ns))

        self._director.at(out_ns, leave, Priority.RESULT)

    def unfinished(self) -> list[StepRecord]:
        """Return the reports that are still in a receiver."""
        return [replace(step, outputs=0, finished=False) for step in self._in_flight.values()]


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
