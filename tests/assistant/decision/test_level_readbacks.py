"""A readback and a doubt about a level matter for a while, and then no more."""

from __future__ import annotations

import pytest

from airhilt.assistant.decision.air_tracks import AirTracks
from airhilt.assistant.decision.guard import ConfidenceGuard
from airhilt.assistant.decision.level_readbacks import LevelReadbacks
from airhilt.assistant.decision.loss_prediction import SeparationStandard
from airhilt.messages import AdsbReport, RosterEntry
from airhilt.units import FOOT, SECOND_NS
from decisions import transcript

CONFIG = SeparationStandard()
CLIMB = "American one two three, climb and maintain flight level three three zero."
WRONG = "Climb and maintain flight level three four zero, American one two three."
UNSURE = "Climb and maintain flight level three four? zero, American one two three."


def report(callsign: str, longitude_deg: float, track_deg: float, altitude_ft: float) -> AdsbReport:
    return AdsbReport(
        t_ns=0, icao24=callsign.encode().hex()[-6:], callsign=callsign, latitude_deg=38.9,
        longitude_deg=longitude_deg, altitude_ft=altitude_ft, ground_speed_kt=480.0,
        track_deg=track_deg, vertical_rate_fpm=0, nacp=9, nacv=2, receiver="all", t_adsb_in_ns=0,
        t_adsb_out_ns=0,
    )  # fmt: skip


@pytest.fixture
def tracks() -> AirTracks:
    """Two that fly towards each other, 3,000 ft apart."""
    tracks = AirTracks()
    tracks.take_report(report("AAL123", -78.0, 90.0, 31_000.0), 0)
    tracks.take_report(report("DAL456", -76.0, 270.0, 34_000.0), 0)
    return tracks


@pytest.fixture
def unheard(tracks: AirTracks) -> LevelReadbacks:
    """Nothing was said yet. One unsure word is in doubt, and two that were heard alike are not."""
    return LevelReadbacks(tracks, ConfidenceGuard(0.7))


@pytest.fixture
def readbacks(tracks: AirTracks) -> LevelReadbacks:
    """The lower one is told to climb by 2,000 ft."""
    followed = LevelReadbacks(tracks, ConfidenceGuard())
    assert is_misread(followed, "climb", CLIMB, 20.0) is False
    return followed


def is_misread(followed: LevelReadbacks, name: str, text: str, t_tx_s: float) -> bool:
    t_tx_ns, t_end_ns = round(t_tx_s * SECOND_NS), round((t_tx_s + 5.0) * SECOND_NS)
    heard = transcript(name, 134_325, t_tx_ns, t_end_ns, text)
    return followed.take_transcript(t_end_ns, heard, CONFIG) is not None


@pytest.mark.parametrize(("t_tx_s", "misread"), [(26.0, True), (55.0, True), (55.1, False)])
def test_what_is_said_more_than_half_a_minute_after_an_instruction_is_no_readback_of_it(
    readbacks: LevelReadbacks, t_tx_s: float, misread: bool
) -> None:
    assert is_misread(readbacks, "readback", WRONG, t_tx_s) is misread


@pytest.mark.parametrize(("t_s", "is_asked"), [(31.0, True), (151.0, True), (151.1, False)])
def test_a_doubt_is_asked_about_for_two_minutes(
    readbacks: LevelReadbacks, t_s: float, is_asked: bool
) -> None:
    assert not is_misread(readbacks, "readback", UNSURE, 26.0)
    doubts = list(readbacks.doubts(round(t_s * SECOND_NS), CONFIG))
    assert [traffic for _, traffic in doubts] == (["DAL456"] if is_asked else [])


def test_an_unsure_readback_that_agrees_is_believed(
    readbacks: LevelReadbacks, tracks: AirTracks
) -> None:
    said = "Climb and maintain flight level three three? zero, American one two three."
    assert not is_misread(readbacks, "readback", said, 26.0)
    assert list(readbacks.doubts(151 * SECOND_NS, CONFIG)) == []
    assert [track.cleared_m for track in tracks] == [pytest.approx(33_000.0 * FOOT), None]


@pytest.mark.parametrize(
    "senseless",
    [
        "Up to thirty four, American one two three.",
        "Climb and maintain three four thousand, American one two three.",
    ],
)
def test_a_level_that_was_heard_well_and_is_doubtful_all_the_same_is_asked_for(
    readbacks: LevelReadbacks, senseless: str
) -> None:
    assert not is_misread(readbacks, "readback", senseless, 26.0)
    ((doubt, _),) = readbacks.doubts(31 * SECOND_NS, CONFIG)
    assert (doubt.slot, doubt.said.altitude_ft) == ("altitude", 34_000.0)


@pytest.mark.parametrize(("ceiling_ft", "misread"), [(41_000.0, True), (33_500.0, False)])
def test_a_level_above_the_ceiling_of_the_aircraft_is_no_wrong_readback_but_doubtful(
    readbacks: LevelReadbacks, ceiling_ft: float, misread: bool
) -> None:
    readbacks.take_roster(
        [RosterEntry(callsign="AAL123", category="aircraft", type="B738", ceiling_ft=ceiling_ft)]
    )
    assert is_misread(readbacks, "readback", WRONG, 26.0) is misread


OTHER = "Climb and maintain flight level three five? zero, American one two three."
UNSURE_CLIMB = "American one two three, climb and maintain flight level three three? zero."


@pytest.mark.parametrize(
    ("calls", "misread"),
    [
        ([CLIMB, UNSURE, UNSURE], [False, False, True]),
        ([CLIMB, OTHER, UNSURE], [False, False, False]),
        ([UNSURE_CLIMB, WRONG], [False, False]),
        ([UNSURE_CLIMB, UNSURE_CLIMB, WRONG], [False, False, True]),
    ],
    ids=["a readback twice alike", "two levels", "an instruction", "an instruction twice alike"],
)
def test_a_level_that_is_heard_twice_alike_is_believed(
    unheard: LevelReadbacks, calls: list[str], misread: list[bool]
) -> None:
    found = [
        is_misread(unheard, f"call {number}", text, 20.0 + 6.0 * number)
        for number, text in enumerate(calls)
    ]
    assert found == misread


def test_a_level_that_differs_from_an_unsure_one_is_asked_about_at_once(
    unheard: LevelReadbacks,
) -> None:
    unsure = "American one two three, climb and maintain flight level three four? zero."
    is_misread(unheard, "climb", unsure, 20.0)
    other = "Climb and maintain flight level three three zero, American one two three."
    assert not is_misread(unheard, "readback", other, 26.0)
    ((doubt, _),) = unheard.doubts(31 * SECOND_NS, CONFIG)
    assert doubt.transcript.id == "climb"


def test_a_level_that_nobody_gave_is_expected_once_it_was_heard_twice(
    unheard: LevelReadbacks, tracks: AirTracks
) -> None:
    expected = []
    for number in range(2):
        is_misread(unheard, f"call {number}", UNSURE, 20.0 + 6.0 * number)
        (aal123,) = (track for track in tracks if track.callsign == "AAL123")
        expected.append(aal123.cleared_m)
    assert expected == [None, pytest.approx(34_000.0 * FOOT)]


# --- who is near a level ----------------------------------------------------------------------


def is_told(*others: AdsbReport) -> bool:
    """Return whether a wrong readback of AAL123 is told because of others."""
    tracks = AirTracks()
    for each in (report("AAL123", -78.0, 90.0, 31_000.0), *others):
        tracks.take_report(each, 0)
    followed = LevelReadbacks(tracks, ConfidenceGuard())
    is_misread(followed, "climb", CLIMB, 0.0)
    return is_misread(followed, "readback", WRONG, 0.0)


@pytest.mark.parametrize(
    ("other_ft", "rate_fpm", "is_near"),
    [
        # Between 31,000 ft and 34,000 ft, or within 1,000 ft of either.
        (35_000.0, 0.0, False), (34_990.0, 0.0, True), (30_010.0, 0.0, True),
        (30_000.0, 0.0, False), (32_500.0, 0.0, True),
        (36_000.0, -1_100.0, True), (36_000.0, -900.0, False),  # Where it is after a minute.
        (29_000.0, 1_100.0, True), (34_000.0, 1_100.0, False),
    ],
)  # fmt: skip
def test_traffic_is_near_the_levels_that_a_climb_leads_through(
    other_ft: float, rate_fpm: float, is_near: bool
) -> None:
    other = report("DAL456", -76.0, 270.0, other_ft)
    assert is_told(other.model_copy(update={"vertical_rate_fpm": rate_fpm})) is is_near


@pytest.mark.parametrize(
    ("longitude_deg", "track_deg", "is_near"),
    [
        (-77.9, 90.0, True),  # As fast ahead, within 5 NM.
        (-77.85, 90.0, False),
        (-76.0, 270.0, True),
        (-74.65, 270.0, True),  # 290 km, less 5 NM, at 494 m/s: within ten minutes.
        (-74.35, 270.0, False),
        (-78.2, 270.0, False),  # They are past each other.
    ],
)
def test_traffic_comes_within_the_minimum_in_ten_minutes(
    longitude_deg: float, track_deg: float, is_near: bool
) -> None:
    assert is_told(report("DAL456", longitude_deg, track_deg, 34_000.0)) is is_near


def test_one_that_is_far_away_does_not_hide_another() -> None:
    far, near = report("UAL7", -60.0, 90.0, 34_000.0), report("DAL456", -76.0, 270.0, 34_000.0)
    assert is_told(far, near)
