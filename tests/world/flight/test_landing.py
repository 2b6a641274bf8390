"""An aircraft lands where and as softly as it should, and leaves the runway."""

from __future__ import annotations

import math
from typing import Any

import pytest

from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, NAUTICAL_MILE
from airhilt.world.flight import Atmosphere
from airhilt.world.flight.aircraft import Aircraft
from airhilt.world.flight.procedures.final import Final
from airhilt.world.surface.runway import RunwayEnd
from breadth import mostly_slow
from flights import RUNWAY, along_runway, on_final, states

TURBULENCE = Atmosphere(turbulence_wind_at_20ft_m_s=15 * KNOT, turbulence_severity=3)
TOUCHDOWN_ZONE_M = 3_000 * FOOT
"""FAA Pilot/Controller Glossary."""
JOINING = {"737": (10.0, 220), "B747": (12.0, 230), "c172p": (5.0, 95), "c310": (7.0, 140)}
"""From where (NM) and how fast (kt) the final approach is joined."""
SOFT_FPM = {"737": 250, "B747": 250, "c172p": 200, "c310": 200}


def wind_from_left(knots: int, runway: RunwayEnd) -> Atmosphere:
    course = runway.course_rad
    return Atmosphere(-knots * KNOT * math.sin(course), knots * KNOT * math.cos(course))


class Landing:
    """What a landing was like, in the units of the targets."""

    def __init__(
        self,
        aircraft: Aircraft,
        runway: RunwayEnd,
        exit_path: list[tuple[float, float]] | tuple[Any, ...] = (),
    ) -> None:
        final = Final(runway, aircraft.kind)
        aircraft.procedures.land(runway, exit_path)
        self.phases = [aircraft.phase]
        self.touchdown = None
        sink_m_s = 0.0
        self.bounce_m = self.off_centre_m = self.off_glide_path_m = 0.0
        for state in states(aircraft, 400):
            if aircraft.phase != self.phases[-1]:
                self.phases.append(aircraft.phase)
            on_ground = aircraft.on_ground
            if self.touchdown is None:
                if on_ground:
                    self.touchdown = state
                    self.touchdown_m = final.along_m(state)
                    self.sink_fpm = sink_m_s / FOOT_PER_MINUTE
                elif aircraft.phase == "glide" and final.along_m(state) < -100.0:
                    off = abs(final.above_glide_path_m(state))
                    self.off_glide_path_m = max(self.off_glide_path_m, off)
            elif aircraft.phase == "rollout":
                self.off_centre_m = max(self.off_centre_m, abs(final.cross_track_m(state)))
                if not on_ground:
                    height = aircraft._airframe.main_wheel_height_m(state)
                    self.bounce_m = max(self.bounce_m, height)
            sink_m_s = state.velocity_down_m_s
            if aircraft.phase == "standing" or aircraft.ended:
                break
        self.ended = aircraft.ended
        self.state = state


@pytest.mark.parametrize("wind_kt", mostly_slow([0, 15, -15], 0, -15))
def test_it_lands_in_the_touchdown_zone_and_stops_on_the_centre_line(
    name: str, wind_kt: int
) -> None:
    aircraft = on_final(name, atmosphere=wind_from_left(wind_kt, RUNWAY))
    landing = Landing(aircraft, RUNWAY)
    assert landing.ended is None
    assert landing.phases == ["glide", "flare", "rollout", "standing"]
    assert 0.0 < landing.touchdown_m < TOUCHDOWN_ZONE_M
    assert landing.sink_fpm < SOFT_FPM[name]
    assert landing.off_glide_path_m < 10 * FOOT
    assert landing.bounce_m < 2 * FOOT
    assert landing.off_centre_m < 20 * FOOT
    assert landing.state.ground_speed_m_s < 1.0


@pytest.mark.parametrize("seed", mostly_slow([1, 2], 1))
def test_turbulence_moves_the_touchdown_but_not_out_of_the_zone(name: str, seed: int) -> None:
    landing = Landing(on_final(name, atmosphere=TURBULENCE, seed=seed), RUNWAY)
    assert landing.ended is None
    assert landing.off_glide_path_m > 1 * FOOT
    assert 0.0 < landing.touchdown_m < TOUCHDOWN_ZONE_M
    assert landing.sink_fpm < SOFT_FPM[name]
    assert landing.bounce_m < 2 * FOOT
    assert landing.off_centre_m < 20 * FOOT


def test_it_leaves_the_runway_at_the_exit_and_stands_at_its_end(name: str) -> None:
    exit_m = 1_900.0 if name in {"737", "B747"} else 800.0
    curve = [
        along_runway(exit_m + 30 * math.sin(a * DEGREE), 30 * (1 - math.cos(a * DEGREE)))
        for a in range(0, 91, 10)
    ]
    exit_path = [*curve, along_runway(exit_m + 30, 150)]
    landing = Landing(on_final(name), RUNWAY, exit_path)
    assert landing.phases == ["glide", "flare", "rollout", "vacate", "standing"]
    final = Final(RUNWAY, on_final(name).kind)
    assert final.along_m(landing.state) == pytest.approx(exit_m + 30, abs=2.0)
    assert final.cross_track_m(landing.state) == pytest.approx(150, abs=3.0)


def test_it_joins_the_final_approach_from_the_side_clean_and_fast(name: str) -> None:
    distance_nm, airspeed_kt = JOINING[name]
    aircraft = on_final(
        name,
        distance_nm=distance_nm,
        offset_m=0.15 * distance_nm * NAUTICAL_MILE,
        altitude_m=0.045 * distance_nm * NAUTICAL_MILE,
        airspeed_kt=airspeed_kt,
        on_approach=False,
    )
    landing = Landing(aircraft, RUNWAY)
    assert landing.ended is None
    assert landing.phases[:3] == ["glide", "flare", "rollout"]
    assert 0.0 < landing.touchdown_m < TOUCHDOWN_ZONE_M
    assert landing.sink_fpm < SOFT_FPM[name]


def test_side_stepping_it_lands_on_the_parallel_runway(parallel_runway: RunwayEnd) -> None:
    aircraft = on_final("737", distance_nm=5.0)
    aircraft.procedures.land(RUNWAY)
    *_, _ = states(aircraft, 10)
    aircraft.procedures.side_step(parallel_runway)
    landing = Landing(aircraft, parallel_runway)
    assert landing.ended is None
    assert landing.sink_fpm < SOFT_FPM["737"]
    assert landing.off_centre_m < 20 * FOOT


def test_who_is_not_on_an_approach_cannot_side_step(parallel_runway: RunwayEnd) -> None:
    with pytest.raises(ValueError, match="side_step in phase en_route; expected glide"):
        on_final("737").procedures.side_step(parallel_runway)
