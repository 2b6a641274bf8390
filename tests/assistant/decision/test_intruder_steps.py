"""Single steps of what is told of aircraft that only cameras show, at both sides of each limit."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any, cast

import pytest

from airhilt.assistant.decision.approach import (
    Approach,
    approach_of,
    may_stand,
    stays_in_place,
)
from airhilt.assistant.decision.escalation import Escalation
from airhilt.assistant.decision.intruders import IntruderConfig, IntruderWatch, evasion
from airhilt.assistant.decision.line_of_sight import Ray
from airhilt.geodesy.relative_motion import Minima
from airhilt.messages import Climb, GoAround, Recommendation, Severity, Turn
from airhilt.units import DEGREE, FOOT, SECOND_NS


def approach(**changed: Any) -> Approach:
    """Return a straight approach: contact in 20 s, known well, of something of 0.01 rad."""
    usual = Approach(0.05, 0.001, 0.001, (0.0, 0.0), 0.0, 0.01)
    return usual._replace(**changed)


# --- what an approach says ------------------------------------------------------------------


def nears(times_s: list[float], *, contact_s: float = 20.0, focal_px: float = 1000.0) -> Any:
    """Return the approach of what is met after a time, and is 0.01 rad wide at time 0."""
    observations = [
        SimpleNamespace(
            t_ns=round(t_s * SECOND_NS), is_whole=True, ray=Ray(0.0, 1.0, 0.0),
            size_rad=(0.0, 0.01 * contact_s / (contact_s - t_s)),
            geometry=SimpleNamespace(focal_px=focal_px),
        )
        for t_s in times_s
    ]  # fmt: skip
    return approach_of(cast(Any, observations))


@pytest.mark.parametrize(
    ("times_s", "is_told"),
    [
        ([0.0, 0.2, 0.4, 0.6, 0.75], True), ([0.0, 0.2, 0.4, 0.6, 0.74], False),
        ([0.0, 0.3, 0.6, 0.9], False),
    ],
)  # fmt: skip
def test_five_pictures_within_three_quarters_of_a_second_tell_a_growth(
    times_s: list[float], is_told: bool
) -> None:
    assert (nears(times_s) is not None) is is_told


# --- how grave it is ------------------------------------------------------------------------


def grade(seen: Approach, *, age_s: float = 0.0, is_there: bool = True) -> Severity | None:
    shows = SimpleNamespace(shows=lambda _: is_there)
    watch = IntruderWatch(
        IntruderConfig(), cast(Any, shows), lambda _: None, lambda: Minima(1222.0, 137.0)
    )
    track = SimpleNamespace(last=SimpleNamespace(t_ns=0), belief_of_one_look=0.9)
    return watch._grade(cast(Any, track), seen, round(age_s * SECOND_NS))


@pytest.mark.parametrize(
    ("time_s", "severity"),
    [
        (24.9, Severity.WARNING), (25.1, Severity.CAUTION), (59.9, Severity.CAUTION),
        (60.1, Severity.ADVISORY), (89.9, Severity.ADVISORY), (90.1, None),
    ],
)  # fmt: skip
def test_the_nearer_an_intruder_the_graver_it_is(time_s: float, severity: Severity | None) -> None:
    assert grade(approach(closing=1.0 / time_s)) is severity
    assert grade(approach(closing=1.0 / (time_s + 5.0)), age_s=5.0) is severity
    doubtful = grade(approach(closing=1.0 / time_s), is_there=False)
    assert doubtful is (Severity.ADVISORY if severity else None)


@pytest.mark.parametrize(
    ("sizes", "severity"),
    [(11.9, Severity.WARNING), (12.1, Severity.CAUTION), (24.9, Severity.CAUTION), (25.1, None)],
)
def test_the_nearer_it_passes_the_graver_it_is(sizes: float, severity: Severity | None) -> None:
    seen = approach(turning_rad_s=(sizes * 0.01 / 20.0, 0.0))
    assert seen.least_miss() == pytest.approx(sizes)
    assert grade(seen) is severity


# --- the way out ----------------------------------------------------------------------------


def way_out(
    seen: Approach | None = None, *, elevation_deg: float = 0.0, label: str = "airplane",
    rate_fpm: float = 0.0, height_m: float = 3000.0, altitude_ft: float | None = 10_000.0,
    told: Recommendation | None = None,
) -> Climb | Turn:  # fmt: skip
    ray = Ray(0.0, math.cos(elevation_deg * DEGREE), math.sin(elevation_deg * DEGREE))
    view = SimpleNamespace(height_m=height_m)
    track = SimpleNamespace(
        label=label, last=SimpleNamespace(ray=ray, geometry=SimpleNamespace(view=view))
    )
    report = SimpleNamespace(altitude_ft=altitude_ft, vertical_rate_fpm=rate_fpm)
    return evasion(cast(Any, track), seen or approach(), cast(Any, report), 450.0 * FOOT, told)


def sense(told: Climb | Turn) -> str:
    return told.sense if isinstance(told, Climb) else "turn"


@pytest.mark.parametrize(
    ("how", "expected"),
    [
        ({}, "climb"),
        ({"rate_fpm": -1.0}, "descend"),
        ({"elevation_deg": 0.6}, "descend"),
        ({"elevation_deg": -0.6, "rate_fpm": -500.0}, "climb"),
        ({"elevation_deg": 0.4}, "climb"),  # About level: as it moves already.
        ({"label": "bird", "elevation_deg": 5.0}, "climb"),
        ({"altitude_ft": None}, "turn"),
        ({"rate_fpm": -1.0, "height_m": 200.0}, "turn"),
    ],
)
def test_the_way_out_leads_away_from_it_and_not_into_the_ground(
    how: dict[str, Any], expected: str
) -> None:
    assert sense(way_out(**how)) == expected


@pytest.mark.parametrize(("up", "expected"), [(1.1, "descend"), (-1.1, "climb"), (0.9, "climb")])
def test_what_will_pass_above_is_dived_under(up: float, expected: str) -> None:
    """By more than its own size, whatever it does now."""
    seen = approach(turning_rad_s=(0.0, up * 0.01 / 20.0), turning_error=0.0)
    assert sense(way_out(seen)) == expected
    if expected == "climb":
        assert sense(way_out(seen, rate_fpm=-1.0)) == ("climb" if up < 0.0 else "descend")


DESCEND = Climb(sense="descend", altitude_ft=9_300.0, vertical_rate_fpm=2500.0)


@pytest.mark.parametrize(
    ("how", "expected"),
    [
        ({}, DESCEND),
        ({"elevation_deg": -5.0}, DESCEND),  # It dives under the other one, which is below yet.
        ({"altitude_ft": None}, DESCEND),
        ({"altitude_ft": 9_401.0}, DESCEND),
        ({"altitude_ft": 9_399.0}, DESCEND.model_copy(update={"altitude_ft": 8_700.0})),
        ({"told": Turn(degrees=30)}, Turn(degrees=30)),
    ],
)
def test_what_was_told_stays_until_the_level_is_reached(
    how: dict[str, Any], expected: Recommendation
) -> None:
    assert way_out(**{"told": DESCEND, **how}) == expected


@pytest.mark.parametrize(
    ("down", "expected"), [(1.1, "climb"), (0.9, "descend"), (-2.0, "descend")]
)
def test_a_descent_is_reversed_only_for_what_is_seen_to_pass_below(
    down: float, expected: str
) -> None:
    seen = approach(turning_rad_s=(0.0, -down * 0.01 / 20.0), turning_error=0.0)
    assert sense(way_out(seen, told=DESCEND)) == expected
    doubtful = seen._replace(turning_error=1.0)
    assert sense(way_out(doubtful, told=DESCEND)) == "descend"


def test_who_was_told_to_go_around_is_not_told_to_descend_for_what_is_above_now() -> None:
    assert sense(way_out(elevation_deg=5.0, told=GoAround(runway="01"))) == "climb"


def test_to_the_right_goes_who_cannot_climb_or_descend() -> None:
    told = way_out(altitude_ft=None)
    assert isinstance(told, Turn)
    assert told.degrees > 0


# --- what may stand on the ground -----------------------------------------------------------


@pytest.mark.parametrize(
    ("label", "size_rad", "stands"),
    [("airplane", 0.0399, True), ("airplane", 0.0401, False), ("bird", 0.0099, True),
     ("bird", 0.0101, False)],
)  # fmt: skip
def test_what_would_be_larger_than_an_airliner_on_the_ground_is_in_the_air(
    label: str, size_rad: float, stands: bool
) -> None:
    """From 1,000 m and 30 degrees below the horizon the ground is 2 km away: 80 m are 0.04 rad."""
    foot = SimpleNamespace(elevation_rad=-30.0 * DEGREE)
    geometry = SimpleNamespace(view=SimpleNamespace(height_m=1000.0), foot=lambda _: foot)
    last = SimpleNamespace(geometry=geometry, box=None, size_rad=(size_rad, 0.001))
    assert may_stand(cast(Any, SimpleNamespace(label=label, last=last))) is stands
    foot.elevation_rad = 0.0
    assert not may_stand(cast(Any, SimpleNamespace(label=label, last=last)))


# --- when it is told ------------------------------------------------------------------------


def at(seconds: float) -> int:
    return round(seconds * SECOND_NS)


def test_a_severity_is_told_once_it_has_held_and_again_only_when_it_rises() -> None:
    told = Escalation("one")
    assert not told.rises(Severity.CAUTION, at(0.0), 1.0)
    assert not told.rises(Severity.CAUTION, at(0.999), 1.0)
    assert told.rises(Severity.WARNING, at(1.0), 1.0)
    assert told.severity is Severity.CAUTION  # The WARNING has not held yet.
    assert not told.rises(Severity.WARNING, at(1.999), 1.0)
    assert told.rises(Severity.WARNING, at(2.0), 1.0)
    assert not told.rises(Severity.CAUTION, at(9.0), 1.0)
    assert told.severity is Severity.WARNING


def test_a_severity_that_was_interrupted_begins_anew() -> None:
    told = Escalation("one")
    told.observe(Severity.CAUTION, at(0.0))
    told.observe(None, at(0.5))
    assert not told.rises(Severity.CAUTION, at(1.0), 1.0)
    assert told.rises(Severity.CAUTION, at(2.0), 1.0)


def test_information_alone_is_never_told() -> None:
    assert not Escalation("one").rises(Severity.INFO, at(5.0), 0.0)


def test_a_conflict_is_over_once_it_has_been_quiet_for_long_enough() -> None:
    told = Escalation("one")
    assert told.rises(Severity.CAUTION, at(0.0), 0.0)
    assert not told.is_over(at(1.0), 5.0)
    assert not told.is_over(at(5.999), 5.0)
    assert told.is_over(at(6.0), 5.0)
    told.stays()
    assert not told.is_over(at(7.0), 5.0)
    told.stays_open(at(12.0), 5.0)
    assert told.rises(Severity.CAUTION, at(13.0), 0.0)  # It has come back.
    assert not told.rises(Severity.CAUTION, at(14.0), 0.0)


# --- what stays in its place ----------------------------------------------------------------


def stays(
    *, speed_m_s: float = 100.0, seconds: float = 10.0, label: str = "aircraft", size: float = 0.1,
    azimuth_deg: float = 30.0, **changed: Any,
) -> bool:  # fmt: skip
    """Return whether what turns away as if it stood 1 km off, 30 degrees right of ahead, stays.

    The camera flies north at 100 m/s, 50 m/s of which are across the line of sight.
    """
    views = [
        SimpleNamespace(latitude_deg=degrees, longitude_deg=8.0, height_m=1000.0)
        for degrees in (0.0, speed_m_s * seconds / 6_335_439.0 / DEGREE)
    ]
    ray = Ray(math.sin(azimuth_deg * DEGREE), math.cos(azimuth_deg * DEGREE), 0.0)
    observations = [
        SimpleNamespace(
            t_ns=round(t_s * SECOND_NS), ray=ray, size_rad=(size, size / 2.0),
            geometry=SimpleNamespace(view=view),
        )
        for t_s, view in zip((0.0, seconds), views, strict=True)
    ]  # fmt: skip
    track = SimpleNamespace(observations=observations, last=observations[-1], label=label)
    usual = {"turning_rad_s": (0.05, 0.0), "closing": 0.0, "closing_error": 0.0, "size_rad": size}
    return stays_in_place(cast("Any", track), approach(**(usual | changed)))


@pytest.mark.parametrize(
    ("label", "size", "is_standing"),
    [
        ("aircraft", 0.081, True), ("aircraft", 0.079, False),
        ("bird", 0.021, True), ("bird", 0.019, False),
    ],
)  # fmt: skip
def test_what_is_larger_than_an_aircraft_or_a_flock_where_it_would_stand_stays(
    label: str, size: float, is_standing: bool
) -> None:
    assert stays(label=label, size=size) is is_standing
    assert stays(label=label, size=size, azimuth_deg=-30.0, turning_rad_s=(-0.05, 0.0)) is (
        is_standing
    )


@pytest.mark.parametrize(
    ("sideward", "error", "is_standing"),
    [(0.0124, 0.0, True), (0.0126, 0.0, False), (-0.0124, 0.0, True), (-0.0126, 0.0, False),
     (0.0274, 0.005, True), (0.0276, 0.005, False)],
)  # fmt: skip
def test_it_turns_hardly_to_the_side_of_that(
    sideward: float, error: float, is_standing: bool
) -> None:
    """A quarter of the turning away, and three standard deviations."""
    assert stays(turning_rad_s=(0.05, sideward), turning_error=error) is is_standing


@pytest.mark.parametrize(
    ("closing", "error", "is_standing"),
    [(0.108, 0.0, True), (0.1085, 0.0, False), (0.138, 0.01, True), (0.1385, 0.01, False)],
)
def test_it_grows_no_faster_than_the_camera_comes_nearer(
    closing: float, error: float, is_standing: bool
) -> None:
    """At 86.6 m/s along 1 km, and a quarter more, with three standard deviations."""
    assert stays(closing=closing, closing_error=error) is is_standing
