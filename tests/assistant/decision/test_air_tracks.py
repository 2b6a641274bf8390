"""The tracks of who flies, and the pairs of them that are looked at together."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt.assistant.decision.air_tracks import AirTracks, Pair, Reach
from airhilt.assistant.decision.tracks import Track
from airhilt.geodesy.wgs84 import displaced
from airhilt.messages import AdsbReport
from airhilt.units import DEGREE, FOOT, FOOT_PER_MINUTE, KNOT, SECOND_NS

REACH = Reach(10_000.0, 300.0, 100.0)
"""Far enough in all, and a time in which 50 m/s to the north are 5 km, and 10 m/s up are 1 km."""


def report(
    icao24: str, north_m: float = 0.0, altitude_m: float | None = 3000.0, *,
    north_m_s: float = 0.0, up_m_s: float = 0.0, t_s: float = 0.0,
) -> AdsbReport:  # fmt: skip
    latitude, longitude = displaced((50.0 * DEGREE, 8.0 * DEGREE), north_m, 0.0)
    t_ns = round(t_s * SECOND_NS)
    return AdsbReport(
        icao24=icao24, callsign=icao24.upper(), t_adsb_in_ns=t_ns, t_adsb_out_ns=t_ns,
        latitude_deg=latitude / DEGREE, longitude_deg=longitude / DEGREE,
        altitude_ft=None if altitude_m is None else altitude_m / FOOT,
        on_ground=altitude_m is None, ground_speed_kt=abs(north_m_s) / KNOT,
        track_deg=0.0 if north_m_s >= 0.0 else 180.0, vertical_rate_fpm=up_m_s / FOOT_PER_MINUTE,
        nacp=9, nacv=2, receiver="field",
    )  # fmt: skip


def track_of(tracks: AirTracks, icao24: str) -> Track:
    return next(track for track in tracks if track.icao24 == icao24)


def tracks_of(reports: Sequence[AdsbReport]) -> AirTracks:
    tracks = AirTracks()
    for each in reports:
        tracks.take_report(each, each.t_adsb_out_ns)
    return tracks


def news(tracks: AirTracks, *wanted: Pair, t_ns: int = 0) -> list[Pair]:
    return tracks.pairs_with_news(t_ns, REACH, 15.0, wanted)


@pytest.mark.parametrize(
    ("other", "is_looked_at"),
    [
        (report("00000b"), True),
        (report("00000b", altitude_m=3299.0), True),
        (report("00000b", altitude_m=3301.0), False),
        (report("00000b", altitude_m=2699.0), False),
        (report("00000b", altitude_m=4299.0, up_m_s=-10.0), True),
        (report("00000b", altitude_m=4301.0, up_m_s=-10.0), False),
        (report("00000b", altitude_m=1701.0, up_m_s=10.0), True),
        (report("00000b", north_m=9_900.0), True),
        (report("00000b", north_m=10_200.0), False),
        (report("00000b", north_m=-10_200.0), False),
        (report("00000b", north_m=14_900.0, north_m_s=-50.0), True),
        (report("00000b", north_m=-14_900.0, north_m_s=50.0), True),
        (report("00000b", north_m=15_200.0, north_m_s=-50.0), False),
    ],
)
def test_two_are_looked_at_together_if_they_could_meet_in_level_and_latitude(
    other: AdsbReport, is_looked_at: bool
) -> None:
    for reports in ((report("00000a"), other), (other, report("00000a"))):
        tracks = tracks_of(reports)
        assert news(tracks) == ([("00000a", "00000b")] if is_looked_at else [])
        assert news(tracks, ("00000a", "00000b")) == [("00000a", "00000b")]


@given(
    st.lists(
        st.tuples(st.floats(-30_000.0, 30_000.0), st.floats(2000.0, 4000.0),
                  st.floats(-60.0, 60.0), st.floats(-12.0, 12.0)),
        min_size=2, max_size=6,
    )
)  # fmt: skip
def test_no_pair_that_meets_within_the_time_is_left_out(
    flights: list[tuple[float, float, float, float]],
) -> None:
    tracks = tracks_of(
        [
            report(f"00000{number}", north_m, altitude_m, north_m_s=north_m_s, up_m_s=up_m_s)
            for number, (north_m, altitude_m, north_m_s, up_m_s) in enumerate(flights)
        ]
    )
    together = news(tracks)
    assert len(together) == len(set(together))
    for (first, one), (second, other) in itertools.combinations(enumerate(flights), 2):
        for step in range(11):
            t_s = REACH.time_s * step / 10.0
            apart_m = abs(one[0] + one[2] * t_s - other[0] - other[2] * t_s)
            pair = (f"00000{first}", f"00000{second}")
            below_m, above_m = (track_of(tracks, icao24).profile().at(t_s) for icao24 in pair)
            is_level = abs(below_m - above_m) < REACH.vertical_m - 1.0
            if apart_m < 0.99 * REACH.horizontal_m and is_level:
                assert pair in together


def test_only_pairs_with_news_are_looked_at() -> None:
    tracks = tracks_of([report("00000a"), report("00000b"), report("00000c")])
    tracks.end_step()
    assert news(tracks, ("00000a", "00000b")) == []
    tracks.take_report(report("00000b", t_s=1.0), SECOND_NS)
    assert set(news(tracks)) == {("00000a", "00000b"), ("00000b", "00000c")}


def test_who_is_silent_is_dropped_but_as_one_of_a_pair_that_is_kept() -> None:
    tracks = tracks_of(
        [report("00000a"), report("00000b"), report("00000c"), report("00000d", t_s=5.0)]
    )
    news(tracks, t_ns=15 * SECOND_NS)
    assert [track.icao24 for track in tracks] == ["00000a", "00000b", "00000c", "00000d"]
    news(tracks, ("00000a", "00000b"), t_ns=15 * SECOND_NS + 1)
    assert [track.icao24 for track in tracks] == ["00000a", "00000b", "00000d"]
    news(tracks, t_ns=20 * SECOND_NS)
    assert [track.icao24 for track in tracks] == ["00000d"]


def test_a_pair_has_been_silent_since_the_last_report_of_either() -> None:
    tracks = tracks_of([report("00000a"), report("00000b", t_s=3.0)])
    pair = ("00000a", "00000b")
    assert tracks.silent([pair], 10 * SECOND_NS, 7 * SECOND_NS) == [pair]
    assert tracks.silent([pair], 10 * SECOND_NS, 7 * SECOND_NS + 1) == []


def test_a_track_is_carried_on_to_the_present() -> None:
    tracks = tracks_of([report("00000a", north_m_s=100.0, up_m_s=5.0)])
    later = tracks.present("00000a", 10 * SECOND_NS)
    assert later.altitude_m == pytest.approx(3050.0)
    assert later.latitude_rad > track_of(tracks, "00000a").latitude_rad
    assert tracks.by_callsign("00000A") is track_of(tracks, "00000a")
    assert tracks.addresses("00000A", "NOBODY") == ("00000a",)
