"""What cameras follow: how sure it is, who it is by ADS-B, and when it is forgotten."""

from __future__ import annotations

import math
from typing import Any

import pytest

from airhilt.assistant.decision.line_of_sight import PictureGeometry
from airhilt.assistant.decision.traffic import Traffic
from airhilt.assistant.decision.visual_tracks import (
    SightConfig,
    VisualTrack,
    VisualTracks,
    belief_in,
)
from airhilt.geodesy.wgs84 import displaced
from airhilt.messages import AdsbReport, Box, CameraView, Detection, Detections
from airhilt.units import DEGREE, FOOT, KNOT, SECOND_NS

HERE = (38.85 * DEGREE, -77.04 * DEGREE)
FOCAL_PX = 320.0
"""The focal length of 640 pixels over 90 degrees."""


def view(height_m: float = 30.0, carrier: str | None = None, **given: Any) -> CameraView:
    """Return a level camera that looks north."""
    usual = {
        "latitude_deg": 38.85, "longitude_deg": -77.04, "height_m": height_m, "heading_deg": 0.0,
        "pitch_deg": 0.0, "roll_deg": 0.0, "horizontal_fov_deg": 90.0, "width_px": 640,
        "height_px": 360, "carrier": carrier,
    }  # fmt: skip
    return CameraView.model_validate(usual | given)


def report(
    north_m: float, east_m: float = 0.0, altitude_ft: float | None = 1000.0, **given: Any
) -> AdsbReport:
    latitude, longitude = displaced(HERE, north_m, east_m, 0.0)
    usual = {
        "icao24": "a1b2c3", "callsign": "AAL123", "t_adsb_in_ns": 0, "t_adsb_out_ns": 0,
        "latitude_deg": latitude / DEGREE, "longitude_deg": longitude / DEGREE,
        "altitude_ft": altitude_ft, "ground_speed_kt": 0.0, "track_deg": 0.0,
        "vertical_rate_fpm": 0.0, "nacp": 11, "nacv": 2, "receiver": "centre",
        "on_ground": altitude_ft is None, "emitter_category": "A1",
    }  # fmt: skip
    return AdsbReport.model_validate(usual | given)


def box(x_px: float, y_px: float, width_px: float = 6.0, height_px: float = 3.0) -> Box:
    return (
        x_px - width_px / 2.0, y_px - height_px / 2.0,
        x_px + width_px / 2.0, y_px + height_px / 2.0,
    )  # fmt: skip


# --- who it is by ADS-B -------------------------------------------------------------------------


def traffic(*reports: AdsbReport, ground_m: float | None = 0.0) -> Traffic:
    known = Traffic()
    known.ground_m = ground_m
    for each in reports:
        known.take_report(each, each.t_adsb_in_ns)
    return known


def explained(
    place: Box, *reports: AdsbReport, t_s: float = 0.0, ground_m: float | None = 0.0,
    camera: CameraView | None = None,
) -> str | None:  # fmt: skip
    geometry = PictureGeometry(camera or view())
    return traffic(*reports, ground_m=ground_m).explaining(geometry, place, round(t_s * SECOND_NS))


@pytest.mark.parametrize(("x_px", "y_px", "name"), [(320.0, 88.87, "AAL123"), (400.0, 88.87, None),
                                                    (320.0, 150.0, None)])  # fmt: skip
def test_a_box_is_that_of_who_should_be_seen_there(
    x_px: float, y_px: float, name: str | None
) -> None:
    """A kilometre north and 274.8 m above the camera: 88 px above the middle."""
    up_px = FOCAL_PX * (1000.0 * FOOT - 30.0) / 1000.0
    assert up_px == pytest.approx(180.0 - 92.07, abs=0.1)
    assert explained(box(x_px, y_px), report(1000.0)) == name


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize(("beyond_px", "name"), [(-0.3, "AAL123"), (0.3, None)])
def test_it_may_be_off_by_the_errors_of_the_position_its_size_and_the_box(
    side: float, beyond_px: float, name: str | None
) -> None:
    """3 m of NACp 11 and 8 m of half a light aircraft at 1,000 m, and twice 1.5 px. In height the
    25 m of two altimeters come to it."""
    height_m = 1000.0 * FOOT - 30.0
    range_m = math.hypot(1000.0, height_m)
    y_px = 180.0 - FOCAL_PX * height_m / 1000.0
    across_px = FOCAL_PX * 11.0 / range_m + 3.0 + 3.0  # The last 3 px are half of the box.
    assert explained(box(320.0 + side * (across_px + beyond_px), y_px), report(1000.0)) == name
    along_px = FOCAL_PX * 36.0 / range_m + 3.0 + 1.5
    assert explained(box(320.0, y_px + side * (along_px + beyond_px)), report(1000.0)) == name


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_it_is_carried_on_by_its_speed_and_its_climb(side: float) -> None:
    """At 100 kt eastward and 600 ft/min for 2 s; the error grows by 3 m/s."""
    level = view(1000.0 * FOOT)
    moved = report(
        1000.0, track_deg=90.0 * side % 360.0, ground_speed_kt=100.0, vertical_rate_fpm=side * 600.0
    )
    east_px = side * FOCAL_PX * 100.0 * KNOT * 2.0 / 1000.0
    up_px = side * FOCAL_PX * 20.0 * FOOT / 1000.0
    across_px = FOCAL_PX * (8.0 + 3.0 + 6.0) / 1005.0 + 6.0
    for sign in (1.0, -1.0):
        x_px = 320.0 + east_px
        inside = box(x_px + sign * (across_px - 0.3), 180.0 - up_px)
        outside = box(x_px + sign * (across_px + 0.3), 180.0 - up_px)
        assert explained(inside, moved, t_s=2.0, camera=level) == "AAL123"
        assert explained(outside, moved, t_s=2.0, camera=level) is None


def test_where_the_ground_is_not_known_its_direction_alone_counts() -> None:
    for y_px in (20.0, 180.0, 300.0):
        assert explained(box(320.0, y_px), report(1000.0), ground_m=None) == "AAL123"
        assert explained(box(420.0, y_px), report(1000.0), ground_m=None) is None


def test_nobody_is_explained_by_the_carrier_of_the_camera_or_by_who_is_behind_it() -> None:
    level = view(1000.0 * FOOT, carrier="AAL123")
    assert explained(box(320.0, 180.0), report(1000.0), camera=level) is None
    assert explained(box(320.0, 180.0), report(-1000.0), camera=view(1000.0 * FOOT)) is None


def test_the_ground_is_as_high_as_the_altimeter_of_a_carrier_less_its_height() -> None:
    known = traffic(report(0.0, altitude_ft=3000.0, vertical_rate_fpm=600.0), ground_m=None)
    known.learn_ground(view(700.0, carrier="AAL123"), 2 * SECOND_NS)
    assert known.ground_m == pytest.approx(3020.0 * FOOT - 700.0)
    known.learn_ground(view(100.0, carrier="DAL456"), 2 * SECOND_NS)
    assert known.ground_m == pytest.approx(3020.0 * FOOT - 700.0)


@pytest.mark.parametrize(
    ("altitude_ft", "silent_s", "is_known"),
    [(1000.0, 15.0, True), (1000.0, 15.1, False), (None, 30.0, True), (None, 30.1, False)],
)
def test_who_is_silent_for_15_s_is_forgotten_and_on_the_ground_for_30_s(
    altitude_ft: float | None, silent_s: float, is_known: bool
) -> None:
    """Who stands squitters every five seconds only."""
    other = report(9000.0, icao24="abcdef", callsign="DAL456")
    known = traffic(report(1000.0, altitude_ft=altitude_ft), other)
    known.take_report(other, round(silent_s * SECOND_NS))
    known.forget(round(silent_s * SECOND_NS))
    assert known.addresses("AAL123", "DAL456")[-1:] == ("abcdef",)
    assert (known.addresses("AAL123") == ("a1b2c3",)) is is_known


# --- how sure it is -----------------------------------------------------------------------------


def shown(
    t_s: float, place: Box | None, *, confidence: float = 0.5, label: Any = "truck",
    number: int | None = 1, camera: str = "tower", **given: Any,
) -> Detections:  # fmt: skip
    found = () if place is None else (
        Detection(label=label, confidence=confidence, track_id=number, hits=1, box=place),
    )  # fmt: skip
    return Detections(
        camera=camera, seq=0, t_frame_ns=round(t_s * SECOND_NS), view=view(**given),
        detections=found, engine="test",
    )  # fmt: skip


def followed(*pictures: Detections, config: SightConfig | None = None) -> VisualTracks:
    tracks = VisualTracks(config)
    for each in pictures:
        tracks.take_detections(each, each.t_frame_ns)
    return tracks


def only(tracks: VisualTracks) -> VisualTrack:
    (track,) = tracks
    return track


STILL = box(100.0, 200.0, 20.0, 10.0)


def test_the_belief_in_what_never_moved_is_that_of_one_look() -> None:
    """The errors of pictures that are alike are alike too."""
    looks = [(0.0, 0.9), (0.5, 0.3), (1.0, 0.6), (1.5, 0.1)]
    track = only(followed(*(shown(t_s, STILL, confidence=sure) for t_s, sure in looks)))
    assert track.belief == track.belief_of_one_look == pytest.approx(0.6)
    assert not track.has_moved


def test_what_is_hardly_there_any_more_is_forgotten() -> None:
    begun = [shown(0.0, STILL, confidence=0.2), shown(0.5, STILL, confidence=0.2)]
    gone = [shown(0.6 + 0.1 * n, None) for n in range(40)]
    ages = [len(list(followed(*begun, *gone[:count]))) for count in range(40)]
    assert ages[0] == 1
    assert ages[-1] == 0
    lasted = ages.index(0)
    # 0.2, then looks whose mean is lower and lower: 0.2 / 5 is less than 0.05.
    assert 0.6 + 0.1 * lasted == pytest.approx(2.1, abs=0.6)


@pytest.mark.parametrize(("moved_px", "has_moved"), [(13.9, False), (14.1, True), (-14.1, True)])
def test_it_has_moved_from_half_of_its_size_and_4_px_on(moved_px: float, has_moved: bool) -> None:
    for place in (
        box(100.0 + moved_px, 200.0, 20.0, 10.0),
        box(100.0, 200.0 + moved_px, 20.0, 10.0),
    ):
        assert only(followed(shown(0.0, STILL), shown(0.1, place))).has_moved is has_moved


@pytest.mark.parametrize(("silent_s", "is_known"), [(3.0, True), (3.1, False)])
def test_it_stays_known_by_adsb_for_3_s(silent_s: float, is_known: bool) -> None:
    up_px = FOCAL_PX * (1000.0 * FOOT - 30.0) / 1000.0
    there, elsewhere = box(320.0, 180.0 - up_px), box(120.0, 300.0)
    tracks = VisualTracks()
    tracks.traffic.ground_m = 0.0
    tracks.take_report(report(1000.0), 0)
    for t_s, place in ((0.0, there), (silent_s, elsewhere)):
        tracks.take_detections(shown(t_s, place), round(t_s * SECOND_NS))
    assert (only(tracks).explained_by == "AAL123") is is_known


# --- what the detector does not number ----------------------------------------------------------


@pytest.mark.parametrize(("moved_px", "is_same"), [(35.9, True), (36.1, False)])
def test_what_has_no_number_is_the_nearest_within_one_and_a_half_sizes_and_6_px(
    moved_px: float, is_same: bool
) -> None:
    again = box(100.0 + moved_px, 200.0, 20.0, 10.0)
    tracks = followed(shown(0.0, STILL, number=None), shown(0.1, again, number=None))
    assert (len(list(tracks)) == 1) is is_same


def test_two_without_numbers_are_two_and_the_nearer_one_is_each() -> None:
    def both(t_s: float, first: Box, second: Box) -> Detections:
        found = tuple(
            Detection(label="truck", confidence=0.5, track_id=None, hits=1, box=each)
            for each in (first, second)
        )
        return shown(t_s, None).model_copy(update={"detections": found})

    left, right = box(100.0, 200.0, 20.0, 10.0), box(125.0, 200.0, 20.0, 10.0)
    tracks = followed(both(0.0, left, right), both(0.1, box(123.0, 200.0, 20.0, 10.0),
                                                   box(102.0, 200.0, 20.0, 10.0)))  # fmt: skip
    moves = {track.observations[0].box: track.last.box for track in tracks}
    assert moves == {left: box(102.0, 200.0, 20.0, 10.0), right: box(123.0, 200.0, 20.0, 10.0)}


# --- whether it is there ------------------------------------------------------------------------


def lasting(seconds: float, confidence: float = 0.9, camera: str = "tower") -> list[Detections]:
    steps = round(seconds / 0.25)
    return [shown(0.25 * n, STILL, confidence=confidence, camera=camera) for n in range(steps + 1)]


@pytest.mark.parametrize(
    ("seconds", "confidence", "is_there"),
    [(1.0, 0.9, True), (0.75, 0.9, False), (2.0, 0.71, True), (2.0, 0.69, False)],
)
def test_one_camera_must_show_it_for_a_second_with_a_belief_of_0_7(
    seconds: float, confidence: float, is_there: bool
) -> None:
    tracks = followed(*lasting(seconds, confidence))
    assert tracks.shows(tracks) is is_there


def test_two_cameras_need_not_wait_and_their_beliefs_add_up() -> None:
    tracks = followed(*lasting(0.5, 0.5), *lasting(0.5, 0.5, "other"))
    assert belief_in(tracks) == pytest.approx(0.75)
    assert tracks.shows(tracks)
    assert not tracks.shows([])
    three = followed(*lasting(0.5, 0.5), *lasting(0.5, 0.5, "other"), config=SightConfig(cameras=3))
    assert not three.shows(three)
