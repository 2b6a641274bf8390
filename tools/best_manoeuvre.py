r"""Tells how much separation any manoeuvre of one aircraft could keep, by when it begins.

    airhilt cosim --scenario s02b_emergency_descent --assistant none --no-cameras --no-speech \
        --latency fixed --out runs/none
    python tools/best_manoeuvre.py runs/none --by UAL9 --past AAL123 --known-at 24.9

The other aircraft flies as it did in the run. The one that gives way turns with 25 degrees of bank
and climbs or descends at the greatest rates of its type, both at once. It rolls as fast as its type
does, and pitches with 0.25 g. Separation is in units of the minima, and is lost below 1.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

import standard_output
from airhilt.assistant.decision.manoeuvres import (
    BANK_RAD,
    TIMES_S,
    Manoeuvre,
    Paths,
    paths,
    separations,
)
from airhilt.geodesy.relative_motion import Minima, Relative, VerticalProfile
from airhilt.geodesy.wgs84 import offset_m
from airhilt.messages import ActorTruth, Briefing
from airhilt.record import open_run
from airhilt.units import (
    DEGREE,
    FOOT,
    FOOT_PER_MINUTE,
    NAUTICAL_MILE,
    SECOND_NS,
    STANDARD_GRAVITY,
)
from airhilt.world.flight import AircraftType, load_aircraft_type

TURNS_DEG = sorted(range(-90, 91, 15), key=abs)
DELAYS_S = (0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 7.5, 10.0)
VERTICAL_ACCELERATION = 0.25 * STANDARD_GRAVITY
"""Vertical acceleration of the standard pilot of TCAS II, in m/s2 (ICAO Annex 10, volume IV)."""
OUT_OF_REACH_M = 20_000.0
"""Height above or below the present level, in m, that nobody gets to."""


class Best(NamedTuple):
    """The best manoeuvre that begins some time after something was known."""

    delay_s: float
    separation: float
    turn_deg: float
    rate_fpm: float


def main() -> None:
    """Print the best manoeuvre for each delay."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("run", type=Path, help="folder of a run in which nobody reacted")
    parser.add_argument("--by", required=True, help="callsign of who gives way")
    parser.add_argument("--past", required=True, help="callsign of the other one")
    parser.add_argument("--known-at", type=float, required=True, help="time of the first evidence")
    given = parser.parse_args()
    print("begins after   best separation   manoeuvre")
    for each in best_manoeuvres(given.run, given.by, given.past, given.known_at):
        flown = f"turn by {each.turn_deg:.0f} degrees, {each.rate_fpm:+.0f} ft/min"
        print(f"{each.delay_s:10.1f} s {each.separation:17.2f}   {flown}")


def best_manoeuvres(run: Path, by: str, past: str, known_at_s: float) -> list[Best]:
    """Return the best manoeuvre of one aircraft for each delay after a time of a run."""
    recorded = open_run(run)
    flown: dict[str, list[ActorTruth]] = {by: [], past: []}
    for logged in recorded.log():
        if logged.key == "briefing":
            minima = _minima(Briefing.model_validate_json(logged.data))
        callsign = logged.key.removeprefix("truth/state/")
        if callsign in flown and callsign != logged.key:
            flown[callsign].append(ActorTruth.model_validate_json(logged.data))
    (kind,) = (
        actor["aircraft"] for actor in recorded.info.scenario["actors"] if actor["callsign"] == by
    )
    own = next(each for each in flown[by] if each.t_ns >= known_at_s * SECOND_NS)
    other = _recorded(own, flown[past])
    return [_best(own, load_aircraft_type(kind), other, minima, delay_s) for delay_s in DELAYS_S]


def _best(
    own: ActorTruth, kind: AircraftType, other: Paths, minima: Minima, delay_s: float
) -> Best:
    """Return the manoeuvre that keeps most, of all turns with all rates."""
    speeds, roll = kind.speeds, kind.gains.roll
    rates_fpm = (0.0, speeds.maximum_climb_rate_fpm, -speeds.maximum_descent_rate_fpm)
    roll_s = BANK_RAD / (roll.bank_rate_limit_deg_s * DEGREE)
    motion = Relative(0.0, 0.0, own.velocity_north_m_s, own.velocity_east_m_s)
    level = VerticalProfile(own.altitude_m, 0.0)
    best: Best | None = None
    for rate_fpm in rates_fpm:
        rate_m_s = abs(rate_fpm) * FOOT_PER_MINUTE
        target_m = own.altitude_m + math.copysign(OUT_OF_REACH_M, rate_fpm) if rate_fpm else None
        options = [Manoeuvre(target_m, rate_m_s, turn * DEGREE) for turn in TURNS_DEG]
        # A steady change of bank or of rate is as good as a sudden one at half its time.
        turned = paths(motion, level, options, delay_s + 0.5 * roll_s)
        climbed = paths(motion, level, options, delay_s + 0.5 * rate_m_s / VERTICAL_ACCELERATION)
        flown = turned._replace(altitude_m=climbed.altitude_m)
        steps = other.north_m.shape[-1]
        kept = separations(Paths(*(values[:, :steps] for values in flown)), other, minima)
        row = int(np.argmax(kept))
        if best is None or kept[row] > best.separation:
            best = Best(delay_s, float(kept[row]), TURNS_DEG[row], rate_fpm)
    assert best is not None
    return best


def _recorded(own: ActorTruth, states: Sequence[ActorTruth]) -> Paths:
    """Return the path that an aircraft flew, as seen from where another one was, to its end."""
    times_s = np.array([(each.t_ns - own.t_ns) / SECOND_NS for each in states])
    here = own.latitude_deg * DEGREE, own.longitude_deg * DEGREE
    places = [
        (
            *offset_m(here, (each.latitude_deg * DEGREE, each.longitude_deg * DEGREE)),
            each.altitude_m,
        )
        for each in states
    ]
    asked_s = TIMES_S[times_s[-1] >= TIMES_S]
    return Paths(
        *(np.interp(asked_s, times_s, each)[None, :] for each in zip(*places, strict=True))
    )


def _minima(briefing: Briefing) -> Minima:
    return Minima(
        briefing.horizontal_separation_nm * NAUTICAL_MILE, briefing.vertical_separation_ft * FOOT
    )


if __name__ == "__main__":
    standard_output.run(main)
