"""Active interrogation by aircraft that carry TCAS II, and the replies that they get.

Once a second an aircraft with TCAS interrogates the transponders around it. A reply gives the slant
range, by the time that it takes, the bearing, by the antenna, and the altitude. An aircraft without
a transponder does not reply.

Sources
-------
FAA
    Introduction to TCAS II Version 7.1 (2011): interrogation once a second; no interrogation on the
    ground (sensitivity level 1); altitude in steps of 25 ft from Mode S and of 100 ft from Mode C;
    reliable surveillance to 14 NM, of Mode S to 30 NM.

Assumptions
-----------
The limits of error that RTCA DO-185B is cited with stand for the errors: a range bias of at most
125 ft, a range jitter of 50 ft, a bearing error of 9 degrees (standard deviations), each
independent of the one before. One reply in twenty is lost. Altitudes have no error but their step,
as everywhere in a run. Not modelled: interference limiting, garbled replies, multipath, hybrid
surveillance, and the shadow of the own wings.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from airhilt.messages import Message, TcasReply
from airhilt.scenario.models import AircraftSpec
from airhilt.sensors.base import Sensor, SensorContext, SensorGroup
from airhilt.sim import Priority
from airhilt.sim.streams import stream
from airhilt.surveillance.horizon import radio_horizon_m
from airhilt.surveillance.radar import MODE_C_STEP_FT, Antenna
from airhilt.surveillance.squitters import ALTITUDE_STEP_FT, quantise
from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE, SECOND_NS, seconds_to_ns
from airhilt.world.actors.actor import Actor
from airhilt.world.mover import Motion

PERIOD_NS = SECOND_NS
"""Period of the interrogations, in ns."""
MODE_S_RANGE_M = 30.0 * NAUTICAL_MILE
MODE_C_RANGE_M = 14.0 * NAUTICAL_MILE
RANGE_BIAS_M = 125.0 * FOOT
"""Greatest constant error of the range to one transponder, in m; drawn uniformly."""
RANGE_JITTER_M = 50.0 * FOOT
BEARING_ERROR_DEG = 9.0
REPLY_PROBABILITY = 0.95
LIGHT = "A1"
"""Emitter category of aircraft below 15,500 lb, 7,000 kg (DO-260B)."""


class TcasType:
    """The interrogations of the aircraft that carry TCAS II.

    They are there if the scenario lists the aircraft in ``tcas``, or if a worker subscribes to the
    replies: then every aircraft carries TCAS II that must, if the scenario lists none.
    """

    name = "tcas"
    messages: Mapping[str, type[Message]] = {"tcas/{callsign}": TcasReply}

    def create(self, context: SensorContext) -> SensorGroup | None:
        """Return the sensor of a run; None if no aircraft interrogates."""
        carriers = context.scenario.tcas
        if not carriers and self.name in context.subscribed:
            carriers = must_carry(context.actors.values())
        interrogators = [Interrogator(each, carriers, context) for each in carriers]
        return SensorGroup(interrogators) if interrogators else None


SENSOR = TcasType()


def must_carry(actors: Iterable[Actor]) -> tuple[str, ...]:
    """Return the callsigns of the aircraft that must carry TCAS II.

    ICAO Annex 6, part I, 6.19: turbine aeroplanes of more than 5,700 kg or 19 passengers. Here that
    is every aircraft above the emitter category of light ones, with a Mode S transponder.
    """
    return tuple(
        actor.spec.callsign
        for actor in actors
        if isinstance(actor.spec, AircraftSpec)
        and actor.spec.transponder.has_adsb
        and actor.emitter_category != LIGHT
    )


@dataclass(frozen=True)
class _Target:
    """An aircraft with a transponder, as one interrogator meets it."""

    spec: AircraftSpec
    actor: Actor
    has_tcas: bool
    generator: np.random.Generator
    bias_m: float


class Interrogator(Sensor):
    """One aircraft's interrogations, once a second from a phase that is drawn."""

    def __init__(self, callsign: str, carriers: Collection[str], context: SensorContext) -> None:
        self._callsign = callsign
        self._director = context.director
        self._state_of = context.state_of
        self._publish = context.publish
        self._ground_m = context.site.ground_m
        self._own = context.actors[callsign]
        assert isinstance(self._own.spec, AircraftSpec)  # The checks of a scenario see to it.
        self._icao24 = self._own.spec.icao24
        self._phase_s = stream(context.seed, f"tcas/{callsign}").uniform(0.0, 1.0)
        self._targets = [
            _Target(
                spec,
                actor,
                spec.callsign in carriers and spec.transponder.mode == "S",
                generator := stream(context.seed, f"tcas/{callsign}/{name}"),
                generator.uniform(-RANGE_BIAS_M, RANGE_BIAS_M),
            )
            for name, actor in context.actors.items()
            if isinstance(spec := actor.spec, AircraftSpec)
            and spec.transponder.equipped
            and name != callsign
        ]

    def start(self) -> None:
        """Schedule the interrogations."""
        first_ns = seconds_to_ns(self._phase_s)
        self._director.every(PERIOD_NS, self._interrogate, Priority.SENSOR, first_ns=first_ns)

    def _interrogate(self) -> None:
        """Publish the replies to one interrogation; on the ground there is none."""
        body = self._own.body
        if body.ended is not None or body.on_ground:
            return
        own = self._state_of(body)
        antenna = Antenna(own.latitude_rad, own.longitude_rad, own.altitude_m)
        for target in self._targets:
            if target.actor.body.ended is None:
                reply = self._reply(target, self._state_of(target.actor.body), own, antenna)
                if reply is not None:
                    self._publish(f"tcas/{self._callsign}", reply)

    def _reply(
        self, target: _Target, state: Motion, own: Motion, antenna: Antenna
    ) -> TcasReply | None:
        """Return the reply of a target; None if there is none.

        All random numbers are drawn each time, so that no lost reply changes the draws after it.
        """
        replied = target.generator.random()
        range_error, bearing_error = target.generator.standard_normal(2)
        line, is_mode_s = antenna.to(state), target.spec.transponder.mode == "S"
        on_ground = target.actor.body.on_ground
        horizon_m = radio_horizon_m(
            max(own.altitude_m - self._ground_m, 0.0),
            max(state.altitude_m - self._ground_m, 0.0),
        )
        if (
            line.range_m > (MODE_S_RANGE_M if is_mode_s else MODE_C_RANGE_M)
            or line.horizontal_m > horizon_m
            or replied >= REPLY_PROBABILITY
            or (on_ground and not is_mode_s)
        ):
            return None
        bearing_deg = (line.azimuth_rad - own.heading_rad) / DEGREE
        step_ft = ALTITUDE_STEP_FT if is_mode_s else MODE_C_STEP_FT
        return TcasReply(
            t_ns=self._director.now_ns,
            callsign=self._callsign,
            own_icao24=self._icao24,
            mode=target.spec.transponder.mode,
            icao24=target.spec.icao24 if is_mode_s else None,
            range_m=round(max(line.range_m + target.bias_m + RANGE_JITTER_M * range_error, 0.0), 1),
            bearing_deg=round(bearing_deg + BEARING_ERROR_DEG * bearing_error, 1) % 360.0,
            altitude_ft=round(quantise(state.altitude_m / FOOT, step_ft)),
            on_ground=on_ground,
            has_tcas=target.has_tcas,
        )
