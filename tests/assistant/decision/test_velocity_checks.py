"""Feeds that give no velocity, or a wrong one, are warned of as honest ones are."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pytest
from geographiclib.geodesic import Geodesic
from hypothesis import given
from hypothesis import strategies as st

from airfield import BRIEFING, NORTH, Airfield, Mover, drives, lands
from airhilt.assistant.decision.engine import ReceivedMessage
from airhilt.assistant.decision.velocity_checks import VelocityChecks
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.engine_families import ASSISTANTS
from airhilt.messages import AdsbReport, Severity, SurfaceTrack
from airhilt.sim import Input
from airhilt.surveillance import surface
from airhilt.surveillance.receivers import Receiver
from airhilt.surveillance.transponders import Transponder
from airhilt.units import DEGREE, FOOT, KNOT, SECOND_NS
from airhilt.workers.protocol import Step
from breadth import examples, mostly_slow
from decisions import reference
from encounters import CENTRE, State
from instants import surface_track

Feed = Callable[[dict[str, Any]], dict[str, Any]]
VELOCITY = ("ground_speed_kt", "track_deg", "vertical_rate_fpm")


def honest(report: dict[str, Any]) -> dict[str, Any]:
    return report


def zero(report: dict[str, Any]) -> dict[str, Any]:
    return report | {name: 0.0 for name in VELOCITY if name in report}


def missing(report: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in report.items() if name not in VELOCITY}


def opposite(report: dict[str, Any]) -> dict[str, Any]:
    turned = report | {"track_deg": ((report["track_deg"] or 0.0) + 180.0) % 360.0}
    if "vertical_rate_fpm" in report:
        turned["vertical_rate_fpm"] = -report["vertical_rate_fpm"]
    return turned


WRONG = [zero, missing, opposite]


# --- in the air -------------------------------------------------------------------------------


@dataclass(frozen=True)
class Meeting:
    """Two that fly geodesics, straight on and at steady rates, and meet at a place."""

    latitude_deg: float
    longitude_deg: float
    courses_deg: tuple[float, float]
    speeds_kt: tuple[float, float]
    rates_fpm: tuple[float, float]
    meet_s: float = 150.0

    def reports(self, t_s: float, feed: Feed) -> Iterator[AdsbReport]:
        left_s, t_ns = self.meet_s - t_s, round(t_s * SECOND_NS)
        for number in (0, 1):
            speed_kt, rate_fpm = self.speeds_kt[number], self.rates_fpm[number]
            line = Geodesic.WGS84.Line(
                self.latitude_deg, self.longitude_deg, self.courses_deg[number]
            )
            place = line.Position(-speed_kt * KNOT * left_s)
            generator = np.random.default_rng((number, round(2.0 * t_s)))
            north_deg, east_deg = generator.normal(0.0, 2.0, 2) / 111_000.0
            longitude_deg = place["lon2"] + east_deg / math.cos(place["lat2"] * DEGREE)
            altitude_ft = 25.0 * round((25_000.0 - rate_fpm * left_s / 60.0) / 25.0)
            yield AdsbReport.model_validate(
                feed(
                    {
                        "icao24": f"00000{number + 1}", "callsign": f"ENC{number + 1}",
                        "latitude_deg": place["lat2"] + north_deg,
                        "longitude_deg": (longitude_deg + 180.0) % 360.0 - 180.0,
                        "altitude_ft": altitude_ft, "ground_speed_kt": speed_kt,
                        "track_deg": place["azi2"] % 360.0, "vertical_rate_fpm": rate_fpm,
                        "nacp": 9, "nacv": 2, "receiver": "all", "t_adsb_in_ns": t_ns,
                        "t_adsb_out_ns": t_ns,
                    }
                )
            )  # fmt: skip

    def told_s(self, assistant: str, feed: Feed) -> dict[Severity, float]:
        """Return when an engine first tells of each severity, if nobody reacts."""
        engine, first = ASSISTANTS.create(assistant), dict[Severity, float]()
        for step in range(round(2.0 * self.meet_s)):
            t_ns = step * SECOND_NS // 2
            for report in self.reports(step / 2.0, feed):
                engine.receive(ReceivedMessage(report, t_ns, t_ns))
            for alert in engine.decide(t_ns).alerts:
                if alert.active:
                    first.setdefault(alert.severity, step / 2.0)
        return first


MEETINGS = st.builds(
    Meeting,
    st.floats(-75.0, 75.0),
    st.one_of(st.floats(179.9, 180.0), st.floats(-180.0, 180.0)),
    st.floats(0.0, 360.0).flatmap(
        lambda one: st.floats(60.0, 300.0).map(lambda turned: (one, (one + turned) % 360.0))
    ),
    st.tuples(st.floats(250.0, 500.0), st.floats(250.0, 500.0)),
    st.sampled_from([(0.0, 0.0), (1800.0, 0.0), (0.0, -1800.0)]),
)


@examples(24)
@given(MEETINGS, st.sampled_from(WRONG))
def test_a_wrong_velocity_does_not_change_when_two_are_warned_that_meet_anywhere(
    meeting: Meeting, feed: Feed
) -> None:
    right, wrong = meeting.told_s("reference", honest), meeting.told_s("reference", feed)
    assert Severity.WARNING in right
    for severity in (Severity.CAUTION, Severity.WARNING):
        if severity in right:
            assert wrong[severity] == pytest.approx(right[severity], abs=8.0)


@pytest.mark.parametrize("feed", WRONG)
@pytest.mark.parametrize(
    "assistant", mostly_slow(["conflict_alert", "well_clear", "adsb_only"], "well_clear")
)
def test_all_engines_tell_at_the_antimeridian_of_two_whose_velocity_is_wrong(
    assistant: str, feed: Feed
) -> None:
    meeting = Meeting(-17.0, 180.0, (80.0, 250.0), (450.0, 430.0), (0.0, 0.0))
    right, wrong = meeting.told_s(assistant, honest), meeting.told_s(assistant, feed)
    assert right
    for severity, t_s in right.items():
        assert wrong[severity] == pytest.approx(t_s, abs=3.0)


# --- on the ground ----------------------------------------------------------------------------


@dataclass
class Fed:
    """The reference worker, to which the ADS-B of some comes through a feed."""

    feed: Feed
    worker: DecisionWorker = field(default_factory=reference)

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        return self.worker.step(t_ns, [self._fed(item) for item in inputs])

    def _fed(self, item: Input) -> Input:
        if not item.key.startswith("adsb/"):
            return item
        return replace(item, payload=json.dumps(self.feed(json.loads(item.payload))).encode())


@pytest.mark.parametrize("feed", WRONG)
def test_a_vehicle_that_drives_on_to_a_runway_is_told_of_whatever_the_velocity(feed: Feed) -> None:
    def told_s(chosen: Feed) -> dict[str, float]:
        movers = [
            Mover("AAL123", NORTH, lands(90)),
            Mover("OPS1", NORTH, drives(30.0, to_m=0.0), category="C2"),
        ]
        worker: Any = Fed(chosen)
        field = Airfield(movers, worker=worker).run(90)
        return {severity: field.first(severity)[0] for severity in ("CAUTION", "WARNING")}

    right = told_s(honest)
    assert told_s(feed) == pytest.approx(right, abs=5.0)


@pytest.mark.parametrize("feed", WRONG)
def test_red_lights_go_on_for_one_that_lands_whatever_the_velocity(feed: Feed) -> None:
    def told_s(chosen: Feed) -> float:
        engine = ASSISTANTS.create("runway_status_lights")
        engine.receive(ReceivedMessage(BRIEFING, 0, 0))
        for second in range(90):
            t_ns = second * SECOND_NS
            before_m = 70.0 * (89 - second)
            for track in (
                surface_track(
                    -before_m, 0.0, 70.0, t_s=second, height_m=20.0 + 0.05 * before_m,
                    callsign="AAL123",
                ),
                surface_track(
                    800.0, 60.0 + 5.0 * max(70 - second, 0), 5.0, t_s=second, number=9,
                    callsign="OPS1", turned_deg=-90.0,
                ),
            ):  # fmt: skip
                fed = SurfaceTrack.model_validate(chosen(track.model_dump()))
                engine.receive(ReceivedMessage(fed, t_ns, t_ns))
            if any(alert.active for alert in engine.decide(t_ns).alerts):
                return float(second)
        raise AssertionError("nothing was told")

    assert told_s(feed) == pytest.approx(told_s(honest), abs=3.0)


# --- one target -------------------------------------------------------------------------------


def flown(seed: int, turn_deg_s: float, climb_fpm: float, nacp: int) -> Iterator[AdsbReport]:
    """Yield what a receiver makes of one that turns now and then, and climbs."""
    station = Receiver("all", State(CENTRE[0] * DEGREE, CENTRE[1] * DEGREE, 1e4), 1e6)
    sender = Transponder("a1b2c3", "AAL123", nacp, 2, np.random.default_rng(seed))
    east = north = course = 0.0
    altitude_m, speed = 6000.0, 230.0
    metre_deg = 1.0 / 111_195.0
    for step in range(10 * 120):
        t_s = step / 10.0
        course += (turn_deg_s * DEGREE / 10.0) * (20.0 <= t_s < 60.0)
        north_m_s, east_m_s = speed * math.cos(course), speed * math.sin(course)
        rate = climb_fpm / 60.0 * FOOT * (40.0 <= t_s < 90.0)
        north, east, altitude_m = (
            north + north_m_s / 10,
            east + east_m_s / 10,
            altitude_m + rate / 10,
        )
        latitude_deg = CENTRE[0] + north * metre_deg
        longitude_deg = CENTRE[1] + east * metre_deg / math.cos(latitude_deg * DEGREE)
        if step % 5:
            continue
        state = State(
            latitude_deg * DEGREE, longitude_deg * DEGREE, altitude_m, north_m_s, east_m_s, -rate
        )
        t_ns = round(t_s * SECOND_NS)
        station.decode(sender, sender.velocity(state), t_ns)
        decoded = station.decode(sender, sender.position(state, t_ns), t_ns)
        if decoded is not None:
            yield decoded.report(t_ns)


@pytest.mark.parametrize("nacp", [4, 8, 9, 10, 11])
@pytest.mark.parametrize(("turn_deg_s", "climb_fpm"), [(0.0, 0.0), (1.5, 2500.0), (-3.0, -4000.0)])
def test_an_honest_feed_is_left_as_it_is(nacp: int, turn_deg_s: float, climb_fpm: float) -> None:
    for seed in range(4):
        checks = VelocityChecks()
        for report in flown(seed, turn_deg_s, climb_fpm, nacp):
            assert checks.checked(report) is report


@pytest.mark.parametrize("speed_m_s", [0.0, 1.0, 8.0, 70.0])
def test_an_honest_track_of_surface_surveillance_is_left_as_it_is(speed_m_s: float) -> None:
    """With the errors of the simulated sensor, which last for seconds."""
    kept, position = surface.KEPT_CORRELATION, surface.sigma(surface.SURFACE_95_PERCENT_M)
    velocity = surface.sigma(surface.SPEED_95_PERCENT_M_S) if speed_m_s else 0.0
    generator, checks = np.random.default_rng(5), VelocityChecks()
    errors = generator.standard_normal(4)
    for second in range(1000):
        along_m, across_m, faster, aside = errors
        seen = (speed_m_s + faster * velocity, aside * velocity)
        track = surface_track(
            speed_m_s * second + along_m * position, across_m * position,
            KNOT * round(math.hypot(*seen) / KNOT), t_s=second,
            turned_deg=math.atan2(seen[1], seen[0]) / DEGREE,
        )  # fmt: skip
        assert checks.checked(track) is track
        errors = kept * errors + math.sqrt(1.0 - kept**2) * generator.standard_normal(4)


@pytest.mark.parametrize("feed", WRONG)
def test_the_places_give_speed_course_and_climb_within_seconds(feed: Feed) -> None:
    """Also in a turn of 1.5 degrees a second; the climb shows once it has come to 100 ft."""
    checks, last = VelocityChecks(), 0.0
    for report in flown(1, 1.5, 2500.0, 9):
        wrong = AdsbReport.model_validate(feed(report.model_dump()))
        found, t_s = checks.checked(wrong), report.t_adsb_in_ns / SECOND_NS
        last = t_s
        if t_s < 3.0:
            continue
        assert found.ground_speed_kt == pytest.approx(report.ground_speed_kt, abs=20.0)
        off_deg = (found.track_deg - report.track_deg + 180.0) % 360.0 - 180.0
        assert abs(off_deg) < 8.0
        if t_s < 40.0 or 50.0 < t_s < 90.0 or t_s > 100.0:
            assert found.vertical_rate_fpm == pytest.approx(report.vertical_rate_fpm, abs=400.0)
    assert last > 110.0


def test_a_place_that_jumps_makes_no_velocity() -> None:
    """And when a feed is right again, it is left as it is again."""
    checks, jumped = VelocityChecks(), 0
    for number, report in enumerate(flown(1, 0.0, 0.0, 9)):
        if number == 60:
            report = report.model_copy(update={"latitude_deg": report.latitude_deg + 0.005})
            jumped += 1
        found = checks.checked(report)
        assert found.ground_speed_kt == pytest.approx(report.ground_speed_kt, abs=10.0)
        if number > 90:
            assert found is report
    assert jumped == 1


def test_an_older_report_and_one_after_a_long_silence_are_left_as_they_are() -> None:
    reports = [zero(report.model_dump()) for report in flown(1, 0.0, 0.0, 9)]
    given_ = [AdsbReport.model_validate(report) for report in reports]
    checks = VelocityChecks()
    assert checks.checked(given_[0]) is given_[0]
    assert checks.checked(given_[1]) is given_[1]
    assert checks.checked(given_[2]).ground_speed_kt == pytest.approx(447.0, abs=20.0)
    assert checks.checked(given_[1]) is given_[1]
    assert checks.checked(given_[40]) is given_[40]
