"""Ways to a final approach in sight of the runway, and an orbit on the way.

Visual manoeuvring and traffic circuits: the aircraft follows a curve that ends at the threshold, at
the height of its glide path along that curve as soon as this is below the height that it holds.
"""

from __future__ import annotations

from collections.abc import Sequence

from airhilt.geodesy.wgs84 import Place
from airhilt.units import DEGREE, wrap_angle
from airhilt.world.flight.guidance import Airspeed, Altitude, CurvedPath
from airhilt.world.flight.phases import AircraftSystems, FlightPhase
from airhilt.world.flight.procedures.final import Final
from airhilt.world.flight.procedures.landing import Glide
from airhilt.world.flight.procedures.preparation import Preparation
from airhilt.world.flight.state import AircraftState

BELOW_M = 30.0
"""Distance below the glide path within which the aircraft begins to descend along it, in m: what
its rate corrects at an airliner's approach speed."""
SETTLED_M = 20.0
"""Greatest distance from the centre line at which the turn onto it is over, in m; assumed. The law
of the final approach is as tight as small errors need, and swings to and fro with great ones."""
SETTLED_RAD = 3.0 * DEGREE
"""Greatest bank, and greatest angle to the course, at which that turn is over, in rad; assumed."""
SHORT_FINAL_M = 1000.0
"""Distance from the threshold within which the law of the final approach flies anyway, in m."""


class Approach(FlightPhase):
    """Flies a curve that ends at the threshold, and from its last line on the final approach.

    It descends with the glide path along the curve; one that ``keeps_level`` only on its last line.
    """

    name = "approach"

    def __init__(
        self,
        systems: AircraftSystems,
        final: Final,
        exit_path: Sequence[Place],
        path: CurvedPath,
        level: Altitude,
        preparation: Preparation,
        *,
        keeps_level: bool = False,
    ) -> None:
        super().__init__(systems)
        self.final = final
        self.exit_path = exit_path
        self._path = path
        self._level = level
        self._keeps_level = keeps_level
        self.preparation = preparation

    def leave_at(self, exit_path: Sequence[Place]) -> None:
        """Leave the runway by another path."""
        self.exit_path = exit_path

    def fly(self, state: AircraftState) -> FlightPhase:
        """Fly one tick."""
        systems, final = self._systems, self.final
        turn_rate = self._path.turn_rate(state)
        curve = self._path.curve
        to_go_m = curve.to_go_m
        is_below = final.above_glide_path_m(state, to_go_m) < -BELOW_M
        is_settled = self._is_settled(state) and not is_below
        if curve.is_on_last_piece and (is_settled or to_go_m < SHORT_FINAL_M):
            glide = Glide(systems, final, self.exit_path, state.altitude_m, self.preparation)
            return glide.fly(state)
        airspeed = self.preparation.airspeed_m_s(to_go_m)
        vertical_rate = self._level.vertical_rate(state)
        if not is_below and (curve.is_on_last_piece or not self._keeps_level):
            vertical_rate = min(vertical_rate, final.vertical_rate(state, to_go_m))
        systems.autopilot.fly(state, turn_rate, vertical_rate, airspeed)
        return self

    def _is_settled(self, state: AircraftState) -> bool:
        """Return whether it flies along the centre line."""
        angle = wrap_angle(state.track_rad - self.final.course_rad(state))
        is_along = max(abs(angle), abs(state.roll_rad)) < SETTLED_RAD
        return is_along and abs(self.final.cross_track_m(state)) < SETTLED_M


class Orbit(FlightPhase):
    """Flies a full turn at one altitude and airspeed, and goes on with the approach."""

    name = "orbit"

    def __init__(
        self,
        systems: AircraftSystems,
        path: CurvedPath,
        level: Altitude,
        speed: Airspeed,
        then: Glide | Approach,
    ) -> None:
        super().__init__(systems)
        self.then = then
        self._path = path
        self._level = level
        self._speed = speed

    def leave_at(self, exit_path: Sequence[Place]) -> None:
        """Leave the runway by another path."""
        self.then.leave_at(exit_path)

    @property
    def preparation(self) -> Preparation:
        """Preparation of the landing that it goes on with; its speed is flown after the turn."""
        return self.then.preparation

    @property
    def final(self) -> Final:
        """Final approach that it goes on with."""
        return self.then.final

    def fly(self, state: AircraftState) -> FlightPhase:
        """Fly one tick."""
        turn_rate = self._path.turn_rate(state)
        if self._path.curve.to_go_m <= 0.0:
            return self.then.fly(state)
        self._systems.autopilot.fly(
            state,
            turn_rate,
            self._level.vertical_rate(state),
            self._speed.airspeed(state),
        )
        return self
