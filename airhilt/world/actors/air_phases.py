"""Phases of flight in which a crew refuses commands for the air, and why."""

from __future__ import annotations

from airhilt.commands import (
    AltitudeCommand,
    ApproachCommand,
    CancelLandingCommand,
    Command,
    CrossFixCommand,
    DirectCommand,
    DriftDownCommand,
    EmergencyDescentCommand,
    ExtendCommand,
    GoAroundCommand,
    HoldAtCommand,
    JoinCommand,
    LandCommand,
    MachCommand,
    OrbitCommand,
    ResumeRouteCommand,
    ResumeSpeedCommand,
    ReturnToFieldCommand,
    RouteCommand,
    ShortApproachCommand,
    SideStepCommand,
    SpeedCommand,
    TrackCommand,
    TurnCommand,
    VerticalRateCommand,
)
from airhilt.units import FOOT
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.flight.procedures.en_route import DriftDown, EmergencyDescent

LATERAL = (TrackCommand, TurnCommand, RouteCommand, ResumeRouteCommand, DirectCommand)
"""Commands for a way over the ground."""
SPEEDS = (SpeedCommand, MachCommand, ResumeSpeedCommand)
VERTICAL = (AltitudeCommand, VerticalRateCommand, CrossFixCommand)
PATTERNS = (OrbitCommand, HoldAtCommand)
EMERGENCIES = (DriftDownCommand, EmergencyDescentCommand)
TO_A_RUNWAY = (
    LandCommand,
    CancelLandingCommand,
    ApproachCommand,
    SideStepCommand,
    JoinCommand,
    ExtendCommand,
    ShortApproachCommand,
    ReturnToFieldCommand,
)
FOR_THE_AIR = (
    *LATERAL, *SPEEDS, *VERTICAL, *PATTERNS, *EMERGENCIES, *TO_A_RUNWAY, GoAroundCommand,
)  # fmt: skip
LAST_TURN_M = 400.0 * FOOT
"""Height in m below which an approach is not left for a turn: the least height of turns after a
takeoff (14 CFR 25.111(c)(4))."""


def refusal_in_phase(aircraft: Aircraft, command: Command) -> str | None:
    """Return why a command is not carried out in this phase of flight; None if it may be."""
    if not isinstance(command, FOR_THE_AIR):
        return None
    phase, state = aircraft.phase, aircraft.state
    if aircraft.on_ground:
        if phase == "rollout" and isinstance(command, GoAroundCommand):
            return None
        return (
            "unable, taking off"
            if phase in ("takeoff_roll", "rotate")
            else ("unable, on the ground")
        )
    if phase == "flare" and not isinstance(command, GoAroundCommand | LandCommand):
        return "unable, landing"
    if isinstance(command, EmergencyDescentCommand) and (
        command.altitude_ft * FOOT >= state.altitude_m
    ):
        return f"unable, below {command.altitude_ft:g} ft already"
    is_low = phase in ("approach", "glide") and state.height_agl_m < LAST_TURN_M
    if is_low and isinstance(command, (*LATERAL, *VERTICAL)):
        return "unable, on short final"
    if phase == EmergencyDescent.name:
        return _in_emergency_descent(aircraft, command)
    if phase == DriftDown.name:
        return _in_drift_down(aircraft, command)
    return None


def _in_emergency_descent(aircraft: Aircraft, command: Command) -> str | None:
    is_climb = isinstance(command, AltitudeCommand) and (
        command.altitude_ft * FOOT > aircraft.state.altitude_m
    )
    is_other = (*SPEEDS, *PATTERNS, *TO_A_RUNWAY, GoAroundCommand, VerticalRateCommand)
    if is_climb or isinstance(command, (*is_other, CrossFixCommand, DriftDownCommand)):
        return "unable, emergency descent"
    return None


def _in_drift_down(aircraft: Aircraft, command: Command) -> str | None:
    is_climb = isinstance(command, AltitudeCommand) and (
        command.altitude_ft * FOOT > aircraft.state.altitude_m
    )
    is_other = (*SPEEDS, *TO_A_RUNWAY, GoAroundCommand, VerticalRateCommand, CrossFixCommand)
    if is_climb or isinstance(command, is_other):
        return "unable, drifting down with an engine out"
    return None
