"""Stations: their frequencies, and their reach."""

from __future__ import annotations

from collections.abc import Mapping

from airhilt.geodesy.relative_motion import Kinematics, horizontal_distance_m
from airhilt.phraseology.numbers import Style
from airhilt.scenario.conversation import is_named_by
from airhilt.scenario.models import Scenario
from airhilt.sensors.radio.on_air import BackgroundNoise
from airhilt.sensors.radio.reports import Field, report_of
from airhilt.surveillance.horizon import LEAST_ANTENNA_HEIGHT_M, radio_horizon_m
from airhilt.units import DEGREE, FOOT, KNOT
from airhilt.world.actors.actor import Actor
from airhilt.world.actors.listening import Listener
from airhilt.world.actors.runway_operations import APPROACHING
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.site import FixedSite, ScenarioSite

TAXIING_M_S = (0.5, 15.0)
"""Ground speeds in m/s between which somebody on the ground taxies or drives: an assumption."""
GROUND_ANTENNA_M = 50.0 * FOOT
"""Height of the units' antenna in m, the same as that of an ADS-B receiver by default."""
SAY_FREQUENCY = "say frequency"
"""Words of an actor that does not know the frequency of a unit."""


class Stations:
    """Actors and units with their radios.

    An actor or a unit is on a frequency if a line of the script there is spoken by it, is
    addressed to it, or has a command for it, and a unit also on those of its controller. Who is
    expected and has no line is on the first frequency of the script.
    """

    def __init__(self, actors: Mapping[str, Actor], site: ScenarioSite, scenario: Scenario) -> None:
        self._actors = actors
        self._scenario_site = site
        self._ground_m = site.ground_m
        self.variation_deg = site.variation_deg or 0.0
        """Magnetic variation of the place, in degrees, positive east."""
        centre = site.centre
        self._site_place = (centre.lat_deg * DEGREE, centre.lon_deg * DEGREE)
        self._site = FixedSite(
            centre.lat_deg * DEGREE,
            centre.lon_deg * DEGREE,
            altitude_m=site.ground_m + GROUND_ANTENNA_M,
        )
        self._on: dict[int, dict[str, None]] = {}
        for line in scenario.radio.lines:
            named = (line.speaker, line.to, *(scripted.actor for scripted in line.commands))
            self._on.setdefault(line.frequency_khz, {}).update(
                dict.fromkeys(name for name in named if name is not None)
            )
        for unit, controller in scenario.controllers.items():
            for frequency_khz in controller.frequencies_khz:
                self._on.setdefault(frequency_khz, {})[unit] = None
        silent = [name for name in scenario.roster if not self.frequencies_of(name)]
        for on_first in list(self._on.values())[:1]:
            on_first.update(dict.fromkeys(silent))

    def on(self, frequency_khz: int) -> tuple[str, ...]:
        """Return the names of the actors and units on a frequency."""
        return tuple(self._on.get(frequency_khz, ()))

    def is_on(self, name: str, frequency_khz: int) -> bool:
        """Return whether an actor or a unit is on a frequency."""
        return name in self._on.get(frequency_khz, ())

    def unit_on(self, frequency_khz: int) -> str | None:
        """Return the unit on a frequency, None if there is none."""
        return next((name for name in self.on(frequency_khz) if name not in self._actors), None)

    def unknown(self, unit: str | None, frequency_khz: int | None) -> str | None:
        """Return what an actor asks that does not know the frequency of a unit; None if it does."""
        return SAY_FREQUENCY if self._frequency(unit, frequency_khz) is None else None

    def tune(self, actor: str, unit: str | None, frequency_khz: int | None) -> int | None:
        """Take an actor from its frequencies to that of a unit, or a given one.

        Return that frequency. None: it is not known, and the actor stays.
        """
        chosen_khz = self._frequency(unit, frequency_khz)
        if chosen_khz is None:
            return None
        for names in self._on.values():
            names.pop(actor, None)
        self._on.setdefault(chosen_khz, {})[actor] = None
        return chosen_khz

    def _frequency(self, unit: str | None, frequency_khz: int | None) -> int | None:
        """Return a given frequency, or that of a unit that is named by words of its name."""
        if frequency_khz is not None or unit is None:
            return frequency_khz
        for khz, names in self._on.items():
            units = (name for name in names if name not in self._actors)
            if any(is_named_by(unit, name) for name in units):
                return khz
        return None

    def listener(self, frequency_khz: int) -> Listener:
        """Return who understands the calls on a frequency, with the callsigns there."""
        return Listener(self.actors_on(frequency_khz), variation_deg=self.variation_deg)

    def actors_on(self, frequency_khz: int) -> tuple[str, ...]:
        """Return the callsigns of the actors on a frequency."""
        return tuple(name for name in self.on(frequency_khz) if name in self._actors)

    def frequencies_of(self, name: str) -> tuple[int, ...]:
        """Return the frequencies of an actor or a unit, in kHz."""
        return tuple(frequency for frequency, names in self._on.items() if name in names)

    def selectable(self, name: str) -> tuple[int, ...]:
        """Return the frequencies in kHz that an actor or a unit selects from.

        They are its own ones, or all of the script if it has none.
        """
        return self.frequencies_of(name) or tuple(self._on)

    def frequency_of(self, name: str) -> int | None:
        """Return the frequency on which an actor is called, in kHz; None if there is none at all.

        It is the first one of the script that is the actor's, otherwise the first one of all.
        """
        return next(iter(self.selectable(name)), None)

    def is_actor(self, name: str) -> bool:
        """Return whether a name is that of an actor, not of a unit."""
        return name in self._actors

    def is_there(self, name: str) -> bool:
        """Return whether an actor or a unit still exists."""
        return self._place(name) is not None

    def bound_runway(self, name: str) -> str | None:
        """Return the runway that an actor is going to use; None for others."""
        return self._actors[name].bound_runway if name in self._actors else None

    def is_crew(self, name: str) -> bool:
        """Return whether a name is that of an aircraft."""
        return name in self._actors and self._actors[name].category == "aircraft"

    def report_of(self, callsign: str, asked: str, style: Style) -> str | None:
        """Return what an actor says when it is asked for something; None if it does not know."""
        field = Field(self._scenario_site, self._site_place, self.variation_deg)
        return report_of(self._actors[callsign], asked, field, style)

    def altitudes_ft(self, callsign: str) -> tuple[float | None, float | None]:
        """Return the altitude of an aircraft in flight and that it flies to, in ft; else None."""
        aircraft = self._flying(callsign)
        if aircraft is None:
            return None, None
        return aircraft.state.altitude_m / FOOT, aircraft.target_altitude_m / FOOT

    def airspeeds_kt(self, callsign: str) -> tuple[float | None, float | None]:
        """Return the calibrated airspeed of an aircraft in flight and that told, in kt; or None."""
        aircraft = self._flying(callsign)
        if aircraft is None:
            return None, None
        return aircraft.state.calibrated_airspeed_m_s / KNOT, aircraft.target_speed_m_s / KNOT

    def is_approaching(self, callsign: str) -> bool:
        """Return whether an actor flies an approach."""
        body = self._flying(callsign)
        return body is not None and body.phase in APPROACHING

    def _flying(self, callsign: str) -> Aircraft | None:
        body = self._actors[callsign].body
        return body if isinstance(body, Aircraft) and not body.on_ground else None

    def on_ground(self, callsign: str) -> bool:
        """Return whether the ground carries an actor."""
        return self._actors[callsign].body.on_ground

    def is_moving_on_ground(self, name: str) -> bool:
        """Return whether a name is that of an actor that taxies or drives."""
        if name not in self._actors:
            return False
        body = self._actors[name].body
        return body.on_ground and TAXIING_M_S[0] < body.state.ground_speed_m_s < TAXIING_M_S[1]

    def background_of(self, name: str) -> BackgroundNoise:
        """Return the noise around the microphone of an actor or a unit."""
        return "cockpit" if self.is_actor(name) else "tower"

    def audible(self, speaker: str, listener: str) -> bool:
        """Return whether a listener is above the radio horizon of a speaker, and both still exist.

        All units share one site, which is also that of the receiver, a listener without a name.
        """
        if speaker == listener:
            return True
        one, other = self._place(speaker), self._place(listener)
        if one is None or other is None:
            return False
        if one is other:
            return True
        return horizontal_distance_m(one, other) <= radio_horizon_m(
            self._height_m(one), self._height_m(other)
        )

    def keyed_by(self, speaker: str) -> str | None:
        """Return the unit whose transmitter at the receiver's site is keyed, None for an actor."""
        return None if self.is_actor(speaker) else speaker

    def _place(self, name: str) -> Kinematics | None:
        """Return the position of an actor or a unit; None if it exists no more."""
        actor = self._actors.get(name)
        if actor is None:
            return self._site
        return None if actor.body.ended is not None else actor.body.state

    def _height_m(self, place: Kinematics) -> float:
        return max(place.altitude_m - self._ground_m, LEAST_ANTENNA_HEIGHT_M)
