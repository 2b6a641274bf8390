"""Crews follow advisories after a while, and do what they were told before when it is over."""

from __future__ import annotations

import statistics
from typing import Any, cast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt.commands import (
    AltitudeCommand,
    DriftDownCommand,
    EmergencyDescentCommand,
    GoAroundCommand,
    SpeedCommand,
    TrackCommand,
)
from airhilt.geodesy.positions import GeodeticPosition
from airhilt.messages import Advisory, Climb, Evidence, MaintainLevel, Severity, Turn
from airhilt.scenario.models import AircraftSpec, Channels, Reactions, Responses, Transponder
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT
from airhilt.world.actors.actor import Unable
from airhilt.world.actors.crew import Crew
from airhilt.world.flight import Aircraft, Atmosphere, InitialCondition, load_aircraft_type
from airhilt.world.site import ScenarioSite
from breadth import examples

CLIMB = Climb(sense="climb", altitude_ft=5_600, vertical_rate_fpm=500)


@pytest.fixture(scope="module")
def aircraft() -> Aircraft:
    return airborne()


def airborne() -> Aircraft:
    initial = InitialCondition(
        latitude_rad=47.0 * DEGREE,
        longitude_rad=8.0 * DEGREE,
        altitude_m=5_000 * FOOT,
        track_rad=60.0 * DEGREE,
        calibrated_airspeed_m_s=95 * KNOT,
    )
    return Aircraft(load_aircraft_type("c172p"), initial, seed=1, atmosphere=Atmosphere())


@pytest.fixture(autouse=True)
def as_it_began(aircraft: Aircraft) -> None:
    aircraft.en_route.hold_altitude(5_000 * FOOT)
    aircraft.en_route.hold_speed(95 * KNOT)
    aircraft.en_route.hold_track(60.0 * DEGREE)


def crew_of(
    aircraft: Aircraft,
    compliance: float = 1.0,
    median_s: float = 5.0,
    sigma: float = 0.0,
    seed: int = 1,
    **transponder: Any,
) -> Crew:
    reactions = Reactions(reaction_median_s=median_s, reaction_sigma=sigma, compliance=compliance)
    centre = GeodeticPosition(type="geodetic", lat_deg=47.0, lon_deg=8.0)
    spec = cast(Any, AircraftSpec).model_construct(
        callsign="AAL123",
        icao24="a1b2c3",
        initial=None,
        pilot=reactions,
        transponder=Transponder(**transponder),
    )
    return Crew(spec, aircraft, ScenarioSite(centre, 0.0), seed)


def advisory(
    recommendation: Climb | MaintainLevel | Turn | None = CLIMB,
    severity: str = "CAUTION",
    active: bool = True,
    revision: int = 0,
    name: str = "s-1",
) -> Advisory:
    return Advisory(
        id=name, revision=revision, recipient="AAL123", recipients=("AAL123",),
        kind="loss_of_separation", severity=Severity(severity), active=active,
        traffic=("AAL123", "DAL456"), message="", recommendation=recommendation,
        evidence=Evidence(sources=("adsb",)), t_ready_ns=0,
    )  # fmt: skip


def over(name: str = "s-1", revision: int = 9) -> Advisory:
    return advisory(None, "INFO", active=False, revision=revision, name=name)


def level_ft(aircraft: Aircraft) -> float:
    return aircraft.target_altitude_m / FOOT


def test_a_crew_follows_after_its_reaction_time_and_not_before(aircraft: Aircraft) -> None:
    reaction = crew_of(aircraft).hear(advisory())
    assert reaction.delay_s == 5.0
    assert level_ft(aircraft) == pytest.approx(5_000)
    reaction.act()
    assert level_ft(aircraft) == pytest.approx(5_600)
    assert aircraft.target_vertical_rate_m_s == pytest.approx(500 * FOOT_PER_MINUTE, rel=0.01)


def test_a_turn_with_a_climb_is_flown_too(aircraft: Aircraft) -> None:
    before_rad = aircraft.state.track_rad
    crew = crew_of(aircraft)
    crew.hear(advisory(CLIMB.model_copy(update={"turn_deg": 40.0}))).act()
    assert level_ft(aircraft) == pytest.approx(5_600)
    for _ in range(20 * 120):
        aircraft.advance()
    assert aircraft.state.track_rad - before_rad == pytest.approx(40 * DEGREE, abs=3 * DEGREE)
    crew.hear(over()).act()
    for _ in range(20 * 120):
        aircraft.advance()
    assert aircraft.state.track_rad == pytest.approx(before_rad, abs=3 * DEGREE)


def test_a_level_to_maintain_is_maintained(aircraft: Aircraft) -> None:
    crew_of(aircraft).hear(advisory(MaintainLevel(altitude_ft=5_200))).act()
    assert level_ft(aircraft) == pytest.approx(5_200)


def test_a_crew_without_cabin_pressure_does_not_level_off_on_its_way_down() -> None:
    aircraft = airborne()
    crew = crew_of(aircraft)
    crew.command(EmergencyDescentCommand(action="emergency_descent", altitude_ft=3_000))
    with pytest.raises(Unable, match="emergency descent"):
        crew.hear(advisory(MaintainLevel(altitude_ft=4_800))).act()
    assert level_ft(aircraft) == pytest.approx(3_000)
    crew.hear(advisory(MaintainLevel(altitude_ft=2_800), name="s-2")).act()
    assert level_ft(aircraft) == pytest.approx(2_800)


@pytest.mark.parametrize(
    "command",
    [
        EmergencyDescentCommand(action="emergency_descent", altitude_ft=3_000),
        DriftDownCommand(action="drift_down"),
    ],
)
def test_a_crew_sets_7700_when_its_emergency_begins(
    command: EmergencyDescentCommand | DriftDownCommand,
) -> None:
    crew = crew_of(airborne(), squawk="1325")
    assert (crew.squawk, crew.emergency) == ("1325", "none")
    crew.command(command)
    assert (crew.squawk, crew.emergency) == ("7700", "general")


@pytest.mark.parametrize(
    ("transponder", "squawk", "emergency"),
    [
        ({"squawk": "7600"}, "7600", "no_communications"),
        ({"squawk": "7500"}, "7500", "unlawful_interference"),
        ({"squawk": "1325", "emergency": "minimum_fuel"}, "1325", "minimum_fuel"),
        ({"equipped": False}, None, "none"),
    ],
)
def test_a_squawk_has_a_meaning_unless_the_scenario_gives_another_status(
    transponder: dict[str, Any], squawk: str | None, emergency: str
) -> None:
    crew = crew_of(airborne(), **transponder)
    assert (crew.squawk, crew.emergency) == (squawk, emergency)


@pytest.mark.parametrize("severity", ["INFO", "ADVISORY"])
def test_a_crew_does_not_act_on_less_than_a_caution(aircraft: Aircraft, severity: str) -> None:
    assert crew_of(aircraft).hear(advisory(severity=severity)) is None


def test_without_a_recommendation_there_is_nothing_to_do(aircraft: Aircraft) -> None:
    assert crew_of(aircraft).hear(advisory(None)) is None


def test_the_end_of_a_conflict_that_it_did_not_follow_is_nothing_to_it(aircraft: Aircraft) -> None:
    assert crew_of(aircraft).hear(over()) is None


@examples(30)
@given(st.integers(0, 2**40), st.integers(0, 5))
def test_reaction_times_are_the_same_for_the_same_seed_and_advisory(
    aircraft: Aircraft, seed: int, revision: int
) -> None:
    def delay_s(crew_seed: int, name: str = "s-1") -> float:
        crew = crew_of(aircraft, sigma=0.3, seed=crew_seed)
        return crew.hear(advisory(revision=revision, name=name)).delay_s

    assert delay_s(seed) == delay_s(seed)
    assert len({delay_s(seed), delay_s(seed + 1), delay_s(seed, "s-2")}) == 3


def test_reaction_times_lie_about_their_median(aircraft: Aircraft) -> None:
    delays = [
        crew_of(aircraft, sigma=0.3, seed=seed).hear(advisory()).delay_s for seed in range(400)
    ]
    assert statistics.median(delays) == pytest.approx(5.0, rel=0.06)
    assert min(delays) > 0.0


@examples(30)
@given(st.integers(0, 2**40))
def test_compliance_0_never_follows_and_1_always_does(aircraft: Aircraft, seed: int) -> None:
    assert not crew_of(aircraft, compliance=0.0, seed=seed).hear(advisory()).responds
    assert crew_of(aircraft, compliance=1.0, seed=seed).hear(advisory()).responds


def test_compliance_is_how_many_crews_follow(aircraft: Aircraft) -> None:
    follow = [crew_of(aircraft, 0.3, seed=seed).hear(advisory()).responds for seed in range(400)]
    assert 0.22 <= statistics.mean(follow) <= 0.38


@examples(20)
@given(st.integers(0, 2**40))
def test_whether_a_crew_follows_does_not_change_with_the_revision(
    aircraft: Aircraft, seed: int
) -> None:
    crew = crew_of(aircraft, compliance=0.5, seed=seed)
    heard = [crew.hear(advisory(revision=revision)).responds for revision in range(4)]
    assert len(set(heard)) == 1


def test_a_changed_advisory_is_followed_in_half_the_time(aircraft: Aircraft) -> None:
    crew = crew_of(aircraft)
    crew.hear(advisory()).act()
    again = crew.hear(
        advisory(CLIMB.model_copy(update={"altitude_ft": 6_000}), "WARNING", revision=1)
    )
    assert again.delay_s == 2.5
    again.act()
    assert level_ft(aircraft) == pytest.approx(6_000)
    assert crew.hear(over()).delay_s == 2.5


def test_an_older_advisory_does_not_overtake_a_newer_one(aircraft: Aircraft) -> None:
    crew = crew_of(aircraft)
    old = crew.hear(advisory())
    new = crew.hear(advisory(CLIMB.model_copy(update={"altitude_ft": 6_000}), revision=1))
    new.act()
    old.act()
    assert level_ft(aircraft) == pytest.approx(6_000)


def test_a_command_is_carried_out_at_once_where_there_is_no_advisory(aircraft: Aircraft) -> None:
    crew_of(aircraft).command(AltitudeCommand(action="altitude", altitude_ft=7_000))
    assert level_ft(aircraft) == pytest.approx(7_000)


def test_a_level_commanded_during_an_advisory_is_flown_afterwards(aircraft: Aircraft) -> None:
    crew = crew_of(aircraft)
    crew.hear(advisory()).act()
    crew.command(AltitudeCommand(action="altitude", altitude_ft=7_000))
    assert level_ft(aircraft) == pytest.approx(5_600)
    crew.hear(over()).act()
    assert level_ft(aircraft) == pytest.approx(7_000)


def test_a_speed_commanded_during_an_advisory_is_flown_afterwards(aircraft: Aircraft) -> None:
    crew = crew_of(aircraft)
    crew.hear(advisory()).act()
    crew.command(SpeedCommand(action="speed", cas_kt=80))
    assert aircraft.target_speed_m_s == pytest.approx(95 * KNOT)
    crew.hear(over()).act()
    assert aircraft.target_speed_m_s == pytest.approx(80 * KNOT)


def fly(aircraft: Aircraft, seconds: int) -> float:
    for _ in range(round(seconds * 20)):
        aircraft.advance()
    return aircraft.state.track_rad / DEGREE % 360.0


def test_a_track_commanded_during_a_climb_is_flown_afterwards(aircraft: Aircraft) -> None:
    crew = crew_of(aircraft)
    crew.hear(advisory()).act()
    crew.command(TrackCommand(action="track", track_deg=100.0))
    assert fly(aircraft, 10) == pytest.approx(60.0, abs=2.0)
    crew.hear(over()).act()
    assert fly(aircraft, 60) == pytest.approx(100.0, abs=2.0)


def test_of_two_advisories_both_must_be_over(aircraft: Aircraft) -> None:
    crew = crew_of(aircraft)
    crew.hear(advisory(name="s-1")).act()
    crew.hear(advisory(MaintainLevel(altitude_ft=5_300), name="s-2")).act()
    crew.hear(over("s-1")).act()
    assert level_ft(aircraft) == pytest.approx(5_300)
    crew.hear(over("s-2")).act()
    assert level_ft(aircraft) == pytest.approx(5_000)


def test_a_conflict_that_is_over_before_the_crew_reacts_is_not_followed(aircraft: Aircraft) -> None:
    crew = crew_of(aircraft)
    late = crew.hear(advisory())
    end = crew.hear(over())
    assert end is None
    late.act()
    assert level_ft(aircraft) == pytest.approx(5_000)
    crew.command(AltitudeCommand(action="altitude", altitude_ft=5_400))
    assert level_ft(aircraft) == pytest.approx(5_400)


def test_a_revision_that_comes_too_late_is_not_followed_after_the_end(aircraft: Aircraft) -> None:
    crew = crew_of(aircraft)
    crew.hear(advisory()).act()
    late = crew.hear(advisory(CLIMB.model_copy(update={"altitude_ft": 6_000}), revision=1))
    crew.hear(over()).act()
    late.act()
    assert level_ft(aircraft) == pytest.approx(5_000)


def test_a_crew_is_unable_to_fly_what_its_aircraft_cannot(
    subtests: pytest.Subtests, aircraft: Aircraft
) -> None:
    rows: list[Any] = [
        (SpeedCommand(action="speed", cas_kt=450), "unable 450 kt, maximum 127 kt"),
        (SpeedCommand(action="speed", cas_kt=30), "unable 30 kt, minimum 65 kt"),
        (AltitudeCommand(action="altitude", altitude_ft=-1_000), "unable -1000 ft: a c172p flies"),
        (AltitudeCommand(action="altitude", altitude_ft=499), "flies at 500 to 13000 ft here"),
        (AltitudeCommand(action="altitude", altitude_ft=13_001), "unable 13001 ft"),
        (
            AltitudeCommand(action="altitude", altitude_ft=6_000, vertical_rate_fpm=701),
            "unable 701 ft/min: a c172p climbs at 700 ft/min at most",
        ),
        (
            AltitudeCommand(action="altitude", altitude_ft=4_000, vertical_rate_fpm=1_001),
            "descends at 1000 ft/min at most",
        ),
        (EmergencyDescentCommand(action="emergency_descent", altitude_ft=0), "unable 0 ft"),
        (GoAroundCommand(action="go_around", climb_to_ft=30_000), "unable 30000 ft"),
    ]
    for command, why in rows:
        with subtests.test(why):
            speed_m_s = aircraft.target_speed_m_s
            with pytest.raises(Unable, match=why):
                crew_of(aircraft).command(command)
            assert level_ft(aircraft) == pytest.approx(5_000)
            assert aircraft.target_speed_m_s == speed_m_s


def test_a_crew_flies_up_to_the_limits_of_its_aircraft(aircraft: Aircraft) -> None:
    crew = crew_of(aircraft)
    crew.command(AltitudeCommand(action="altitude", altitude_ft=13_000, vertical_rate_fpm=700))
    assert level_ft(aircraft) == pytest.approx(13_000)
    crew.command(AltitudeCommand(action="altitude", altitude_ft=500, vertical_rate_fpm=1_000))
    assert level_ft(aircraft) == pytest.approx(500)
    crew.command(SpeedCommand(action="speed", cas_kt=127))
    assert aircraft.target_speed_m_s == pytest.approx(127 * KNOT)


@pytest.mark.parametrize(
    "recommended",
    [
        Climb(sense="descend", altitude_ft=-5_000, vertical_rate_fpm=6_000),
        Climb(sense="descend", altitude_ft=499, vertical_rate_fpm=1_000),
        MaintainLevel(altitude_ft=-1e300),
    ],
)
def test_a_crew_is_unable_to_descend_to_the_ground_for_an_advisory(
    aircraft: Aircraft, recommended: Climb | MaintainLevel
) -> None:
    crew = crew_of(aircraft)
    reaction = crew.hear(advisory(recommended))
    with pytest.raises(Unable, match="ft: a c172p flies at 500 to 13000 ft here"):
        reaction.act()
    assert level_ft(aircraft) == pytest.approx(5_000)
    crew.hear(advisory(CLIMB, name="s-2")).act()
    assert level_ft(aircraft) == pytest.approx(CLIMB.altitude_ft)


def test_a_crew_climbs_as_high_as_it_can_for_an_advisory(aircraft: Aircraft) -> None:
    crew_of(aircraft).hear(advisory(CLIMB.model_copy(update={"altitude_ft": 90_000}))).act()
    assert level_ft(aircraft) == pytest.approx(13_000)


def test_who_descends_in_place_of_climbing_stays_above_the_ground(aircraft: Aircraft) -> None:
    wrong = Channels(assistant=Responses(median_s=1.0, opposite=1.0))
    spec = cast(Any, AircraftSpec).model_construct(
        callsign="AAL123", initial=None, pilot=Reactions()
    )
    centre = GeodeticPosition(type="geodetic", lat_deg=47.0, lon_deg=8.0)
    for ground_ft, level in ((0.0, 4_400.0), (4_200.0, 4_700.0)):
        aircraft.en_route.hold_altitude(5_000 * FOOT)
        crew = Crew(spec, aircraft, ScenarioSite(centre, ground_ft * FOOT), 1, responses=wrong)
        told = CLIMB.model_copy(update={"altitude_ft": 5_600})
        reaction = crew.hear(advisory(told))
        assert reaction.text == "follows altitude, in the opposite sense"
        reaction.act()
        assert level_ft(aircraft) == pytest.approx(level, abs=100.0)


def test_the_ground_below_counts(aircraft: Aircraft) -> None:
    centre = GeodeticPosition(type="geodetic", lat_deg=47.0, lon_deg=8.0)
    spec = cast(Any, AircraftSpec).model_construct(
        callsign="AAL123", initial=None, pilot=Reactions()
    )
    crew = Crew(spec, aircraft, ScenarioSite(centre, 3_000 * FOOT), 1)
    with pytest.raises(Unable, match="3500 to 13000 ft here"):
        crew.command(AltitudeCommand(action="altitude", altitude_ft=3_400))
