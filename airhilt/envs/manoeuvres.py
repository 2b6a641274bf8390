"""Manoeuvres that an agent chooses from, as advice, as a controller's words, or as a command."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from airhilt.commands import AltitudeCommand, Command, Side, TurnCommand
from airhilt.messages import Climb, Recommendation, Turn
from airhilt.phraseology import Instruction

LEVEL_STEP_FT = 1000.0
"""Step of the levels that are flown to, in ft (ICAO Annex 2, appendix 3)."""
CLIMB_RATE_FPM = 1500.0
"""Vertical rate of advised climbs and descents in ft/min: that of most resolution advisories of
TCAS II (RTCA DO-185B)."""


class Manoeuvre(Protocol):
    """A change of the flight of one aircraft, from the altitude that it has reported."""

    def recommendation(self, altitude_ft: float) -> Recommendation:
        """Return it as the recommendation of an advisory."""

    def instruction(self, altitude_ft: float) -> Instruction:
        """Return it as the instruction of a controller."""

    def command(self, altitude_ft: float) -> Command:
        """Return it as a command to the aircraft."""


@dataclass(frozen=True)
class ClimbBy:
    """Climb to the level nearest to a difference of altitude; a negative one is a descent."""

    feet: float

    def _level_ft(self, altitude_ft: float) -> float:
        return round((altitude_ft + self.feet) / LEVEL_STEP_FT) * LEVEL_STEP_FT

    def recommendation(self, altitude_ft: float) -> Climb:
        """Return it as the recommendation of an advisory."""
        return Climb(
            sense="climb" if self.feet > 0.0 else "descend",
            altitude_ft=self._level_ft(altitude_ft),
            vertical_rate_fpm=CLIMB_RATE_FPM,
        )

    def instruction(self, altitude_ft: float) -> Instruction:
        """Return it as the instruction of a controller."""
        sense = self.recommendation(altitude_ft).sense
        return Instruction("altitude", sense=sense, altitude_ft=self._level_ft(altitude_ft))

    def command(self, altitude_ft: float) -> AltitudeCommand:
        """Return it as a command to the aircraft."""
        return AltitudeCommand(action="altitude", altitude_ft=self._level_ft(altitude_ft))


@dataclass(frozen=True)
class TurnBy:
    """Turn by an angle in degrees, positive to the right."""

    degrees: float

    def recommendation(self, altitude_ft: float) -> Turn:  # noqa: ARG002
        """Return it as the recommendation of an advisory."""
        return Turn(degrees=self.degrees)

    def instruction(self, altitude_ft: float) -> Instruction:  # noqa: ARG002
        """Return it as the instruction of a controller."""
        side: Side = "right" if self.degrees > 0.0 else "left"
        return Instruction("turn_by", turn=side, turn_deg=abs(self.degrees))

    def command(self, altitude_ft: float) -> TurnCommand:  # noqa: ARG002
        """Return it as a command to the aircraft."""
        return TurnCommand(action="turn", degrees=self.degrees)


MANOEUVRES: tuple[Manoeuvre, ...] = (
    ClimbBy(1000.0),
    ClimbBy(-1000.0),
    TurnBy(-30.0),
    TurnBy(30.0),
)
"""Manoeuvres of an environment that is given none: one level, or a turn of 30 degrees."""
