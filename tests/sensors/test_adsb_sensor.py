"""ADS-B in a run: when squitters go out, and how late their reports are."""

from __future__ import annotations

import itertools
import math
import statistics
from dataclasses import replace
from typing import Any

import pytest

from airhilt import load
from airhilt.messages import AdsbReport
from airhilt.scenario.models import Scenario
from airhilt.sensors.adsb import AdsbSensor
from airhilt.sensors.base import SensorContext
from airhilt.sim import Director, Priority, Virtual, parse_latency
from airhilt.surveillance.squitters import IdentificationSquitter, SurfacePositionSquitter
from airhilt.surveillance.transponders import Transponder
from airhilt.units import DEGREE, SECOND_NS
from airhilt.world.flight import AircraftState
from airhilt.world.mover import carried_on
from airhilt.world.site import ScenarioSite
from sensed import Acting, Body

STATE = AircraftState(
    latitude_rad=38.9 * DEGREE, longitude_rad=-77.0 * DEGREE, altitude_m=10_668.0,
    height_agl_m=10_668.0, velocity_north_m_s=0.0, velocity_east_m_s=230.0,
    velocity_down_m_s=0.0, roll_rad=0.0, pitch_rad=0.0, heading_rad=1.57,
    true_airspeed_m_s=230.0, calibrated_airspeed_m_s=140.0, mach=0.78,
    ecef_x_m=0.0, ecef_y_m=0.0, ecef_z_m=0.0,
)  # fmt: skip


def context(
    scenario: Scenario,
    director: Director,
    actors: dict[str, Any],
    reports: list[Any],
    steps: list[Any],
    latency: str = "fixed:0.05",
    seed: int = 1,
    age_ns: int = 0,
) -> SensorContext:
    """Return what a run would give to the sensor."""
    return SensorContext(
        director=director,
        scenario=scenario,
        site=ScenarioSite.of(scenario),
        actors=actors,
        latency=parse_latency(latency),
        seed=seed,
        state_at_ns=lambda: director.now_ns - age_ns,
        publish=lambda key, report, raw=None: reports.append(report),
        step_done=steps.append,
    )


class Run:
    def __init__(
        self,
        seconds: float = 120.0,
        latency: str = "fixed:0.05",
        seed: int = 1,
        equipped: bool = True,
        age_ns: int = 0,
        **adsb: Any,
    ) -> None:
        document = load("s02a_headon").model_dump()
        document["adsb"] |= {"loss_probability": 0.0} | adsb
        for actor in document["actors"]:
            actor["transponder"]["equipped"] = equipped
        scenario = Scenario.model_validate(document)
        self.director = Director(Virtual())
        self.reports: list[Any] = []
        self.steps: list[Any] = []
        actors: dict[str, Any] = {one.callsign: Acting(one, Body(STATE)) for one in scenario.actors}
        self.aircraft = {callsign: acting.body for callsign, acting in actors.items()}
        self.sensor = AdsbSensor(
            context(
                scenario, self.director, actors, self.reports, self.steps, latency, seed, age_ns
            )
        )
        self.sensor.start()
        self.end_ns = round(seconds * SECOND_NS)
        self.director.at(self.end_ns, self.director.stop, Priority.OBSERVE)

    def go(self) -> Run:
        self.director.run()
        return self

    def of(self, icao24: str) -> list[AdsbReport]:
        return [report for report in self.reports if report.icao24 == icao24]


@pytest.fixture(scope="module")
def run() -> Run:
    return Run().go()


def test_every_equipped_aircraft_is_reported_with_its_callsign_within_six_seconds(run: Run) -> None:
    named = {r.callsign for r in run.reports if r.t_adsb_in_ns < 6 * SECOND_NS}
    assert set(run.aircraft) <= named


def test_a_report_leaves_the_receiver_one_latency_after_the_squitter(run: Run) -> None:
    for report in run.reports:
        assert report.t_adsb_out_ns - report.t_adsb_in_ns == 50_000_000
        assert report.t_ns == report.t_adsb_out_ns
    assert [step.seq for step in run.steps] == list(range(len(run.steps)))
    assert all(step.worker == "adsb" and step.finished for step in run.steps)


def test_a_receiver_takes_about_50_ms_where_latencies_are_drawn() -> None:
    """They are lognormal, with a deviation of 0.3 of their logarithm."""
    run = Run(seconds=300.0, latency="lognormal").go()
    logarithms = [math.log((r.t_adsb_out_ns - r.t_adsb_in_ns) / SECOND_NS) for r in run.reports]
    assert len(logarithms) > 1_000
    mean = statistics.fmean(logarithms)
    assert math.exp(mean) == pytest.approx(0.050, rel=0.05)
    assert statistics.stdev(logarithms) == pytest.approx(0.3, rel=0.1)


def test_a_latency_that_only_a_result_has_is_that_of_a_report() -> None:
    reports = Run(seconds=10.0, latency="on_output:0.2").go().reports
    assert reports
    assert {report.t_adsb_out_ns - report.t_adsb_in_ns for report in reports} == {200_000_000}


def test_in_an_outage_nothing_is_received_and_after_it_all_is_as_if_it_had_not_been(
    run: Run,
) -> None:
    without = [r for r in run.reports if r.t_adsb_out_ns < 20 * SECOND_NS]
    reports = Run(seconds=20.0, outages_s=[[5.5, 8.0]]).go().reports
    heard = [r for r in reports if not 8.0 <= r.t_adsb_in_ns / SECOND_NS < 9.0]
    assert heard == [r for r in without if not 5.5 <= r.t_adsb_in_ns / SECOND_NS < 9.0]
    assert len(heard) > 30


def test_a_report_has_the_squawk_and_the_status_of_the_instant_of_its_squitter() -> None:
    run = Run(seconds=10.0)
    actor: Any = run.sensor.sources[0].actor
    before = actor.squawk

    def declare() -> None:
        run.sensor.sources[0].actor = replace(actor, squawks="7700", emergency="general")

    run.director.at(5 * SECOND_NS, declare, Priority.PHYSICS)
    for report in run.go().of(actor.spec.icao24):
        is_before = report.t_adsb_in_ns < 5 * SECOND_NS
        assert report.squawk == (before if is_before else "7700")
        assert report.emergency == ("none" if is_before else "general")
        assert (report.nic, report.sil) == (8, 3)


@pytest.mark.parametrize(("loss", "least", "most"), [(0.3, 0.63, 0.77), (1.0, 0.0, 0.0)])
def test_squitters_are_lost_with_the_given_probability(
    loss: float, least: float, most: float, run: Run
) -> None:
    reports = Run(seconds=120.0, loss_probability=loss).go().reports
    assert least <= len(reports) / len(run.reports) <= most


def test_the_first_receiver_that_is_in_view_gives_the_report() -> None:
    position = {"type": "from_centre", "bearing_deg": 0.0, "distance_nm": 0.0}
    far = {"type": "geodetic", "lat_deg": 0.0, "lon_deg": 0.0}
    declared = [{"name": "far", "position": far}, {"name": "near", "position": position}]
    reports = Run(5.0, receivers=[*declared, {"name": "third", "position": position}]).go().reports
    assert {report.receiver for report in reports} == {"near"}


@pytest.mark.parametrize(("away_nm", "is_heard"), [(11.6, True), (12.1, False)])
def test_an_antenna_is_as_high_as_the_scenario_says(away_nm: float, is_heard: bool) -> None:
    """50 ft hear an antenna of 2 m, 6.6 ft, at 1.23 times the sum of the roots: 11.85 NM."""
    position = {"type": "geodetic", "lat_deg": 38.9 + away_nm / 60.0, "lon_deg": -77.0}
    run = Run(5.0, receivers=[{"name": "R", "position": position, "antenna_height_ft": 50.0}])
    for body in run.aircraft.values():
        body.on_ground, body.state = True, on_the_ground()
    assert bool(run.go().reports) is is_heard


@pytest.mark.parametrize(("away_nm", "is_heard"), [(49.8, True), (50.2, False)])
def test_a_receiver_hears_as_far_as_the_scenario_says(away_nm: float, is_heard: bool) -> None:
    position = {
        "type": "geodetic",
        "lat_deg": 38.9 + away_nm * 1852.0 / 111_019.0,
        "lon_deg": -77.0,
    }
    run = Run(5.0, receivers=[{"name": "R", "position": position, "range_nm": 50.0}])
    assert bool(run.go().reports) is is_heard


def test_a_report_that_the_end_of_the_run_cuts_off_is_unfinished() -> None:
    run = Run(seconds=30.0, latency="fixed:10").go()
    cut = run.sensor.unfinished()
    assert cut
    assert all(not step.finished and step.outputs == 0 for step in cut)
    assert len(cut) + len(run.steps) == 1 + max(step.seq for step in cut)


def test_the_same_seed_gives_the_same_reports_and_another_seed_others() -> None:
    once, again, other = (Run(seconds=20.0, seed=seed).go().reports for seed in (1, 1, 2))
    assert once == again
    assert once != other


def test_an_aircraft_without_a_transponder_is_not_heard() -> None:
    assert Run(seconds=10.0, equipped=False).go().reports == []


def test_an_aircraft_that_has_ended_squitters_no_more() -> None:
    run = Run(seconds=20.0)
    gone = next(iter(run.aircraft.values()))
    run.director.at(
        10 * SECOND_NS, lambda: setattr(gone, "ended", "ground_contact"), Priority.PHYSICS
    )
    run.go()
    first, second = {report.icao24 for report in run.reports}
    last = sorted(run.of(icao24)[-1].t_adsb_in_ns for icao24 in (first, second))
    assert last[0] < 10 * SECOND_NS
    assert last[1] > 19 * SECOND_NS


def test_one_aircraft_more_does_not_change_what_the_others_squitter() -> None:
    document = load("s02a_headon").model_dump()
    seen = []
    for keep in (1, 2):
        part = replace_actors(document, keep)
        director = Director(Virtual())
        reports: list[Any] = []
        actors: dict[str, Any] = {one.callsign: Acting(one, Body(STATE)) for one in part.actors}
        AdsbSensor(context(part, director, actors, reports, [])).start()
        director.at(20 * SECOND_NS, director.stop, Priority.OBSERVE)
        director.run()
        seen.append([r for r in reports if r.icao24 == part.actors[0].icao24])
    assert seen[0]
    assert seen[0] == seen[1]


def replace_actors(document: dict[str, Any], keep: int) -> Scenario:
    part = document | {
        "actors": document["actors"][:keep], "conflict": None, "end_when": [],
        "perturbations": [], "radio": {},
    }  # fmt: skip
    return Scenario.model_validate(part)


def test_between_two_ticks_a_state_is_carried_straight_on() -> None:
    moved = carried_on(STATE._replace(velocity_down_m_s=-10.0), 0.04)
    assert moved.altitude_m == pytest.approx(STATE.altitude_m + 0.4)
    east_m = (moved.longitude_rad - STATE.longitude_rad) * 6.39e6 * 0.778
    assert east_m == pytest.approx(230.0 * 0.04, rel=0.01)
    assert carried_on(STATE, 0.0) is STATE


def test_a_squitter_has_the_place_of_its_instant_and_not_that_of_the_tick_before() -> None:
    """Eastward with 230 m/s, four tenths of a second are 92 m."""
    fresh, aged = (Run(10.0, age_ns=age_ns).go().reports for age_ns in (0, 400_000_000))
    assert len(fresh) == len(aged) > 10
    for one, other in zip(fresh, aged, strict=True):
        east_m = (other.longitude_deg - one.longitude_deg) * DEGREE * 6.39e6 * 0.778
        assert east_m == pytest.approx(92.0, abs=4.0)
        assert other.latitude_deg == pytest.approx(one.latitude_deg, abs=4e-5)


# --- on the ground --------------------------------------------------------------------------


def on_the_ground(speed_m_s: float = 0.0) -> AircraftState:
    return STATE._replace(
        altitude_m=0.0, height_agl_m=0.0, velocity_north_m_s=0.0, velocity_east_m_s=speed_m_s
    )


def grounded(seconds: float = 120.0, state: None = None, **rest: Any) -> Run:
    run = Run(seconds, **rest)
    for body in run.aircraft.values():
        body.on_ground, body.state = True, state or on_the_ground()
    return run


def driving(run: Run, callsign: str, speed_m_s: float, from_s: float = 0.0) -> None:
    """Let a body drive east from a time on."""
    body = run.aircraft[callsign]
    run.director.at(
        round(from_s * SECOND_NS),
        lambda: setattr(body, "state", on_the_ground(speed_m_s)),
        Priority.PHYSICS,
    )

    def tick() -> None:
        body.state = carried_on(body.state, 0.05)
        run.director.at(run.director.now_ns + SECOND_NS // 20, tick, Priority.PHYSICS)

    run.director.at(round(from_s * SECOND_NS) + SECOND_NS // 20, tick, Priority.PHYSICS)


def intervals_s(reports: list[AdsbReport], from_s: float = 0.0) -> list[float]:
    times = [r.t_adsb_in_ns / SECOND_NS for r in reports if r.t_adsb_in_ns >= from_s * SECOND_NS]
    return [b - a for a, b in itertools.pairwise(times)]


def test_who_stands_for_half_a_minute_squitters_every_five_seconds() -> None:
    run = grounded(seconds=200.0).go()
    for actor in {report.icao24 for report in run.reports}:
        reports = run.of(actor)
        assert max(intervals_s(reports[:50])) <= 0.6
        slow = intervals_s(reports, from_s=36.0)
        assert len(slow) > 25
        assert min(slow) >= 4.8
        assert max(slow) <= 5.2


def test_who_drives_squitters_twice_a_second() -> None:
    run = grounded(seconds=90.0)
    for callsign in run.aircraft:
        driving(run, callsign, 8.0)
    run.go()
    assert len(run.reports) > 320
    for actor in {report.icao24 for report in run.reports}:
        assert min(intervals_s(run.of(actor))) >= 0.4
        assert max(intervals_s(run.of(actor))) <= 0.6


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_who_has_moved_10_m_is_heard_of_after_no_more_than_one_of_the_short_intervals(
    seed: int,
) -> None:
    """A carrier stands no more once it has moved 10 m; the short interval is 0.6 s at most.

    At 62 s the long interval has more than 2 s to go.
    """
    run = grounded(seconds=66.0, seed=seed)
    for callsign in run.aircraft:
        driving(run, callsign, 20.0, from_s=62.0)
    run.go()
    for callsign in run.aircraft:
        moving = [r for r in run.reports if r.callsign == callsign and r.ground_speed_kt > 5.0]
        assert moving[0].t_adsb_in_ns <= (62.0 + 10.0 / 20.0 + 0.05 + 0.6) * SECOND_NS


def test_reports_from_the_ground_have_no_altitude_and_reports_from_the_air_do() -> None:
    run = Run(seconds=40.0)
    body = next(iter(run.aircraft.values()))

    def lift_off() -> None:
        body.on_ground = False
        body.state = STATE

    body.on_ground, body.state = True, on_the_ground(60.0)
    run.director.at(20 * SECOND_NS, lift_off, Priority.PHYSICS)
    run.go()
    callsign = next(iter(run.aircraft))
    named = [report for report in run.reports if report.callsign == callsign]
    for report in named:
        assert report.on_ground == (report.t_adsb_in_ns < 20 * SECOND_NS)
        assert (report.altitude_ft is None) == report.on_ground
        assert report.emitter_category == "A3"
    assert {report.on_ground for report in named} == {True, False}


def squitters_of(run: Run, monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, str, float]]:
    """Return all squitters of a run: their type, the address, and the time in s."""
    sent = []
    receive = run.sensor._receive

    def record(
        sender: Transponder,
        squitter: IdentificationSquitter | SurfacePositionSquitter,
        state: AircraftState,
    ) -> None:
        sent.append((type(squitter).__name__, sender.icao24, run.director.now_ns / SECOND_NS))
        receive(sender, squitter, state)

    monkeypatch.setattr(run.sensor, "_receive", record)
    run.go()
    return sent


@pytest.mark.parametrize(
    ("name", "least_s", "most_s"),
    [
        ("PositionSquitter", 0.4, 0.6),
        ("VelocitySquitter", 0.4, 0.6),
        ("IdentificationSquitter", 4.8, 5.2),
    ],
)
def test_in_the_air_squitters_come_at_the_intervals_of_do_260b(
    name: str, least_s: float, most_s: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """2.2.3.3. The first one comes within the shortest interval, and the draws fill the range."""
    sent = squitters_of(Run(seconds=300.0), monkeypatch)
    assert {each for each, _, _ in sent} == {
        "PositionSquitter", "VelocitySquitter", "IdentificationSquitter",
    }  # fmt: skip
    for icao24 in {icao24 for _, icao24, _ in sent}:
        times = [t for what, who, t in sent if (what, who) == (name, icao24)]
        gaps = [b - a for a, b in itertools.pairwise(times)]
        assert 0.0 <= times[0] <= least_s
        assert least_s <= min(gaps) < least_s + 0.1 * (most_s - least_s)
        assert most_s - 0.1 * (most_s - least_s) < max(gaps) <= most_s


def test_callsigns_of_those_who_stand_come_every_ten_seconds(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run = grounded(seconds=200.0)
    sent = squitters_of(run, monkeypatch)
    assert {name for name, _, _ in sent} == {"SurfacePositionSquitter", "IdentificationSquitter"}
    for icao24 in {icao24 for _, icao24, _ in sent}:
        times = [t for name, who, t in sent if "Ident" in name and who == icao24 and t > 45.0]
        gaps = [b - a for a, b in itertools.pairwise(times)]
        assert len(gaps) > 10
        assert min(gaps) >= 9.8
        assert max(gaps) <= 10.2
