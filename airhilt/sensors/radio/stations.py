"""Who is on which frequency, and in whose reach."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from airhilt.geodesy.relative_motion import Kinematics, relative
from airhilt.scenario.models import RadioLine
from airhilt.surveillance.horizon import LEAST_ANTENNA_HEIGHT_M, radio_horizon_m
from airhilt.units import DEGREE, FOOT
from airhilt.world.actors.actor import Actor
from airhilt.world.site import FixedSite, ScenarioSite

if TYPE_CHECKING:
    from airhilt.sensors.radio.channel import BackgroundNoise

GROUND_ANTENNA_M = 50.0 * FOOT
"""Height of a unit's antenna, at the scene's centre: that of an ADS-B receiver by default."""


class Stations:
    """Actors and units with their radios.

    Somebody is on a frequency if a line of the script has him speak there, be addressed, or do
    something.
    """

    def __init__(
        self, actors: Mapping[str, Actor], site: ScenarioSite, lines: Iterable[RadioLine]
    ) -> None:
        self._actors = actors
        self._ground_m = site.ground_m
        centre = site.centre
        self._site = FixedSite(
            centre.lat_deg * DEGREE,
            centre.lon_deg * DEGREE,
            altitude_m=site.ground_m + GROUND_ANTENNA_M,
        )
        self._on: dict[int, dict[str, None]] = {}
        for line in lines:
            named = (line.speaker, line.to, *(scripted.actor for scripted in line.commands))
            self._on.setdefault(line.frequency_khz, {}).update(
                dict.fromkeys(name for name in named if name is not None)
            )

    def on(self, frequency_khz: int) -> tuple[str, ...]:
        """Return who is on a frequency, actors and units."""
        return tuple(self._on.get(frequency_khz, ()))

    def actors_on(self, frequency_khz: int) -> tuple[str, ...]:
        """Return the callsigns of the actors that are on a frequency."""
        return tuple(name for name in self.on(frequency_khz) if name in self._actors)

    def frequencies_of(self, name: str) -> tuple[int, ...]:
        """Return the frequencies that somebody is on."""
        return tuple(frequency for frequency, names in self._on.items() if name in names)

    def is_actor(self, name: str) -> bool:
        """Return whether somebody is an actor, not a unit."""
        return name in self._actors

    def is_there(self, name: str) -> bool:
        """Return whether somebody can still speak and hear."""
        return self._place(name) is not None

    def bound_runway(self, name: str) -> str | None:
        """Return the runway that an actor means to use."""
        return self._actors[name].bound_runway if name in self._actors else None

    def is_crew(self, name: str) -> bool:
        """Return whether somebody is the crew of an aircraft."""
        return name in self._actors and self._actors[name].category == "aircraft"

    def background_of(self, name: str) -> BackgroundNoise:
        """Return what else the microphone of somebody picks up."""
        return "cockpit" if self.is_actor(name) else "tower"

    def audible(self, speaker: str, listener: str) -> bool:
        """Return whether a listener is above the radio horizon of a speaker, and still there.

        All units share one site, which is where the run receives.
        """
        if speaker == listener:
            return True
        one, other = self._place(speaker), self._place(listener)
        if one is None or other is None:
            return False
        if one is other:
            return True
        return relative(one, other).distance_m <= radio_horizon_m(
            self._height_m(one), self._height_m(other)
        )

    def received(self, speaker: str) -> bool:
        """Return whether a speaker is in reach of the units' site."""
        return self.audible(speaker, "")

    def _place(self, name: str) -> Kinematics | None:
        """Return where somebody is; None if he is no more."""
        actor = self._actors.get(name)
        if actor is None:
            return self._site
        return None if actor.body.ended is not None else actor.body.state

    def _height_m(self, place: Kinematics) -> float:
        return max(place.altitude_m - self._ground_m, LEAST_ANTENNA_HEIGHT_M)
