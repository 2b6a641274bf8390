"""TCAS II speaks at the published thresholds (FAA, Introduction to TCAS II 7.1, table 2)."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.engine_families import ASSISTANTS
from airhilt.geodesy.relative_motion import Relative
from airhilt.surveillance import tcas
from airhilt.surveillance.tcas_resolution import (
    INCREASED_RATE_M_S,
    RATE_M_S,
    RESPONSE_S,
    Resolution,
    Sense,
    Vertical,
    is_insufficient,
    may_weaken,
    opposite,
    reversal,
    select,
    separation_m,
)
from airhilt.units import FOOT, FOOT_PER_MINUTE, NAUTICAL_MILE
from interrogation import Jet, Meeting

HIGH = 35_000 * FOOT
ALOFT = tcas.Own(HIGH, HIGH, HIGH)


def test_sensitivity_levels_are_those_of_the_table(subtests: pytest.Subtests) -> None:
    for altitude_ft, height_ft, level, traffic, resolution in [
        (900, 900, 2, (20, 0.30, 850), None),
        (999, 999, 2, (20, 0.30, 850), None),
        (6_000, 900, 2, (20, 0.30, 850), None),
        (2_000, 1_000, 3, (25, 0.33, 850), (15, 0.20, 600)),
        (2_000, 2_349, 3, (25, 0.33, 850), (15, 0.20, 600)),
        (3_000, 2_350, 4, (30, 0.48, 850), (20, 0.35, 600)),
        (4_999, 4_999, 4, (30, 0.48, 850), (20, 0.35, 600)),
        (5_000, 5_000, 5, (40, 0.75, 850), (25, 0.55, 600)),
        (9_999, 9_000, 5, (40, 0.75, 850), (25, 0.55, 600)),
        (10_000, 9_000, 6, (45, 1.00, 850), (30, 0.80, 600)),
        (19_999, 9_000, 6, (45, 1.00, 850), (30, 0.80, 600)),
        (20_000, 20_000, 7, (48, 1.30, 850), (35, 1.10, 700)),
        (41_999, 41_000, 7, (48, 1.30, 850), (35, 1.10, 700)),
        (42_000, 41_000, 7, (48, 1.30, 1200), (35, 1.10, 800)),
        (42_001, 42_001, 7, (48, 1.30, 1200), (35, 1.10, 800)),
    ]:
        with subtests.test(str((altitude_ft, height_ft, level, traffic, resolution))):
            row = tcas.sensitivity_level(altitude_ft * FOOT, height_ft * FOOT)

            def published(thresholds: tuple[int, float, int] | None) -> Any:
                return thresholds and pytest.approx(
                    (thresholds[0], thresholds[1] * NAUTICAL_MILE, thresholds[2] * FOOT)
                )

            assert row.level == level
            assert row.traffic == published(traffic)
            assert row.resolution == published(resolution)


def test_advisories_aim_at_the_separation_of_the_table(subtests: pytest.Subtests) -> None:
    """ALIM in table 2, from level 3 on."""
    for altitude_ft, height_ft, alim_ft in [
        (2_000, 1_000, 300),
        (3_000, 2_350, 300),
        (5_000, 5_000, 350),
        (10_000, 9_000, 400),
        (20_000, 20_000, 600),
        (42_001, 42_001, 700),
    ]:
        with subtests.test(str((altitude_ft, height_ft, alim_ft))):
            row = tcas.sensitivity_level(altitude_ft * FOOT, height_ft * FOOT)
            assert row.alim_m == pytest.approx(alim_ft * FOOT)


def head_on(seconds: float, closing_m_s: float = 500.0) -> Relative:
    """Two that meet in some seconds."""
    return Relative(closing_m_s * seconds, 0.0, -closing_m_s, 0.0)


def test_head_on_at_fl350_the_traffic_advisory_comes_48_s_before_and_the_resolution_35_s(
    subtests: pytest.Subtests,
) -> None:
    for seconds, said in [
        (60.0, None),
        (49.0, None),
        (47.9, "tcas_ta"),
        (36.0, "tcas_ta"),
        (34.9, "tcas_ra"),
    ]:
        with subtests.test(str((seconds, said))):
            assert tcas.alert(head_on(seconds), 0.0, 0.0, ALOFT) == said


@pytest.mark.parametrize("north_m", [300.0, 0.0, -300.0])
def test_the_range_is_the_distance_even_of_two_in_the_same_place(north_m: float) -> None:
    motion = tcas.RangeMotion.of(Relative(north_m, 0.0, -50.0, 0.0))
    assert motion.range_m == abs(north_m)
    assert motion.rate_m_s == (0.0 if north_m == 0.0 else math.copysign(50.0, -north_m))


def test_two_that_close_slowly_are_told_earlier_because_of_the_modified_tau() -> None:
    """With DMOD of 1.30 NM, 55 s at 100 m/s are a modified tau of 44.5 s, at 500 m/s of 54.6 s."""
    assert tcas.alert(head_on(55.0, closing_m_s=100.0), 0.0, 0.0, ALOFT) == "tcas_ta"
    assert tcas.alert(head_on(55.0, closing_m_s=500.0), 0.0, 0.0, ALOFT) is None


@pytest.mark.parametrize(("range_nm", "said"), [(1.31, None), (1.29, "tcas_ta"), (1.09, "tcas_ra")])
def test_within_dmod_it_speaks_even_if_the_two_draw_apart(
    range_nm: float, said: str | None
) -> None:
    apart = Relative(range_nm * NAUTICAL_MILE, 0.0, 10.0, 0.0)
    assert tcas.alert(apart, 0.0, 0.0, ALOFT) == said


def test_level_traffic_counts_within_the_altitude_threshold(subtests: pytest.Subtests) -> None:
    for gap_ft, said in [
        (0, "tcas_ra"),
        (700, "tcas_ra"),
        (701, "tcas_ta"),
        (850, "tcas_ta"),
        (851, None),
    ]:
        with subtests.test(str((gap_ft, said))):
            for gap in (gap_ft, -gap_ft):
                assert tcas.alert(head_on(30.0), gap * FOOT, 0.0, ALOFT) == said


def test_traffic_that_will_be_co_altitude_in_time_counts_and_that_which_leaves_does_not() -> None:
    gap = 2_000 * FOOT
    assert tcas.alert(head_on(30.0), gap, -gap / 34.0, ALOFT) == "tcas_ra"
    assert tcas.alert(head_on(30.0), gap, -gap / 40.0, ALOFT) == "tcas_ta"
    assert tcas.alert(head_on(30.0), gap, -gap / 50.0, ALOFT) is None
    assert tcas.alert(head_on(30.0), gap, gap / 34.0, ALOFT) is None
    assert tcas.alert(head_on(30.0), -gap, gap / 34.0, ALOFT) == "tcas_ra"


def test_near_the_ground_advisories_are_inhibited(subtests: pytest.Subtests) -> None:
    for height_ft, said in [(499, None), (500, "tcas_ta"), (999, "tcas_ta"), (1_000, "tcas_ra")]:
        with subtests.test(str((height_ft, said))):
            height = height_ft * FOOT
            own = tcas.Own(height, height, intruder_height_m=height)
            assert tcas.alert(head_on(5.0), 0.0, 0.0, own) == said


def test_an_intruder_on_the_ground_is_none(subtests: pytest.Subtests) -> None:
    for own_ft, intruder_ft, said in [
        (1_600, 300, None),
        (1_699, 379, None),
        (1_699, 380, "tcas_ra"),
        (1_700, 379, "tcas_ra"),
    ]:
        with subtests.test(str((own_ft, intruder_ft, said))):
            own = tcas.Own(own_ft * FOOT, own_ft * FOOT, intruder_ft * FOOT)
            assert tcas.alert(head_on(5.0), 0.0, 0.0, own) == said


def level(altitude_m: float) -> Callable[..., Any]:
    return lambda _: altitude_m


def test_a_projection_tells_when_it_would_speak_if_nobody_did_anything() -> None:
    projection = tcas.project(head_on(100.0), level(HIGH), level(HIGH), ground_m=0.0)
    assert projection == (52.0, 65.0)


@pytest.mark.parametrize("up", [1.0, -1.0])
@pytest.mark.parametrize("who", ["own", "other"])
def test_a_projection_follows_those_who_change_their_altitude(up: float, who: str) -> None:
    """They are 4,000 ft apart and will be at one altitude a moment before they meet."""

    def changing(time_s: float) -> float:
        return HIGH - up * 4_000 * FOOT * (1.0 - time_s / 99.9)

    own, other = (changing, level(HIGH)) if who == "own" else (level(HIGH), changing)
    assert tcas.project(head_on(100.0), own, other, ground_m=0.0) == (52.0, 65.0)


def test_a_projection_knows_heights_above_the_ground() -> None:
    """The ground is at 5,000 ft: the limits of 1,000 ft, and of 380 ft for who has landed."""
    ground_m = 5_000 * FOOT

    def projected(own_ft: float, other_ft: float) -> tcas.Projection:
        own, other = (level(ground_m + feet * FOOT) for feet in (own_ft, other_ft))
        return tcas.project(head_on(100.0), own, other, ground_m)

    assert (projected(900, 900).traffic_s is None, projected(900, 900).resolution_s) == (
        False,
        None,
    )
    assert projected(1_001, 1_001).resolution_s is not None
    assert projected(1_100, 370) == (None, None)
    assert projected(1_100, 390).traffic_s is not None


def test_a_projection_goes_20_minutes_ahead() -> None:
    assert tcas.project(head_on(1_247.0), level(HIGH), level(HIGH), 0.0) == (1_199.0, None)
    assert tcas.project(head_on(1_248.0), level(HIGH), level(HIGH), 0.0) == (None, None)


def test_two_that_keep_their_distance_are_not_told() -> None:
    abreast = Relative(2.0 * NAUTICAL_MILE, 0.0, 0.0, 0.0)
    assert tcas.alert(abreast, 0.0, 0.0, ALOFT) is None


def test_a_resolution_without_a_traffic_advisory_before_counts_as_both() -> None:
    projection = tcas.project(head_on(20.0), level(HIGH), level(HIGH), ground_m=0.0)
    assert projection == (0.0, 0.0)


def test_of_two_aircraft_the_one_that_speaks_first_counts() -> None:
    early, late = tcas.Projection(10.0, None), tcas.Projection(12.0, 20.0)
    assert tcas.earliest(early, late) == tcas.earliest(late, early) == (10.0, 20.0)


def test_the_sense_that_does_not_cross_the_intruder_is_chosen_if_it_gives_alim() -> None:
    """Though the other sense gives more: the intruder climbs from 100 ft below."""
    own, intruder = Vertical(HIGH, 0.0), Vertical(HIGH - 100 * FOOT, 250 * FOOT / 60.0)
    alim_m = 600 * FOOT
    crossing, other = (
        separation_m(own, intruder, Resolution(sense, RATE_M_S), 35.0, RESPONSE_S)
        for sense in ("descend", "climb")
    )
    assert crossing > other > alim_m
    chosen = select(own, intruder, 35.0, alim_m, required=None, may_descend=True)
    assert chosen == Resolution("climb", RATE_M_S)


def test_a_crew_responds_after_5_s_and_climbs_with_1_500_ft_min_or_an_increased_2_500() -> None:
    """ICAO Annex 10, volume IV, 4.4.2, and FAA, Introduction to TCAS II Version 7.1."""
    rates_fpm = [rate_m_s / FOOT_PER_MINUTE for rate_m_s in (RATE_M_S, INCREASED_RATE_M_S)]
    assert (RESPONSE_S, rates_fpm) == (5.0, pytest.approx([1_500.0, 2_500.0]))


@pytest.mark.parametrize("sense", ["climb", "descend"])
def test_an_advisory_that_is_carried_out_is_insufficient_if_it_gives_less_than_alim(
    sense: Sense,
) -> None:
    """Level at first, it reaches 1,500 ft/min with a quarter of g, from now on."""
    level_off, first = Vertical(HIGH, 0.0), Resolution(sense, RATE_M_S)
    rate_m_s = 1500.0 * 0.3048 / 60.0
    gained_m = rate_m_s * 20.0 - rate_m_s**2 / (2.0 * 0.25 * 9.80665)
    assert not is_insufficient(level_off, level_off, first, 20.0, gained_m - 0.01)
    assert is_insufficient(level_off, level_off, first, 20.0, gained_m + 0.01)


def test_an_advisory_that_gives_alim_exactly_is_sufficient() -> None:
    own, intruder = Vertical(1_000.0, 0.0), Vertical(800.0, 0.0)
    assert not is_insufficient(own, intruder, Resolution("climb", 0.0), 20.0, 200.0)
    assert select(own, intruder, 20.0, 200.0, required=None, may_descend=True).rate_m_s == 0.0
    assert may_weaken(own, intruder, "climb", 20.0, 200.0)


@pytest.mark.parametrize(
    ("gap_ft", "rate_m_s"), [(700.0, 0.0), (600.5, 0.0), (599.5, RATE_M_S), (0.0, RATE_M_S)]
)
@pytest.mark.parametrize("sense", ["climb", "descend"])
def test_the_weakest_advisory_that_gives_alim_is_chosen(
    sense: Sense, gap_ft: float, rate_m_s: float
) -> None:
    up = 1.0 if sense == "climb" else -1.0
    own, intruder = Vertical(HIGH + up * gap_ft * FOOT, 0.0), Vertical(HIGH, 0.0)
    chosen = select(own, intruder, 25.0, 600 * FOOT, required=None, may_descend=True)
    assert chosen == Resolution(sense if gap_ft else "climb", rate_m_s)


def test_near_the_ground_nobody_is_sent_down() -> None:
    own, intruder = Vertical(500.0, 0.0), Vertical(560.0, 0.0)
    alim_m = 300 * FOOT
    chosen = select(own, intruder, 25.0, alim_m, required=None, may_descend=False)
    assert chosen == Resolution("climb", RATE_M_S)
    chosen = select(own, intruder, 25.0, alim_m, required="descend", may_descend=False)
    assert chosen == Resolution("descend", 0.0)


@pytest.mark.parametrize("up", [1.0, -1.0])
@pytest.mark.parametrize(("gap_ft", "weakens"), [(601.0, True), (599.0, False)])
def test_an_advisory_is_weakened_once_alim_is_reached_and_kept(
    up: float, gap_ft: float, weakens: bool
) -> None:
    sense: Sense = "climb" if up > 0.0 else "descend"
    own = Vertical(HIGH + up * gap_ft * FOOT, up * RATE_M_S)
    level_off = may_weaken(own, Vertical(HIGH, 0.0), sense, 15.0, 600 * FOOT)
    assert level_off is weakens
    nearing = Vertical(HIGH, up * 20.0)  # It comes up to the own level before the two meet.
    assert not may_weaken(own, nearing, sense, 15.0, 600 * FOOT)


RATES_M_S = st.floats(-15.0, 15.0)


@given(RATES_M_S, RATES_M_S, st.floats(-300.0, 300.0), st.floats(0.0, 30.0), st.booleans(),
       st.booleans())  # fmt: skip
def test_a_sense_is_reversed_only_where_it_fails_and_upside_down_likewise(
    own_m_s: float, intruder_m_s: float, gap_m: float, time_s: float, departs: bool, joins: bool
) -> None:
    def reversed_(up: float) -> Resolution | None:
        present = Resolution("climb" if up > 0.0 else "descend", INCREASED_RATE_M_S)
        own, intruder = Vertical(up * gap_m, up * own_m_s), Vertical(0.0, up * intruder_m_s)
        return reversal(own, intruder, present, time_s, departs=departs, coordinates=joins)

    upright, inverted = reversed_(1.0), reversed_(-1.0)
    assert (upright is None) == (inverted is None)
    if upright is not None and inverted is not None:
        assert upright == Resolution("descend", RATE_M_S)
        assert inverted.sense == opposite(upright.sense)
        flies_on_m = gap_m + (own_m_s - intruder_m_s) * time_s
        assert flies_on_m < 100 * FOOT


@settings(max_examples=40, deadline=None)
@given(st.floats(-15.0, 15.0), st.floats(0.0, 60.0), st.sampled_from(["climb", "descend"]),
       st.sampled_from([0.0, RATE_M_S, INCREASED_RATE_M_S]))  # fmt: skip
def test_the_response_is_flown_as_a_pilot_does_it_by_small_steps(
    rate_m_s: float, time_s: float, sense: Sense, advised_m_s: float
) -> None:
    """After 5 s it changes by a quarter of g to the advised rate, unless it does more already."""
    up = 1.0 if sense == "climb" else -1.0
    wanted = up * max(up * rate_m_s, advised_m_s) if advised_m_s else 0.0
    altitude_m, rate, step_s = 0.0, rate_m_s, 0.005
    for step in range(round(time_s / step_s)):
        if step * step_s >= RESPONSE_S:
            change = min(max(wanted - rate, -2.4517 * step_s), 2.4517 * step_s)
            altitude_m += 0.5 * change * step_s
            rate += change
            altitude_m += (rate - change) * step_s
        else:
            altitude_m += rate * step_s
    found = separation_m(
        Vertical(0.0, rate_m_s), Vertical(0.0, 0.0), Resolution(sense, advised_m_s), time_s,
        RESPONSE_S,
    )  # fmt: skip
    assert found == pytest.approx(up * altitude_m, abs=0.1)


@pytest.mark.parametrize(("height_ft", "is_increased"), [(1_500.0, False), (1_650.0, True)])
def test_a_descent_is_increased_above_1_550_ft_only(height_ft: float, is_increased: bool) -> None:
    """FAA, Introduction to TCAS II, section on inhibits. The crew does not respond."""
    lower = Jet("AAL1", "aaaaa1", 90.0, 150.0, height_ft)
    upper = Jet("DAL2", "aaaaa2", 270.0, 150.0, height_ft + 60.0, has_tcas=False)
    notes = Meeting(ASSISTANTS.create("tcas"), (lower, upper)).fly().notes("AAL1")
    assert "descend, descend" in notes
    assert ("increase descent, increase descent" in notes) == is_increased
