"""ADS-B in a run: when transponders squitter, and when a report leaves the receiver."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import replace

from airhilt.actors import Flight
from airhilt.flight.state import AircraftState
from airhilt.messages import AdsbReport, DeclaredLatency
from airhilt.scenario.geometry import Site, resolve
from airhilt.scenario.models import AdsbReceiver, RelativePosition, Scenario
from airhilt.sim import Director, LatencySpec, Priority, StepRecord
from airhilt.sim.streams import stream
from airhilt.surveillance.adsb import (
    IDENTIFICATION_INTERVAL_S,
    POSITION_INTERVAL_S,
    VELOCITY_INTERVAL_S,
    IdentificationSquitter,
    Receiver,
    Reception,
    Squitter,
    Transponder,
)
from airhilt.surveillance.kinematics import curvature_radii_m
from airhilt.units import FOOT, NAUTICAL_MILE, SECOND_NS, seconds_to_ns

STAGE = "adsb"
DECLARED_LATENCY = DeclaredLatency(median_s=0.05, sigma=0.3)
"""Of a receiver from the end of a squitter to its report, where it is not measured."""


class AdsbSensor:
    """Schedules the squitters of all equipped aircraft and gives out what is received.

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
        flights: Mapping[str, Flight],
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
            [_receiver(declared, scenario) for declared in _declared(scenario)],
            scenario.adsb.loss_probability,
            [(seconds_to_ns(a), seconds_to_ns(b)) for a, b in scenario.adsb.outages_s],
        )
        for flight in flights.values():
            if flight.actor.transponder.equipped:
                self._equip(flight, seed)

    def _equip(self, flight: Flight, seed: int) -> None:
        actor = flight.actor
        transponder = Transponder(
            actor.icao24,
            actor.callsign,
            actor.transponder.nacp,
            actor.transponder.nacv,
            stream(seed, f"adsb/{actor.icao24}"),
        )

        def position(state: AircraftState) -> Squitter:
            return transponder.position(state, self._director.now_ns)

        def identification(_: AircraftState) -> Squitter:
            return IdentificationSquitter(actor.callsign)

        self._repeat(flight, transponder, position, POSITION_INTERVAL_S)
        self._repeat(flight, transponder, transponder.velocity, VELOCITY_INTERVAL_S)
        self._repeat(flight, transponder, identification, IDENTIFICATION_INTERVAL_S)

    def _repeat(
        self,
        flight: Flight,
        transponder: Transponder,
        make: Callable[[AircraftState], Squitter],
        interval_s: tuple[float, float],
    ) -> None:
        """Squitter at random intervals until the flight ends; the first within one interval."""
        uniform = transponder.generator.uniform

        def squitter() -> None:
            if flight.aircraft.ended is not None:
                return
            now_ns = self._director.now_ns
            state = carried_on(flight.aircraft.state, (now_ns - self._state_at_ns()) / SECOND_NS)
            self._receive(transponder, make(state), state)
            after_ns = seconds_to_ns(uniform(*interval_s))
            self._director.at(now_ns + after_ns, squitter, Priority.SENSOR)

        self._director.at(seconds_to_ns(uniform(0.0, interval_s[0])), squitter, Priority.SENSOR)

    def _receive(self, sender: Transponder, squitter: Squitter, state: AircraftState) -> None:
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


def carried_on(state: AircraftState, elapsed_s: float) -> AircraftState:
    """Return a state a fraction of a tick later, flying straight on."""
    if elapsed_s == 0.0:
        return state
    meridional, prime_vertical = curvature_radii_m(state.latitude_rad)
    height = state.altitude_m
    return state._replace(
        latitude_rad=state.latitude_rad
        + state.velocity_north_m_s * elapsed_s / (meridional + height),
        longitude_rad=state.longitude_rad
        + state.velocity_east_m_s
        * elapsed_s
        / ((prime_vertical + height) * math.cos(state.latitude_rad)),
        altitude_m=height - state.velocity_down_m_s * elapsed_s,
    )


def _declared(scenario: Scenario) -> tuple[AdsbReceiver, ...]:
    """Return the receivers of a scenario, or one at its centre."""
    centre = RelativePosition(type="from_centre", bearing_deg=0.0, distance_nm=0.0)
    return scenario.adsb.receivers or (AdsbReceiver(name="centre", position=centre),)


def _receiver(declared: AdsbReceiver, scenario: Scenario) -> Receiver:
    ground_m = scenario.scene.terrain_elevation_ft * FOOT
    site = Site(
        *resolve(declared.position, scenario.scene.centre),
        altitude_m=ground_m + declared.antenna_height_ft * FOOT,
    )
    return Receiver(declared.name, site, declared.range_nm * NAUTICAL_MILE)
