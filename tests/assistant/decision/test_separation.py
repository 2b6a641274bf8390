"""The watch over separation believes what aircraft do, not what they were told to do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from airhilt.assistant.decision.air_tracks import AirTracks, Reach
from airhilt.engine_families import ASSISTANTS
from airhilt.geodesy.wgs84 import displaced
from airhilt.messages import AdsbReport, Advisory, Severity
from airhilt.units import KNOT, SECOND_NS
from breadth import mostly_slow
from encounters import Encounter, Flight, State, head_on
from judge_encounters import judged
from pairs.flying import fly
from pairs.geometry import draw


@pytest.mark.parametrize(("encounters", "losses"), mostly_slow([(10, 1), (40, 5)], (10, 1)))
def test_random_losses_are_warned_of_in_time_though_nobody_reacts(
    encounters: int, losses: int
) -> None:
    outcomes = [
        fly(draw(np.random.default_rng((11, number))), ASSISTANTS.create("reference"), number)
        for number in range(encounters)
    ]
    numbers = judged(outcomes)
    assert numbers["losses"] >= losses
    assert numbers["losses_missed"] == []
    assert numbers["warning_late"] == []
    assert numbers["warning_late_for_the_manoeuvre"] == []


@pytest.mark.parametrize("track_deg", [0.0, 90.0, 180.0])
def test_a_loss_is_told_three_two_and_one_minutes_ahead_whatever_the_direction(
    track_deg: float,
) -> None:
    """Two that meet after 230 s lose 5 NM at 480 knots each some 19 s before."""
    encounter = head_on(160.0, track_deg=track_deg + 180.0)
    encounter.flights[0] = Flight("AAL123", "a1b2c3", track_deg, 30.7, 35_000.0)
    first: dict[Severity, float] = {}
    for t_s, advisory in encounter.fly().told:
        if advisory.recipient == "ATC":
            first.setdefault(advisory.severity, t_s)
    lost_s = (61.4 - 5.0) / (960.0 / 3600.0)
    ahead_s = [lost_s - t_s for t_s in first.values()]
    assert list(first) == [Severity.ADVISORY, Severity.CAUTION, Severity.WARNING]
    assert ahead_s == pytest.approx([180.0, 120.0, 60.0], abs=3.0)


def climbs_through(target_ft: float, seed: int) -> Encounter:
    """One climbs through the level of another, which it meets on the way."""
    encounter = head_on(300.0, seed)
    encounter.flights[0].altitude_ft = 29_000.0
    encounter.flights[0].climb(target_ft, 1600.0)
    return encounter


@pytest.mark.parametrize("seed", mostly_slow(range(3), 0))
def test_a_level_that_was_recommended_is_not_taken_for_one_that_is_flown_to(seed: int) -> None:
    encounter = climbs_through(39_000.0, seed).fly()
    warned = [t_s for t_s, advisory in encounter.told if advisory.severity is Severity.WARNING]
    told = [t_s for t_s, advisory in encounter.told if advisory.severity is Severity.CAUTION]
    assert told[0] < warned[0]
    assert warned[0] <= 185.0 - 30.0


class Turning(Flight):
    """Turns away, and back to where it flew after a while."""

    away_s = (100.0, 150.0)

    def state(self, time_s: float) -> State:
        state = super().state(time_s)
        begin_s, end_s = self.away_s
        if not begin_s <= time_s < end_s:
            return state
        aside_s = min(time_s - begin_s, end_s - time_s)
        south_m_s = 0.7 * self.speed_kt * KNOT
        place = (state.latitude_rad, state.longitude_rad)
        latitude_rad, _ = displaced(place, -south_m_s * aside_s, 0.0, state.altitude_m)
        north_m_s = -south_m_s if time_s < (begin_s + end_s) / 2.0 else south_m_s
        return replace(state, latitude_rad=latitude_rad, velocity_north_m_s=north_m_s)


def test_a_conflict_is_not_over_because_a_turn_opens_the_miss_distance_for_a_while() -> None:
    encounter = head_on(300.0)
    turning = Turning("DAL456", "a4d5e6", 270.0, 30.7, 35_000.0)
    encounter.flights[1] = turning
    encounter.fly()
    over = [t_s for t_s, advisory in encounter.told if not advisory.active]
    assert min(over) > 230.0
    again = [
        advisory.severity
        for t_s, advisory in encounter.told
        if advisory.recipient == "ATC" and t_s > turning.away_s[1]
    ]
    assert again[:2] == [Severity.CAUTION, Severity.WARNING]


@pytest.mark.parametrize("late_s", [5.0, 20.0])
def test_reports_that_are_late_warn_as_well_as_fresh_ones(late_s: float) -> None:
    fresh, late = head_on(240.0).fly(), head_on(240.0)
    late.late_s = late_s
    late.fly()

    def cautions(encounter: Encounter) -> list[float]:
        return [t_s for t_s, told in encounter.told if _is_first(told, Severity.CAUTION)]

    assert cautions(late)[0] == pytest.approx(cautions(fresh)[0], abs=6.0)


def _is_first(advisory: Advisory, severity: Severity) -> bool:
    return advisory.active and advisory.severity is severity


def report(t_s: float, altitude_ft: float, rate_fpm: float) -> AdsbReport:
    t_ns = round(t_s * SECOND_NS)
    return AdsbReport(
        t_ns=t_ns, icao24="a1b2c3", callsign="AAL123", latitude_deg=38.9, longitude_deg=-77.0,
        altitude_ft=altitude_ft, ground_speed_kt=480.0, track_deg=90.0, vertical_rate_fpm=rate_fpm,
        nacp=9, nacv=2, receiver="all", t_adsb_in_ns=t_ns, t_adsb_out_ns=t_ns,
    )  # fmt: skip


def test_the_track_of_an_aircraft_that_has_landed_is_dropped_though_it_still_reports() -> None:
    tracks = AirTracks()
    tracks.take_report(report(0.0, 2_000.0, -700.0), 0)
    for t_s in range(1, 30):
        landed = report(float(t_s), 0.0, 0.0).model_copy(
            update={"altitude_ft": None, "on_ground": True}
        )
        tracks.take_report(landed, t_s * SECOND_NS)
    tracks.pairs_with_news(29 * SECOND_NS, Reach(0.0, 0.0, 0.0), 15.0, ())
    assert list(tracks) == []
