"""Aircraft without a transponder: seen, they are told of in time; what is known is not told."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.approach import Approach, approach_of
from airhilt.assistant.decision.intruders import IntruderConfig, IntruderWatch, _note, _where
from airhilt.assistant.decision.line_of_sight import PictureGeometry, Ray
from airhilt.assistant.decision.visual_tracks import Observation, VisualTracks
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.geodesy.relative_motion import Minima
from airhilt.messages import Climb, Detections, Severity, Turn, VisibleClass
from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE, SECOND_NS
from breadth import mostly_slow
from encounters import Encounter, Flight
from projected import AIRLINER, CESSNA, FLOCK, Body, Camera, still

SEEDS = mostly_slow(range(2), 0)
MEET_S = 34.0
KT = 233.0
MINIMA = Minima(0.66 * NAUTICAL_MILE, 450.0 * FOOT)


def meeting(
    seed: int = 1,
    track: float = 270.0,
    kt: float = 106.0,
    altitude_ft: float = 4000.0,
    offset_nm: float = 0.0,
    size: tuple[float, float, float] = CESSNA,
    label: str = "airplane",
    equipped: bool = False,
    own_equipped: bool = True,
    own_ft: float = 4000.0,
    meet_s: float = MEET_S,
    **how: Any,
) -> Encounter:
    """Return an airliner with a camera on its nose, and somebody whom it meets after a while."""
    own = Flight(
        "AAL123", "a1b2c3", 90.0, KT * meet_s / 3600.0, own_ft, KT, seed=seed,
        equipped=own_equipped,
    )  # fmt: skip
    other = Flight(
        "N172SP", "a0c172", track, kt * meet_s / 3600.0, altitude_ft, kt, offset_nm=offset_nm,
        seed=seed, equipped=equipped,
    )  # fmt: skip
    encounter = Encounter([own, other], meet_s + 40.0, minima=(0.66, 450.0))
    encounter.cameras = [own.nose(other.body(label, size), seed=seed, **({"rate_hz": 4.0} | how))]
    return encounter


def unnumbered(found: Detections) -> Detections:
    """Return detections as a detector gives them that follows nothing."""
    plain = tuple(each.model_copy(update={"track_id": None}) for each in found.detections)
    return found.model_copy(update={"detections": plain})


def first(encounter: Encounter, severity: str) -> float:
    """Return how long before the encounter that severity was told first."""
    return next(MEET_S - t for t, a in encounter.told if a.severity == severity and a.active)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("error_px", [0.4, 1.0])
def test_a_light_aircraft_head_on_is_a_warning_a_quarter_of_a_minute_before(
    seed: int, error_px: float
) -> None:
    encounter = meeting(seed, error_px=error_px).fly()
    assert 12.0 < first(encounter, "WARNING") < 22.0
    warning = next(each for each in encounter.to("AAL123") if each.severity == "WARNING")
    assert warning.recipients == ("AAL123", "ATC")
    assert warning.kind == "loss_of_separation"
    assert warning.traffic == ("AAL123", "unidentified")
    assert warning.evidence.sources == ("vision",)
    assert isinstance(warning.recommendation, Climb)
    assert warning.message.endswith(". Traffic ahead, no transponder, closing")
    left_s = warning.evidence.time_to_closest_approach_s
    assert left_s == pytest.approx(first(encounter, "WARNING"), rel=0.5)


def test_it_is_one_alert_that_only_rises_and_ends_once_the_two_are_past() -> None:
    encounter = meeting().fly()
    assert len({advisory.id for _, advisory in encounter.told}) == 1
    ranks = [advisory.severity.rank for advisory in encounter.to("ATC")[:-1]]
    assert ranks == sorted(ranks)
    assert not encounter.to("ATC")[-1].active
    assert encounter.told[-1][0] > MEET_S


@pytest.mark.parametrize("seed", SEEDS)
def test_who_crosses_from_the_left_is_seen_by_a_wider_camera_only(seed: int) -> None:
    wide = {"fov_deg": 54.0, "width_px": 1920, "height_px": 1080}
    assert meeting(seed, track=180.0).fly().told == []
    encounter = meeting(seed, track=180.0, **cast(dict[str, Any], wide)).fly()
    assert first(encounter, "WARNING") > 8.0
    assert "Traffic ahead to the left" in encounter.to("AAL123")[-2].message


@pytest.mark.parametrize(
    "how",
    [{"altitude_ft": 3000.0}, {"altitude_ft": 5000.0}, {"offset_nm": 0.5}, {"offset_nm": -0.5}],
    ids=["1000 ft below", "1000 ft above", "half a mile to one side", "and to the other"],
)
@pytest.mark.parametrize("seed", SEEDS)
def test_who_passes_by_is_no_warning(seed: int, how: dict[str, float]) -> None:
    encounter = meeting(seed, **cast(dict[str, Any], how)).fly()
    assert "WARNING" not in encounter.severities("ATC")


@pytest.mark.parametrize(("altitude_ft", "sense"), [(3800.0, "climb"), (4200.0, "descend")])
@pytest.mark.parametrize("seed", SEEDS)
def test_the_way_out_is_away_from_it(seed: int, altitude_ft: float, sense: str) -> None:
    encounter = meeting(seed, altitude_ft=altitude_ft).fly()
    told = [a.recommendation for a in encounter.to("AAL123") if a.recommendation]
    assert told
    assert {each.sense for each in told} == {sense}
    assert {each.altitude_ft % 100.0 for each in told} == {0.0}


def test_nobody_is_sent_down_near_the_ground() -> None:
    encounter = meeting(altitude_ft=2000.0, own_ft=1900.0).fly()
    told = [a.recommendation for a in encounter.to("AAL123") if a.recommendation]
    assert told
    assert all(isinstance(each, Turn) and each.degrees > 0 for each in told)


@pytest.mark.parametrize("seed", SEEDS)
def test_who_squitters_is_the_matter_of_the_watch_for_separation(seed: int) -> None:
    """It is on a collision course, and seen all the way."""
    encounter = meeting(seed, equipped=True, size=AIRLINER, meet_s=60.0).fly()
    assert {advisory.evidence.sources for _, advisory in encounter.told} == {("adsb",)}


def test_but_to_a_camera_whose_carrier_does_not_even_who_squitters_is_an_intruder() -> None:
    encounter = meeting(equipped=True, own_equipped=False, size=AIRLINER).fly()
    warning = next(a for a in encounter.to("AAL123") if a.severity is Severity.WARNING)
    assert warning.traffic == ("AAL123", "N172SP")
    assert warning.message == "AAL123 turn right 30 degrees. Traffic N172SP ahead, closing"


def test_a_new_track_of_the_same_aircraft_is_the_same_alert() -> None:
    encounter = meeting()
    (nose,) = encounter.cameras
    detect = nose.detections

    def renumbered(t_ns: int) -> Detections:
        found = detect(t_ns)
        later = t_ns > 24 * SECOND_NS
        return found.model_copy(
            update={
                "detections": tuple(
                    each.model_copy(update={"track_id": 7 if later else 3})
                    for each in found.detections
                )
            }
        )

    nose.detections = renumbered
    assert len({advisory.id for _, advisory in encounter.fly().told}) == 1


def test_what_flickers_here_and_there_is_nobody() -> None:
    def somewhere(t_s: float) -> tuple[tuple[float, float, float], float]:
        east, north, up = np.random.default_rng(round(100 * t_s)).uniform(-400.0, 400.0, 3)
        (own_east, own_north, height), _ = own.place(t_s)
        return (own_east + 2500.0 + east, own_north + north, height + 0.4 * up), 0.0

    encounter = meeting()
    own = encounter.flights[0]
    ghost = replace(still("airplane", (0.0, 0.0, 0.0), CESSNA), at=somewhere)
    encounter.cameras = [own.nose(ghost, recall=0.3)]
    (nose,) = encounter.cameras
    detect = nose.detections
    nose.detections = lambda t_ns: unnumbered(detect(t_ns))
    assert encounter.fly().told == []


def test_a_flock_ahead_is_birds_and_the_way_out_is_up() -> None:
    encounter = meeting(kt=20.0, label="bird", size=FLOCK).fly()
    warning = encounter.to("AAL123")[-2]
    assert warning.message.startswith("AAL123 climb to ")
    assert warning.message.endswith(". Birds ahead, closing")


def test_what_may_stand_on_the_ground_is_not_in_the_air() -> None:
    """A parked aircraft right before one that descends towards it."""
    own = Flight("AAL123", "a1b2c3", 90.0, 2.2, 0.0, 140.0, waver_ft=0.0)

    def descends(t_s: float) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        (east, north, _), track = own.place(t_s)
        return (east, north, 220.0 - 3.7 * t_s), (track, -2.0 * DEGREE, 0.0)

    parked = still("airplane", (0.0, 0.0, 0.0), CESSNA)
    nose = replace(own.nose(parked), look=descends)
    encounter = Encounter([own], 45.0, cameras=[nose])
    assert encounter.fly().told == []


def test_time_goes_on_after_the_last_picture() -> None:
    """Contact is 26 s away in it, and 24 s away when it is judged again: within 25 s."""
    visual_tracks = VisualTracks()
    watch = IntruderWatch(IntruderConfig(), visual_tracks, lambda _: None, lambda: MINIMA)
    camera = closing_camera(130.0, 0.0, 26.0, 5.0, sizes=AIRLINER)
    for step in range(41):
        visual_tracks.take_detections(
            camera.detections(step * SECOND_NS // 8), step * SECOND_NS // 8
        )
    told = [
        [(alert.severity, len(alert.recipients)) for alert in watch.judge(t_ns)]
        for t_ns in (round(t_s * SECOND_NS) for t_s in (5.0, 5.5, 7.0, 7.5))
    ]
    assert told == [[], [(Severity.CAUTION, 2)], [], [(Severity.WARNING, 2)]]


# --- by motion ------------------------------------------------------------------------------


def watching(camera: Camera, seconds: float, later_s: Sequence[float] = ()) -> list[Alert]:
    """Return what is told while a camera watches, and at some times after that."""
    visual_tracks = VisualTracks()
    watch = IntruderWatch(IntruderConfig(), visual_tracks, lambda _: None, lambda: MINIMA)
    told = []
    for step in range(round(8 * seconds) + 1):
        t_ns = step * SECOND_NS // 8
        visual_tracks.take_detections(camera.detections(t_ns), t_ns)
        told += watch.judge(t_ns)
    for t_s in later_s:
        visual_tracks.forget(round(t_s * SECOND_NS))
        told += watch.judge(round(t_s * SECOND_NS))
    return told


def over_ground(*bodies: Body, seed: int = 1, **how: Any) -> Camera:
    """Return a camera that flies north at 120 m/s, 1,100 m above the ground, and looks ahead."""

    def look(t_s: float) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        return (0.0, 120.0 * t_s, 1100.0), (0.0, 0.0, 0.0)

    return Camera(
        "c", FRAME, look, list(bodies), "AAL123", fov_deg=54.0, width_px=1920, height_px=1080,
        seed=seed, **how,
    )  # fmt: skip


@pytest.mark.parametrize("up_m", [0.0, 700.0, 1500.0])
@pytest.mark.parametrize("label", ["airplane", "bird"])
def test_a_wood_or_a_cloud_larger_than_any_aircraft_is_none(
    label: VisibleClass, up_m: float
) -> None:
    """It grows as something does that is met in less than a minute, and nearly stays in place."""
    cloud = still(label, (1500.0, 6500.0, up_m), (300.0, 250.0, 80.0))
    assert watching(over_ground(cloud), 6.0) == []


def test_who_climbs_up_from_below_is_in_the_air_for_all_that() -> None:
    """It stays in one direction, 6 degrees below the horizon, and the ground behind it does not."""

    def climbs(t_s: float) -> tuple[tuple[float, float, float], float]:
        left_s = 18.0 - t_s
        return (60.0 * left_s, 120.0 * 18.0 + 50.0 * left_s, 1100.0 - 18.0 * left_s), 0.0

    intruder = replace(still("airplane", (0.0, 0.0, 0.0), AIRLINER), at=climbs)
    told = watching(over_ground(intruder), 8.0)
    assert told[-1].severity is Severity.WARNING


@pytest.mark.parametrize("closing_m_s", [130.0, 170.0])
def test_who_will_pass_wide_of_the_nose_is_no_matter(closing_m_s: float) -> None:
    """It nears and grows as surely as one on a collision course, and passes 50 spans aside."""
    assert watching(closing_camera(closing_m_s, 550.0, 22.0, 6.0), 6.0) == []
    assert watching(closing_camera(closing_m_s, 0.0, 22.0, 6.0), 6.0) != []


def test_what_is_doubtful_in_all_pictures_is_not_certain_in_many() -> None:
    """A detector takes a cloud for an aircraft in every other picture, and it comes nearer."""
    cloud = closing_camera(130.0, 0.0, 15.0, 6.0, sizes=AIRLINER)
    cloud.recall, cloud.confidence = 0.5, 0.6
    assert [alert.severity for alert in watching(cloud, 6.0)] == [Severity.ADVISORY]
    aircraft = closing_camera(130.0, 0.0, 15.0, 6.0, sizes=AIRLINER)
    assert watching(aircraft, 6.0)[-1].severity is Severity.WARNING


def test_nobody_goes_back_before_the_two_are_past_by_the_minimum() -> None:
    """Contact is 24 s after the last picture, and the two draw apart at 40 m/s."""
    apart_s = 4.0 + 24.0 + MINIMA.horizontal_m / 40.0
    later_s = [4.5 + 0.5 * step for step in range(420)]

    def told(until_s: float) -> list[Alert]:
        camera = closing_camera(40.0, 0.0, 24.0, 4.0)
        return watching(camera, 4.0, [t_s for t_s in later_s if t_s < until_s])

    assert told(apart_s)[-1].severity is Severity.WARNING
    assert not told(math.inf)[-1].active


# --- time to contact ------------------------------------------------------------------------

FRAME = LocalFrame((38.9 * DEGREE, -77.0 * DEGREE))


def closing_camera(
    closing_m_s: float,
    miss_m: float,
    left_s: float,
    seconds: float,
    error_px: float = 0.0,
    roll: float = 0.0,
    seed: int = 1,
    sizes: tuple[float, float, float] = (3.0, 11.0, 3.0),
) -> Camera:
    """Return a camera, and something that passes it so long after some seconds."""

    def at(t_s: float) -> tuple[tuple[float, float, float], float]:
        return (miss_m, closing_m_s * (left_s + seconds - t_s), 1000.0), 0.0

    def look(t_s: float) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        return (0.0, 0.0, 1000.0), (0.0, 0.02 * math.sin(t_s), roll * math.sin(t_s))

    other = replace(still("airplane", (0.0, 0.0, 0.0), sizes), at=at)
    return Camera(
        "c", FRAME, look, [other], "AAL123", fov_deg=25.0, width_px=1280, error_px=error_px,
        seed=seed, smallest_px=0.0,
    )  # fmt: skip


def glimpses_of(
    closing_m_s: float, miss_m: float, left_s: float, seconds: float, *how: Any, **more: Any
) -> list[Observation]:
    """Return what such a camera sees."""
    camera = closing_camera(closing_m_s, miss_m, left_s, seconds, *how, **more)
    found = [camera.detections(round(k * SECOND_NS / 8)) for k in range(round(8 * seconds) + 1)]
    return [
        Observation.of(f.t_frame_ns, PictureGeometry(f.view), f.detections[0].box, 0.9)
        for f in found
    ]


@settings(max_examples=30)
@given(
    closing=st.floats(60.0, 250.0), left_s=st.floats(4.0, 20.0), roll=st.floats(-0.3, 0.3),
    miss=st.floats(-20.0, 20.0),
)  # fmt: skip
def test_without_errors_the_time_to_contact_is_right_however_the_camera_rolls(
    closing: float, left_s: float, roll: float, miss: float
) -> None:
    approach = approach_of(glimpses_of(closing, miss, left_s, 3.0, 0.0, roll))
    # A wing that is rolled is as high as it is wide: its diagonal is not quite the same.
    assert approach.time_s == pytest.approx(left_s, rel=0.25 if roll else 0.05)
    assert approach.least_miss() <= abs(miss) / 11.0 + 3.0


@pytest.mark.parametrize("error_px", [0.5, 1.0, 2.0])
def test_the_error_that_it_tells_is_about_the_one_that_it_makes(error_px: float) -> None:
    shifts = []
    for seed in range(30):
        approach = approach_of(glimpses_of(170.0, 0.0, 12.0, 3.0, error_px, 0.0, seed))
        shifts.append((approach.closing - 1.0 / 12.0) / approach.closing_error)
    rms = math.sqrt(sum(shift**2 for shift in shifts) / len(shifts))
    assert 0.3 < rms < 2.0


def test_errors_that_last_for_a_second_are_not_taken_for_growth() -> None:
    """A wing thinner than a pixel shows for a second, then does not: boxes err by a fifth."""
    step = math.exp(-1.0 / 8.0)
    shifts = []
    for seed in range(30):
        generator = np.random.default_rng(seed)
        seen, error = [], generator.normal(0.0, 0.2)
        for each in glimpses_of(60.0, 0.0, 40.0, 5.0, 0.0, 0.0):
            error = step * error + generator.normal(0.0, 0.2 * math.sqrt(1.0 - step * step))
            width, height = each.size_rad
            wrong = (width * math.exp(error), height * math.exp(error))
            seen.append(each._replace(size_rad=wrong))
        approach = approach_of(seen)
        shifts.append((approach.closing - 1.0 / 40.0) / approach.closing_error)
    rms = math.sqrt(sum(shift**2 for shift in shifts) / len(shifts))
    assert rms < 2.0


@pytest.mark.parametrize("shown", [(0.65, 1.05), (0.8, 1.2), (1.0, 0.7)])
def test_what_grows_because_more_of_it_shows_may_be_far_longer_away_than_it_seems(
    shown: tuple[float, float],
) -> None:
    """A wing drifts from between two rows of pixels into one: within 5 s all of it shows."""
    left_s = 53.0
    seen = glimpses_of(65.0, 0.0, left_s, 5.0, 0.2, 0.0)
    parts = np.linspace(*shown, len(seen))
    wrong = [
        each._replace(size_rad=(part * each.size_rad[0], part * each.size_rad[1]))
        for each, part in zip(seen, parts, strict=True)
    ]
    assert approach_of(wrong).longest_s > left_s


@pytest.mark.parametrize("phase", range(5))
def test_wings_that_come_and_go_do_not_hide_that_something_nears(phase: int) -> None:
    """They are thinner than a pixel: now only the fuselage shows, now all of it."""
    seen = glimpses_of(130.0, 0.0, 12.0, 5.0, 0.0, 0.0)
    narrow = [
        observation._replace(size_rad=(0.4 * observation.size_rad[0], observation.size_rad[1]))
        if math.sin(math.tau * (number / 8.0 / 1.6 + phase / 5.0)) < 0.0 else observation
        for number, observation in enumerate(seen)
    ]  # fmt: skip
    approach = approach_of(narrow)
    assert approach.is_growing
    assert approach.time_s == pytest.approx(12.0, rel=0.35)


@pytest.mark.parametrize("wild", [(0, 2), (2, 3), (12, 20), (22, 24)])
def test_two_wild_boxes_of_many_do_not_turn_the_direction(wild: tuple[int, int]) -> None:
    """They are of something beside it, that the detector takes for it."""
    seen = glimpses_of(170.0, 0.0, 12.0, 3.0, 0.4, 0.0)
    for number in wild:
        t_ns, geometry, (left, top, right, bottom), *_ = seen[number]
        beside = (left + 20.0, top + 8.0, right + 20.0, bottom + 8.0)
        seen[number] = Observation.of(t_ns, geometry, beside, 0.9)
    approach = approach_of(seen)
    assert math.hypot(*approach.turning_rad_s) < 0.01 * DEGREE
    assert approach.least_miss() < 0.5


# --- where it is, and what is told of it ----------------------------------------------------


@pytest.mark.parametrize(
    ("right_deg", "where"),
    [
        (0.0, "ahead"),
        (14.9, "ahead"),
        (-14.9, "ahead"),
        (15.1, "ahead to the right"),
        (-15.1, "ahead to the left"),
        (59.9, "ahead to the right"),
        (60.1, "to the right"),
        (-60.1, "to the left"),
        (119.9, "to the right"),
        (-119.9, "to the left"),
        (120.1, "behind"),
        (180.0, "behind"),
        (-120.1, "behind"),
    ],
)
def test_a_direction_is_told_as_a_crew_sees_it(right_deg: float, where: str) -> None:
    heading_deg = 350.0
    azimuth_rad = (heading_deg + right_deg) * DEGREE
    ray = Ray(math.sin(azimuth_rad), math.cos(azimuth_rad), 0.0)
    view = SimpleNamespace(heading_deg=heading_deg)
    track = SimpleNamespace(last=SimpleNamespace(ray=ray, geometry=SimpleNamespace(view=view)))
    assert _where(cast(Any, SimpleNamespace(track=track, ray=ray))) == where


def test_the_evidence_has_the_time_with_its_error_and_how_the_direction_turns() -> None:
    """1 / 0.05 s; an error of 0.005 / s is one of a tenth, 2 s; 0.03 and 0.04 are 0.05 together."""
    approach = Approach(0.05, 0.003, 0.004, (0.03 * DEGREE, 0.04 * DEGREE), 0.001, 0.01)
    encounter = SimpleNamespace(approach=approach, track=SimpleNamespace(camera="nose"))
    assert _note(cast(Any, encounter)) == (
        "nose: contact in 20 s, give or take 2 s; direction turns by 0.05 degrees/s"
    )
