"""The words of a controller's measures, in the phraseology of the scenario.

FAA: Order JO 7110.65, 2-1-6 (safety alerts), 3-7-2 (taxi), 3-9-11 (cancelled takeoffs). ICAO: Doc
4444, 12.3.4.12 (takeoffs), 12.3.4.18 (go-around), 12.4.1.8 (avoiding action).
"""

from __future__ import annotations

import math
from dataclasses import replace

from airhilt.geodesy.relative_motion import relative
from airhilt.messages import (
    CancelTakeoff,
    Climb,
    GoAround,
    HoldPosition,
    MaintainLevel,
    Recommendation,
    Turn,
)
from airhilt.phraseology import Instruction, Sense, Style
from airhilt.phraseology import Turn as Side
from airhilt.phraseology.say import speak_instruction, speak_traffic, speak_traffic_alert
from airhilt.sensors.radio.controllers.displays import Displays, Target
from airhilt.sensors.radio.controllers.measures import ROLLING_M_S, Measure
from airhilt.sensors.radio.controllers.strips import Strips
from airhilt.units import DEGREE, NAUTICAL_MILE

HEADING_STEP_DEG = 5.0
"""Step of the headings that are given, in degrees (Doc 4444, 12.1.1)."""
LEVEL_STEP_FT = 100.0
"""Step of the levels that are given, in ft."""


class Wording:
    """Words measures for the crew or driver that they are for."""

    def __init__(
        self, displays: Displays, strips: Strips, style: Style, variation_deg: float
    ) -> None:
        self._displays = displays
        self._strips = strips
        self._style = style
        self._variation_deg = variation_deg

    def instructions(self, measure: Measure) -> tuple[Instruction, ...]:
        """Return what a measure tells its crew or driver to do."""
        target = self._displays.target(measure.callsign)
        match measure.action:
            case GoAround():
                return (Instruction("go_around"),)
            case CancelTakeoff():
                return self._cancellation(measure.callsign, target)
            case HoldPosition() if measure.callsign in self._displays.vehicles:
                return (Instruction("stop", immediate=True),)
            case HoldPosition():
                return (Instruction("hold_position"),)
            case MaintainLevel(altitude_ft=altitude_ft):
                return (_level("maintain", altitude_ft),)
            case Climb(sense=sense, altitude_ft=altitude_ft, turn_deg=degrees):
                turn = (self._turn(degrees, target, measure),) if degrees else ()
                level = _level(sense, altitude_ft)
                return (*turn, replace(level, immediate=measure.is_alert))
            case Turn(degrees=degrees):
                return (self._turn(degrees, target, measure),)
            case _:
                return ()

    def text(self, measure: Measure, instructions: tuple[Instruction, ...]) -> str:
        """Return the words of a measure."""
        target, traffic = self._displays.target(measure.callsign), measure.traffic
        if _is_for_flight(measure.action):
            where = ""
            if target is not None and traffic is not None:
                where = self._position(target, traffic)
            if measure.is_alert:
                return speak_traffic_alert(measure.callsign, instructions, where, self._style)
            told = f"traffic {where}" if where else ""
            return speak_instruction(measure.callsign, instructions, self._style, told)
        runway = getattr(measure.action, "runway", None)
        reason = "" if traffic is None else self._reason(traffic, runway)
        return speak_instruction(measure.callsign, instructions, self._style, reason)

    def _reason(self, traffic: Target, runway: str | None) -> str:
        """Return what is in the way of the user of a runway, in a few words."""
        on, final = self._displays.runway_of(traffic), self._displays.final_of(traffic)
        if on is None and final is None:
            return ""
        if runway is not None and not self._displays.are_one_runway(on or final, runway):
            return "crossing traffic"
        return "traffic on the runway" if on is not None else "traffic on final"

    def _cancellation(self, callsign: str, target: Target | None) -> tuple[Instruction, ...]:
        """Return what keeps somebody from taking off, or stops the takeoff.

        Who has begun to roll is to stop. Who has no clearance for takeoff has none to cancel.
        """
        cancel = Instruction("cancel_takeoff")
        is_cleared = self._strips.of(callsign).runway_use == "cleared_for_takeoff"
        is_rolling = target is not None and target.speed_m_s >= ROLLING_M_S
        if is_cleared and self._style == "faa":
            return (cancel,)
        if is_rolling:
            return (Instruction("stop", immediate=True),)
        return (Instruction("hold_position"), *([cancel] if is_cleared else []))

    def _turn(self, degrees: float, target: Target | None, measure: Measure) -> Instruction:
        """Return a turn by an angle as a magnetic heading, where the track is displayed."""
        turn: Side = "right" if degrees >= 0.0 else "left"
        side = Instruction("turn_by", turn=turn, immediate=measure.is_alert)
        if target is None:
            return replace(side, turn_deg=float(round(abs(degrees) / 5.0) * 5))
        track_deg = target.track_rad / DEGREE + degrees - self._variation_deg
        heading_deg = round(track_deg / HEADING_STEP_DEG) * HEADING_STEP_DEG % 360.0
        return replace(side, action="heading", heading_deg=heading_deg or 360.0)

    def _position(self, own: Target, traffic: Target) -> str:
        """Return where traffic is, from an aircraft that goes where it points."""
        motion = relative(own, traffic)
        from_nose_deg = (math.atan2(motion.east_m, motion.north_m) - own.track_rad) / DEGREE % 360.0
        clock = round(from_nose_deg / 30.0) % 12 or 12
        distance_nm = round(motion.distance_m / NAUTICAL_MILE)
        return speak_traffic(clock, distance_nm, self._style)


def _is_for_flight(action: Recommendation) -> bool:
    return isinstance(action, Climb | MaintainLevel | Turn)


def _level(sense: Sense, altitude_ft: float) -> Instruction:
    rounded_ft = round(altitude_ft / LEVEL_STEP_FT) * LEVEL_STEP_FT
    return Instruction("altitude", sense=sense, altitude_ft=rounded_ft)
