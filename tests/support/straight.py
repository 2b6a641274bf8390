"""Aircraft that fly straight, with all that the monitor reads of a real one."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from airhilt.geodesy.relative_motion import Minima
from airhilt.shapes.sizes import Dimensions
from airhilt.units import FOOT, FOOT_PER_MINUTE, NAUTICAL_MILE, SECOND_NS
from airhilt.world.flight import AircraftState, load_aircraft_type
from airhilt.world.mover import carried_on
from airhilt.world.site import FixedSite
from airhilt.world.truth.conflicts import ConflictMonitor, PairTruth

MINIMA = Minima(5 * NAUTICAL_MILE, 1000 * FOOT)
EARTH_RADIUS_M = 6_378_137.0
B737 = load_aircraft_type("737")


@dataclass
class Straight:
    """Begins some metres east of 0 N 0 E, and flies straight on at a steady rate of climb."""

    east_m: float = 0.0
    north_m: float = 0.0
    altitude_ft: float = 35_000.0
    east_m_s: float = 0.0
    north_m_s: float = 0.0
    rate_fpm: float = 0.0
    target_ft: float | None = None
    kind: Any = B737
    ended: str | None = None
    on_ground: bool = False
    phase: str = "en_route"

    def __post_init__(self) -> None:
        altitude_m = self.altitude_ft * FOOT
        radius = EARTH_RADIUS_M + altitude_m
        self.state = AircraftState(
            latitude_rad=self.north_m / (6_335_439.0 + altitude_m),
            longitude_rad=self.east_m / radius,
            altitude_m=altitude_m,
            height_agl_m=altitude_m,
            velocity_north_m_s=self.north_m_s,
            velocity_east_m_s=self.east_m_s,
            velocity_down_m_s=-self.rate_fpm * FOOT_PER_MINUTE,
            roll_rad=0.0,
            pitch_rad=0.0,
            heading_rad=math.atan2(self.east_m_s, self.north_m_s) % (2 * math.pi),
            true_airspeed_m_s=math.hypot(self.east_m_s, self.north_m_s),
            calibrated_airspeed_m_s=140.0,
            mach=0.78,
            ecef_x_m=0.0,
            ecef_y_m=0.0,
            ecef_z_m=0.0,
        )

    @property
    def dimensions(self) -> Any:
        return self.kind.dimensions

    @property
    def target_altitude_m(self) -> float:
        return self.state.altitude_m if self.target_ft is None else self.target_ft * FOOT

    @property
    def target_vertical_rate_m_s(self) -> float:
        return self.rate_fpm * FOOT_PER_MINUTE

    def advance(self, step_s: float) -> None:
        moved = carried_on(self.state, step_s)
        self.state = moved._replace(height_agl_m=moved.altitude_m)


class Rolling(Straight):
    """A vehicle that drives straight on."""

    @property
    def dimensions(self) -> Dimensions:
        return Dimensions(length_m=5.0, span_m=2.0, height_m=2.0)

    def __init__(self, east_m: float = 0.0, north_m: float = 0.0, **motion: Any) -> None:
        super().__init__(east_m, north_m, 0.0, on_ground=True, phase="driving", **motion)
        self.kind = None


class Watch:
    """A monitor over some aircraft, and what it has told."""

    def __init__(
        self, *aircraft: Straight, tick_s: float = 0.05, minima: Minima = MINIMA,
        always: bool = True, ground_m: float = 0.0, zone: FixedSite | None = None,
        names: Sequence[str] = "ABCDEF",
        transponders: frozenset[str] | None = None,
    ) -> None:  # fmt: skip
        self.aircraft: dict[str, Any] = dict(zip(names, aircraft, strict=False))
        self.tick_s = tick_s
        self.told: dict[str, float] = {}
        self.distances: dict[str, tuple[float, float]] = {}
        self.now_ns = 0
        self.monitor = ConflictMonitor(
            {name: body for name, body in self.aircraft.items() if body.kind is not None},
            {name: body for name, body in self.aircraft.items() if body.kind is None},
            minima,
            ground_m,
            zone,
            tick_s,
            frozenset(self.aircraft) if transponders is None else transponders,
            frozenset({(names[0], names[1])} if always else ()),
            self._became_true,
        )

    def _became_true(
        self, phase: str, pair: tuple[str, str], horizontal: float, vertical: float
    ) -> None:
        assert phase not in self.told or pair != ("A", "B")
        self.told[phase] = self.now_ns / SECOND_NS
        self.distances[phase] = (horizontal, vertical)

    def ticks(self, seconds: float) -> Iterator[float]:
        """Fly on, and yield the time after every tick."""
        step_ns = round(self.tick_s * SECOND_NS)
        for _ in range(round(seconds / self.tick_s)):
            self.now_ns += step_ns
            for craft in self.aircraft.values():
                if craft.ended is None:
                    craft.advance(self.tick_s)
            self.monitor.tick(self.now_ns)
            yield self.now_ns / SECOND_NS

    def fly(self, seconds: float) -> Watch:
        for _ in self.ticks(seconds):
            pass
        return self

    @property
    def truth(self) -> PairTruth:
        return self.monitor.pairs[("A", "B")]


@dataclass
class Performing:
    """An actor with a body that flies straight."""

    body: Straight
    bound_runway: str | None = None
    category: str = "aircraft"
