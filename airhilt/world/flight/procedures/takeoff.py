"""The takeoff: roll, rotation, climb-out; or a roll that is rejected; and the go-around."""

from __future__ import annotations

import math

from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT
from airhilt.world.flight.phases import AircraftSystems, FlightPhase
from airhilt.world.flight.procedures.en_route import EnRoute
from airhilt.world.flight.procedures.final import Final
from airhilt.world.flight.procedures.taxi import AT_REST_M_S, Standing
from airhilt.world.flight.state import AircraftState

LEVER_PER_S = 0.25
"""Rate at which takeoff thrust is set, in 1/s."""
ALIGNED_WITHIN = 15.0 * DEGREE
"""Greatest angle to the runway at which the roll may begin, in rad: the end of the turn onto it."""
SCREEN_HEIGHT_M = 35.0 * FOOT
"""Height at which the climb-out begins, in m (14 CFR 25.113(a)(1))."""
CLIMBING_M_S = 300.0 * FOOT_PER_MINUTE
"""Climb rate from which the gear is retracted, in m/s."""
CLIMB_SPEED_MARGIN_M_S = 10.0 * KNOT
"""Excess of the initial climb speed over V2 with all engines, in m/s: 10 to 20 kt (ICAO Doc 8168,
volume III, noise abatement departure climb)."""
FLAPS_UP_MARGIN_M_S = 20.0 * KNOT
"""Excess over V2 from which the flaps are retracted, in m/s."""
TURN_HEIGHT_M = 400.0 * FOOT
"""Least height of turns, in m (14 CFR 25.111(c)(4))."""
ACCELERATION_HEIGHT_M = 1000.0 * FOOT
"""Height in m at which takeoff thrust becomes climb thrust, and the aircraft accelerates and cleans
up. Not below 800 ft (FAA AC 91-53A; ICAO Doc 8168, volume III); 1,000 ft is usual."""
ACCELERATION_LEAD_M_S = 5.0
"""Lead of the commanded airspeed while the aircraft accelerates, in m/s: by the autopilot's law 4 %
of its weight then accelerates it, and what thrust is left climbs (assumed)."""
GREATEST_PITCH = 15.0 * DEGREE
"""Greatest pitch of a climb after takeoff, in rad: that which the flight directors of Boeings
command first (737 flight crew training manual, takeoff and go-around)."""
LEVERS_FIRST_S = 1.0
"""Time in s from the levers of a go-around to the pull. With the 2 s of a command that is called
(`airhilt.scenario.models.responses.CALL_S`) it is the 3 s that a pilot needs to react (ICAO Doc
8168, volume II, part I, section 4, chapter 6)."""
STOPPED_M_S = 300.0 * FOOT_PER_MINUTE
"""Climb rate from which the descent counts as stopped, in m/s."""
STOP_M_S2 = 1.5
"""Upward acceleration that stops the descent, in m/s2."""


def require_lined_up(state: AircraftState, line: Final) -> None:
    """Raise ValueError unless the aircraft is on the runway, and points along it."""
    runway = line.runway
    off, turn = abs(line.cross_track_m(state)), abs(line.crab_rad(state))
    rolled = line.along_m(state) + runway.displaced_m
    if off > runway.width_m / 2.0 or turn > ALIGNED_WITHIN:
        raise ValueError(
            f"take_off {off:.0f} m beside the centre line of runway {runway.ident} and "
            f"{math.degrees(turn):.0f} degrees off its course; expected lined up"
        )
    if not 0.0 <= rolled < runway.length_m:
        raise ValueError(
            f"take_off {rolled:.0f} m beyond the beginning of runway {runway.ident}; expected on "
            f"its {runway.length_m:.0f} m"
        )


class TakeoffRoll(FlightPhase):
    """Rolls along the centre line to rotation speed; ``then`` is the climb that follows."""

    name = "takeoff_roll"
    may_touch = True

    def __init__(self, systems: AircraftSystems, line: Final, then: EnRoute) -> None:
        self.line = line
        super().__init__(systems)
        self._then = then
        self._lever = 0.0
        kind = systems.kind
        self._takeoff_lever = kind.takeoff.lever
        self._rotate_at = kind.speeds.rotate_kt * KNOT
        systems.ground.reset()
        systems.airframe.set_brakes(0.0)
        systems.airframe.set_flaps(kind.takeoff.flaps)

    def fly(self, state: AircraftState) -> FlightPhase:
        """Roll one tick."""
        systems, line = self._systems, self.line
        self._lever = min(self._lever + LEVER_PER_S * systems.tick_s, self._takeoff_lever)
        systems.airframe.set_throttle(self._lever)
        if state.calibrated_airspeed_m_s >= self._rotate_at:
            return Rotate(systems, line, self._then, state).fly(state)
        systems.ground.lower_nose()
        systems.ground.follow_line(state, line.cross_track_m(state), line.course_rad(state))
        return self


class Rotate(FlightPhase):
    """Raises the nose, and holds it until the runway is safely below."""

    name = "rotate"
    commandable = True
    may_touch = True

    def __init__(
        self, systems: AircraftSystems, line: Final, then: EnRoute, state: AircraftState
    ) -> None:
        super().__init__(systems)
        self._line = line
        self._then = then
        takeoff = systems.kind.takeoff
        self._pitch = takeoff.pitch_deg * DEGREE
        self._pitch_rate = takeoff.pitch_rate_deg_s * DEGREE
        self._lever = takeoff.lever
        systems.autopilot.take_over(state, -takeoff.pull)

    def fly(self, state: AircraftState) -> FlightPhase:
        """Rotate one tick."""
        systems, line = self._systems, self._line
        if systems.airframe.main_wheel_height_m(state) > SCREEN_HEIGHT_M:
            return ClimbOut(systems, line, self._then).fly(state)
        turn_rate = None
        if systems.airframe.on_ground():
            systems.ground.follow_line(state, line.cross_track_m(state), line.course_rad(state))
        else:
            turn_rate = line.turn_rate(state)
        systems.autopilot.rotate(state, self._pitch, self._pitch_rate, turn_rate, self._lever)
        return self


class ClimbOut(FlightPhase):
    """Climbs at takeoff thrust, then accelerates, cleans up and climbs at climb thrust.

    It levels off into what follows.
    """

    name = "climb_out"
    commandable = True

    def __init__(self, systems: AircraftSystems, line: Final, then: EnRoute) -> None:
        super().__init__(systems)
        self._line = line
        self._then = then
        self._clean_up = CleanUp(systems)

    def fly(self, state: AircraftState) -> FlightPhase:
        """Climb one tick."""
        systems, then = self._systems, self._then
        if state.vertical_rate_m_s > CLIMBING_M_S:
            systems.airframe.set_gear(0.0)
        if then.vertical.captures(state):
            systems.airframe.clean_up()
            return then.fly(state)
        lateral = then.lateral if state.height_agl_m > TURN_HEIGHT_M else self._line
        turn_rate = lateral.turn_rate(state)
        if self._clean_up.is_due(state):
            self._clean_up.fly(state, turn_rate, then.speed.airspeed(state))
        else:
            climb_on_pitch(
                systems, state, turn_rate, self._clean_up.speed, systems.kind.takeoff.lever
            )
        return self


class CleanUp:
    """The climb from the acceleration height: climb thrust, acceleration, flaps up."""

    def __init__(self, systems: AircraftSystems) -> None:
        self._systems = systems
        self._safety_speed = systems.kind.speeds.climb_safety_kt * KNOT
        self.speed = self._safety_speed + CLIMB_SPEED_MARGIN_M_S
        """Calibrated airspeed of the climb before, in m/s."""
        self._has_begun = False

    def is_due(self, state: AircraftState) -> bool:
        """Return whether the acceleration height has been reached."""
        self._has_begun = self._has_begun or state.height_agl_m > ACCELERATION_HEIGHT_M
        return self._has_begun

    def fly(self, state: AircraftState, turn_rate: float, airspeed: float) -> None:
        """Accelerate towards an airspeed for one tick."""
        systems, flown = self._systems, state.calibrated_airspeed_m_s
        if flown > self._safety_speed + FLAPS_UP_MARGIN_M_S:
            systems.airframe.set_flaps(0.0)
        asked = max(self.speed, min(airspeed, flown + ACCELERATION_LEAD_M_S))
        climb_on_pitch(systems, state, turn_rate, asked, systems.kind.takeoff.climb_lever)


def climb_on_pitch(
    systems: AircraftSystems, state: AircraftState, turn_rate: float, airspeed: float, lever: float
) -> None:
    """Hold an airspeed with pitch, up to the greatest and never down, for one tick.

    Without one of its engines it does so at full thrust, which a crew may set then (FAA AC 25-13).
    """
    autopilot = systems.autopilot
    if systems.airframe.has_failed_engine():
        lever = 1.0
    steepest = GREATEST_PITCH - autopilot.level_angle_of_attack
    autopilot.fly_on_pitch(
        state, turn_rate, airspeed, lever, steepest_climb=steepest, steepest_descent=0.0
    )


class RejectedTakeoff(FlightPhase):
    """Idle, brakes, and to a stand on the centre line."""

    name = "rejected_takeoff"
    may_touch = True

    def __init__(self, systems: AircraftSystems, line: Final) -> None:
        super().__init__(systems)
        self._line = line
        self._deceleration = systems.kind.takeoff.rejected_deceleration_m_s2
        systems.ground.reset()
        systems.airframe.set_throttle(0.0)
        systems.airframe.set_speed_brakes(1.0)
        systems.airframe.set_ground_spoilers(1.0)

    def fly(self, state: AircraftState) -> FlightPhase:
        """Brake one tick."""
        systems, line = self._systems, self._line
        if state.ground_speed_m_s < AT_REST_M_S:
            systems.airframe.set_speed_brakes(0.0)
            systems.airframe.set_ground_spoilers(0.0)
            return Standing(systems).fly(state)
        systems.ground.lower_nose()
        systems.ground.follow_line(state, line.cross_track_m(state), line.course_rad(state))
        systems.ground.slow_down(state, self._deceleration)
        return self


class GoAround(FlightPhase):
    """Goes around, cleans up, and levels off into what follows; from a flare it may touch.

    Up to the acceleration height it climbs at the rate of what follows: autothrottles hold 1,000 to
    2,000 ft/min (737 flight crew training manual, go-around).
    """

    name = "go_around"
    commandable = True

    def __init__(self, systems: AircraftSystems, then: EnRoute, *, may_touch: bool = False) -> None:
        super().__init__(systems)
        self.may_touch = may_touch
        self._then = then
        self._clean_up = CleanUp(systems)
        self._flown_s = 0.0
        self._stopped = False

    def fly(self, state: AircraftState) -> FlightPhase:
        """Fly one tick."""
        autopilot, airframe, then = self._systems.autopilot, self._systems.airframe, self._then
        takeoff = self._systems.kind.takeoff
        turn_rate = then.lateral.turn_rate(state)
        self._flown_s += self._systems.tick_s
        if not self._stopped:
            rate, pull = state.vertical_rate_m_s, 0.0
            if self._flown_s > LEVERS_FIRST_S:
                rate, pull = STOPPED_M_S, STOP_M_S2
            autopilot.flare(state, turn_rate, rate, pull, takeoff.lever, None)
            if state.vertical_rate_m_s >= STOPPED_M_S:
                self._stopped = True
                airframe.set_gear(0.0)
                airframe.set_flaps(takeoff.flaps)
            return self
        if then.vertical.captures(state):
            airframe.clean_up()
            return then.fly(state)
        if self._clean_up.is_due(state):
            self._clean_up.fly(state, turn_rate, then.speed.airspeed(state))
        else:
            rate = then.vertical.vertical_rate(state)
            autopilot.fly(state, turn_rate, rate, self._clean_up.speed, closely=True)
        return self
