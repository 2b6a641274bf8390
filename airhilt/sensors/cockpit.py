"""Cockpit instruments in a run: what an aircraft shows its own crew, and nothing of others.

A vehicle shows its driver where it is, on a moving map.

They are published five times a second, as often as the truth that a viewer compares them with. They
are there for the aircraft that the scenario names, and for all if a worker subscribes to them: two
airliners for five minutes are 3,000 messages, as many as everything else together, and few
assistants sit in a cockpit.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from airhilt.messages import CockpitInstruments, Message, VehiclePosition
from airhilt.sensors.base import Sensor, SensorContext
from airhilt.sim import Priority
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, SECOND_NS
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.surface.vehicle import Vehicle

PERIOD_NS = SECOND_NS // 5
"""Period of the messages, in ns."""
RADIO_ALTIMETER_FT = 2500
"""Height above which a radio altimeter shows nothing, in ft (ARINC 707)."""


class CockpitType:
    """The instruments of the aircraft and vehicles that a scenario lists in ``cockpits``.

    All aircraft show them if a worker subscribes to instruments.
    """

    name = "cockpit"
    messages: Mapping[str, type[Message]] = {
        "cockpit/{callsign}": CockpitInstruments,
        "cockpit/{callsign}/position": VehiclePosition,
    }

    def create(self, context: SensorContext) -> Cockpits | None:
        """Return the instruments of a run; None if nobody asks for any."""
        if self.name in context.subscribed:
            return Cockpits(tuple(context.actors), context)
        return Cockpits(context.scenario.cockpits, context) if context.scenario.cockpits else None


SENSOR = CockpitType()


class Cockpits(Sensor):
    """The instruments of those of some actors that are aircraft or vehicles."""

    def __init__(self, callsigns: Sequence[str], context: SensorContext) -> None:
        self._director = context.director
        self._publish = context.publish
        self._variation_deg = context.site.variation_deg
        bodies = {name: context.actors[name].body for name in callsigns}
        self._aircraft = {
            callsign: body for callsign, body in bodies.items() if isinstance(body, Aircraft)
        }
        self._vehicles = {
            callsign: body for callsign, body in bodies.items() if isinstance(body, Vehicle)
        }

    def start(self) -> None:
        """Publish now, and then at a steady rate."""
        self._director.every(PERIOD_NS, self._read, Priority.SENSOR)

    def _read(self) -> None:
        for callsign, aircraft in self._aircraft.items():
            if aircraft.ended is None:
                instruments = instruments_of(
                    callsign, aircraft, self._variation_deg, self._director.now_ns
                )
                self._publish(f"cockpit/{callsign}", instruments)
        for callsign, vehicle in self._vehicles.items():
            if vehicle.ended is None:
                self._publish(f"cockpit/{callsign}/position", self._position(callsign, vehicle))

    def _position(self, callsign: str, vehicle: Vehicle) -> VehiclePosition:
        state = vehicle.state
        return VehiclePosition(
            t_ns=self._director.now_ns,
            callsign=callsign,
            latitude_deg=round(state.latitude_rad / DEGREE, 7),
            longitude_deg=round(state.longitude_rad / DEGREE, 7),
            heading_deg=_bearing_deg(state.heading_rad, 0.0),
            ground_speed_kt=round(state.ground_speed_m_s / KNOT, 1),
        )


def instruments_of(
    callsign: str, aircraft: Aircraft, variation_deg: float | None, t_ns: int = 0
) -> CockpitInstruments:
    """Return what the instruments of an aircraft show at a time.

    The magnetic variation is positive east; None if it is not known, and the compass shows true.
    """
    state, from_true_deg = aircraft.state, variation_deg or 0.0
    return CockpitInstruments(
        t_ns=t_ns,
        callsign=callsign,
        airspeed_kt=round(state.calibrated_airspeed_m_s / KNOT, 1),
        mach=round(state.mach, 3),
        altitude_ft=round(state.altitude_m / FOOT),
        vertical_speed_fpm=round(state.vertical_rate_m_s / FOOT_PER_MINUTE),
        north="true" if variation_deg is None else "magnetic",
        heading_deg=_bearing_deg(state.heading_rad, from_true_deg),
        track_deg=_bearing_deg(state.track_rad, from_true_deg),
        ground_speed_kt=round(state.ground_speed_m_s / KNOT, 1),
        pitch_deg=round(state.pitch_rad / DEGREE, 1),
        roll_deg=round(state.roll_rad / DEGREE, 1),
        gear=round(aircraft.gear, 2),
        flaps=round(aircraft.flaps, 2),
        on_ground=aircraft.on_ground,
        mode=aircraft.phase,
        radio_height_ft=_radio_height_ft(state.height_agl_m),
        selected_altitude_ft=round(aircraft.target_altitude_m / FOOT),
        selected_airspeed_kt=round(aircraft.target_speed_m_s / KNOT),
    )


def _radio_height_ft(height_m: float) -> int | None:
    height_ft = round(height_m / FOOT)
    return height_ft if height_ft <= RADIO_ALTIMETER_FT else None


def _bearing_deg(true_rad: float, variation_deg: float) -> float:
    return round((true_rad / DEGREE - variation_deg) % 360.0, 1) % 360.0
