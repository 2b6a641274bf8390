"""A station follows the messages of a run that goes on."""

from __future__ import annotations

import json
from typing import Any

import pytest

from airhilt.messages import (
    ActorTruth,
    AdsbReport,
    Briefing,
    Clock,
    Message,
    RadarInfo,
    RadarPlot,
    RosterEntry,
    SpokenTruth,
    TaskCard,
    Transcript,
    Transmission,
    VehiclePosition,
)
from airhilt.record import Logged
from airhilt.station.changes import Changes, Newest
from airhilt.station.live import LiveRun
from airhilt.station.seat_views import SeatViews
from seats import state_of

SECOND = 1_000_000_000
REPORT = AdsbReport(
    icao24="a1b2c3", callsign="AAL123", latitude_deg=38.85, longitude_deg=-77.04,
    altitude_ft=2_000.0, ground_speed_kt=140.0, track_deg=90.0, vertical_rate_fpm=0.0, nacp=9,
    nacv=2, receiver="tower", t_adsb_in_ns=SECOND, t_adsb_out_ns=SECOND, t_ns=SECOND,
)  # fmt: skip
TRUTH = ActorTruth(
    actor="AAL123", category="aircraft", phase="glide", on_ground=False, latitude_deg=38.85,
    longitude_deg=-77.04, altitude_m=700.0, height_agl_m=690.0, velocity_north_m_s=0.0,
    velocity_east_m_s=70.0, velocity_down_m_s=3.0, heading_deg=91.0, t_ns=2 * SECOND,
)  # fmt: skip


class Followed:
    """A run whose changes are looked at."""

    def __init__(self) -> None:
        self._changes = Changes()
        self.run = LiveRun(self._changes, SeatViews(), print)

    def hear(self, key: str, message: Message | bytes) -> None:
        if isinstance(message, bytes):
            self.run.take(Logged(key, "", 0, message))
        else:
            data = message.model_dump_json().encode()
            self.run.take(Logged(key, "", message.t_ns, data))

    def changes(self, kind: str) -> list[list[Any]]:
        batch = self._changes.since(0)
        found = [] if batch is None else json.loads(batch.changes)
        return [change[1:] for change in found if change[0] == kind]


def test_a_plot_of_a_radar_is_where_range_azimuth_and_altitude_put_it() -> None:
    followed = Followed()
    info = RadarInfo(
        site="ASR", kind="terminal", latitude_deg=38.85, longitude_deg=-77.04, altitude_m=0.0,
        rotation_s=4.8, primary_range_m=100_000.0, secondary_range_m=200_000.0, t_ns=0,
    )  # fmt: skip
    plot = RadarPlot(
        site="ASR", kind="secondary", t_plot_ns=2 * SECOND, range_m=5_000.0, azimuth_deg=90.0,
        mode_a="7000", mode_c_ft=9_843, t_ns=2 * SECOND,
    )  # fmt: skip
    for key, message in (("radar/ASR", plot), ("radar/ASR/info", info), ("adsb/a1b2c3", REPORT)):
        followed.hear(key, message)
    assert followed.changes("plot") == []  # Where the radar stands was not known yet.
    followed.hear("radar/ASR", plot)
    ((shown,),) = followed.changes("plot")
    assert shown["east"] == pytest.approx(4_000.0, abs=10.0)
    assert shown["north"] == pytest.approx(0.0, abs=10.0)
    assert (shown["t"], shown["code"], shown["turn_s"]) == (2.0, "7000", 4.8)


def test_without_the_truth_the_traffic_is_that_of_adsb() -> None:
    followed = Followed()
    entry = RosterEntry(callsign="AAL123", category="aircraft", type="B737")
    followed.hear(
        "briefing",
        Briefing(
            controller="TOWER",
            horizontal_separation_nm=3.0,
            vertical_separation_ft=1_000.0,
            roster=(entry,),
        ),
    )
    followed.hear("adsb/a1b2c3", REPORT)
    name, category, kind, t, *_, altitude_ft, velocity, _, _, _ = followed.changes("state")[0]
    assert (name, category, kind, t, altitude_ft) == ("AAL123", "aircraft", "B737", 1.0, 2_000)
    assert velocity == [72.0, 0.0, 0.0]


def test_an_actor_gets_its_callsign_once_adsb_tells_it() -> None:
    followed = Followed()
    for callsign in (None, "AAL123", "AAL123"):
        followed.hear("adsb/a1b2c3", REPORT.model_copy(update={"callsign": callsign}))
    assert [state[0] for state in followed.changes("state")] == ["a1b2c3", "AAL123", "AAL123"]
    assert followed.changes("name") == [["a1b2c3", "AAL123"]]


def test_where_the_truth_is_shared_it_takes_the_place_of_adsb() -> None:
    followed = Followed()
    followed.hear("truth/state/AAL123", TRUTH)
    followed.hear("adsb/a1b2c3", REPORT)
    assert [state[3] for state in followed.changes("state")] == [2.0]


def test_a_call_without_the_truth_is_what_was_recognised() -> None:
    followed = Followed()
    times = {"t_tx_ns": SECOND, "t_end_ns": 2 * SECOND}
    followed.hear("radio/119100/tx", Transmission(id="one", frequency_khz=119_100, **times))
    heard = Transcript(
        id="one", frequency_khz=119_100, text="hello", confidence=0.7, engine="ctc",
        addressee="AAL123", **times,
    )  # fmt: skip
    followed.hear("asr/119100", heard)
    assert followed.changes("call")[-1][0]["said"] is None
    said = SpokenTruth(
        id="one", speaker="AAL123", addressed=None, frequency_khz=119_100, text="Hello.", **times
    )
    followed.hear("truth/radio/one", said)
    row = followed.changes("call")[-1][0]
    assert (row["said"], row["transcripts"][0]["text"]) == ("Hello.", "hello")
    assert row["transcripts"][0]["addressee"] == "AAL123"


def test_of_the_transcripts_of_a_call_the_newest_are_shown() -> None:
    followed = Followed()
    call = {"id": "a", "frequency_khz": 119_100, "t_tx_ns": 0, "t_end_ns": SECOND}
    followed.hear("radio/119100/tx", Transmission(**call))
    for number in range(20):
        transcript = Transcript(text="w", confidence=1.0, engine=f"{number}", **call)
        followed.hear("asr/119100", transcript)
    shown = followed.changes("call")[-1][0]["transcripts"]
    assert [one["engine"] for one in shown] == [f"{number}" for number in range(12, 20)]


def test_garbage_changes_nothing() -> None:
    followed = Followed()
    for key in ("adsb/a1b2c3", "advisory/ATC", "vision/one", "truth/state/AAL123", "asr/119100"):
        for garbage in (b"", b"[]", b"{}", b"\xff\xfe", b'{"t_ns": "x"}', b"null"):
            followed.hear(key, garbage)
    assert followed.changes("state") == []


def test_a_time_that_no_run_reaches_is_left_out_and_told_in_words() -> None:
    told: list[str] = []
    run = LiveRun(Changes(), SeatViews(), told.append)
    data = REPORT.model_dump_json().replace(f'"t_adsb_in_ns":{SECOND}', f'"t_adsb_in_ns":{2**63}')
    run.take(Logged("adsb/a1b2c3", "", SECOND, data.encode()))
    assert told == [
        "adsb/a1b2c3: left out, for it cannot be read: t_adsb_in_ns: Input should be less than or "
        "equal to 9223372036854775807"
    ]


def test_the_end_of_a_run_is_known_and_told_even_if_it_vanishes() -> None:
    vanished = Followed()
    vanished.run.lost()
    assert vanished.changes("clock") == [[None, "gone", ""]]
    followed = Followed()
    assert not followed.run.is_over
    followed.hear("clock", Clock(run="one", phase="finished", pace="virtual", t_ns=SECOND))
    assert followed.run.is_over
    followed.run.lost()
    assert followed.changes("clock") == [[1.0, "finished", "virtual", 0.0]]


def test_of_what_a_seat_is_told_the_newest_of_each_kind_is_kept_in_its_order() -> None:
    own = Newest()
    own.put("seat", {"seat": "OPS1"})
    own.put("state", "OPS1", 1.0)
    own.put("state", "OPS1", 2.0)
    first = own.since(0)
    assert first is not None
    assert json.loads(first.changes) == [["seat", {"seat": "OPS1"}], ["state", "OPS1", 2.0]]
    assert own.since(first.next_number) is None
    own.put("state", "OPS1", 3.0)
    second = own.since(first.next_number)
    assert second is not None
    assert json.loads(second.changes) == [["state", "OPS1", 3.0]]


def test_only_the_driver_learns_where_the_own_vehicle_is_from_its_map() -> None:
    changes, views = Changes(), SeatViews(["OPS1"])
    run, own = LiveRun(changes, views, print), views.own["OPS1"]
    shown = VehiclePosition(
        callsign="OPS1", latitude_deg=38.85, longitude_deg=-77.04, heading_deg=90.0,
        ground_speed_kt=10.0, t_ns=SECOND,
    )  # fmt: skip
    run.take(Logged("cockpit/OPS1/position", "", SECOND, shown.model_dump_json().encode()))
    assert changes.since(0) is None
    batch = own.since(0)
    assert batch is not None
    assert json.loads(batch.changes)[0][:3] == ["state", "OPS1", "vehicle"]


def test_the_state_of_a_seat_and_its_instruments_are_for_the_person_there_alone() -> None:
    changes, views = Changes(), SeatViews(["TOWER", "AAL123"])
    run, own, other = LiveRun(changes, views, print), views.own["TOWER"], views.own["AAL123"]
    card = TaskCard(line="one", due_ns=0, addressed=None, frequency_khz=119_100, text="Hello.")
    state = state_of("TOWER", tasks=(card,), holder="somebody")
    run.take(Logged("seat/TOWER", "", 0, state.model_dump_json().encode()))
    assert changes.since(0) is None
    assert other.since(0) is None
    batch = own.since(0)
    assert batch is not None
    shown = json.loads(batch.changes)[0][1]
    assert shown["tasks"] == [{"line": "one", "t": 0.0, "text": "Hello.", "addressed": None}]
    assert "holder" not in shown
