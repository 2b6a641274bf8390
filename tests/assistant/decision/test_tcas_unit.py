"""TCAS II of one aircraft by itself: its tracks, its cycles, and what it says of one intruder."""

from __future__ import annotations

import math
from typing import Any

import pytest

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.tcas_tracks import IntruderTrack, IntruderTracks
from airhilt.assistant.decision.tcas_unit import Senses, TcasUnit
from airhilt.messages import Climb, CockpitInstruments, MaintainLevel, Severity, TcasReply
from airhilt.units import FOOT_PER_MINUTE, SECOND_NS

OWN, OTHER = "aaaaa1", "aaaaa2"


def reply(t_s: float, range_m: float, altitude_ft: int = 10_000, **given: Any) -> TcasReply:
    usual = {
        "t_ns": round(t_s * SECOND_NS), "callsign": "AAL1", "own_icao24": OWN, "mode": "S",
        "icao24": OTHER, "range_m": range_m, "bearing_deg": 0.0, "altitude_ft": altitude_ft,
        "has_tcas": False,
    }  # fmt: skip
    return TcasReply.model_validate(usual | given)


def instruments(
    t_s: float, altitude_ft: int = 10_000, rate_fpm: int = 0, **given: Any
) -> CockpitInstruments:
    usual = {
        "t_ns": round(t_s * SECOND_NS), "callsign": "AAL1", "airspeed_kt": 250.0, "mach": 0.5,
        "altitude_ft": altitude_ft, "vertical_speed_fpm": rate_fpm, "north": "true",
        "heading_deg": 0.0, "track_deg": 0.0, "ground_speed_kt": 250.0, "pitch_deg": 0.0,
        "roll_deg": 0.0, "gear": 0.0, "flaps": 0.0, "on_ground": False, "mode": "en_route",
        "selected_altitude_ft": altitude_ft, "selected_airspeed_kt": 250,
    }  # fmt: skip
    return CockpitInstruments.model_validate(usual | given)


# --- tracks -------------------------------------------------------------------------------------


def track_of(*replies: TcasReply) -> IntruderTrack:
    track = IntruderTrack.of(replies[0])
    for each in replies[1:]:
        track.update(each)
    return track


@pytest.mark.parametrize(
    ("replies", "range_m", "altitude_ft", "fits"),
    [
        (1, 9000.0 + 819.0, 10_000, True),  # 200 m, and 620 m/s for a second.
        (1, 9000.0 + 821.0, 10_000, False),
        (1, 9000.0 - 819.0, 10_000, True),
        (1, 9000.0 - 821.0, 10_000, False),
        (1, 9000.0, 10_366, True),  # 200 ft, and 10,000 ft/min for a second.
        (1, 9000.0, 10_367, False),
        (2, 9199.0, 10_000, True),
        (2, 9201.0, 10_000, False),
        (2, 9000.0, 9_801, True),
        (2, 9000.0, 9_799, False),
    ],
)
def test_a_reply_belongs_to_a_track_within_its_gates(
    replies: int, range_m: float, altitude_ft: int, fits: bool
) -> None:
    track = track_of(*(reply(float(t), 9000.0) for t in range(replies)))
    misfit = track.misfit(reply(float(replies), range_m, altitude_ft))
    assert (misfit is not None) is fits


@pytest.mark.parametrize(("silent_s", "is_lost"), [(6.0, False), (6.1, True)])
def test_a_track_is_dropped_after_6_s_without_a_reply(silent_s: float, is_lost: bool) -> None:
    tracks = IntruderTracks()
    tracks.take_reply(reply(0.0, 9000.0))
    assert bool(tracks.forget(round(silent_s * SECOND_NS))) is is_lost
    assert bool(list(tracks)) is not is_lost


# --- its cycles ---------------------------------------------------------------------------------


class Flight:
    """One aircraft with TCAS, and an intruder whose replies come once a second."""

    def __init__(
        self, *, altitude_ft: int = 10_000, rate_fpm: int = 0, filters_misses: bool = False,
        senses: Senses | None = None, **own: Any,
    ) -> None:  # fmt: skip
        self.senses = {} if senses is None else senses
        self.unit = TcasUnit("AAL1", OWN, self.senses, filters_misses=filters_misses)
        self._own = {"altitude_ft": altitude_ft, "rate_fpm": rate_fpm, **own}
        self.told: list[tuple[float, Alert]] = []

    def hears(
        self, t_s: float, range_m: float | None, altitude_ft: int = 10_000, **given: Any
    ) -> None:
        own = dict(self._own)
        own["altitude_ft"] = round(own["altitude_ft"] + own["rate_fpm"] / 60.0 * t_s)
        self.unit.take_instruments(instruments(t_s, **own))
        if range_m is not None:
            self.unit.take_reply(reply(t_s, range_m, altitude_ft, **given))
        self.told += [(t_s, alert) for alert in self.unit.judge(round(t_s * SECOND_NS))]

    def notes(self) -> list[str]:
        return [alert.evidence.note for _, alert in self.told]


def meets(
    flight: Flight, *, closing_m_s: float = 200.0, until_s: float = 30.0, from_m: float = 9000.0,
    altitude_ft: int = 10_000, **given: Any,
) -> Flight:  # fmt: skip
    for t in range(round(until_s) + 1):
        flight.hears(float(t), from_m - closing_m_s * t, altitude_ft, **given)
    return flight


def test_without_replies_the_next_cycle_comes_after_a_second_and_a_half() -> None:
    flight = Flight()
    flight.hears(0.0, 90_000.0)
    assert flight.unit.due_ns == 1.5 * SECOND_NS
    flight.hears(1.4, None)
    assert flight.unit.due_ns == 1.5 * SECOND_NS
    flight.hears(1.5, None)
    assert flight.unit.due_ns == 3.0 * SECOND_NS
    flight.hears(2.0, 90_000.0)
    assert flight.unit.due_ns == 3.5 * SECOND_NS


@pytest.mark.parametrize(("rate_fpm", "is_told"), [(0, False), (6000, True), (-6000, False)])
def test_the_own_altitude_is_carried_on_by_its_rate(rate_fpm: int, is_told: bool) -> None:
    """From 3,000 ft below; after 25 s it is at the level of the intruder, or twice as far."""
    unit = TcasUnit("AAL1", OWN, {}, filters_misses=False)
    unit.take_instruments(instruments(0.0, 7_000, rate_fpm))
    told: list[Alert] = []
    for t in range(26):
        unit.take_reply(reply(float(t), 5500.0 - 200.0 * t))
        told += unit.judge(t * SECOND_NS)
    assert bool(told) is is_told


def test_head_on_there_is_traffic_and_then_a_resolution() -> None:
    """Level 6 from 10,000 ft on: 45 s, which 1 NM widens to 9,366 m, and 30 s, to 6,346 m with
    0.8 NM, at 200 m/s. There is a cycle a second."""
    flight = meets(Flight(), from_m=12_000.0, until_s=31.0)
    (traffic_s, traffic), (resolution_s, resolution) = flight.told[:2]
    assert (traffic.severity, resolution.severity) == (Severity.CAUTION, Severity.WARNING)
    assert traffic.evidence.note == "traffic, traffic"
    assert traffic.evidence.rules == ("traffic_advisory",)
    assert resolution.evidence.rules == ("resolution_advisory",)
    assert traffic.recipients == resolution.recipients == ("AAL1",)
    assert traffic.traffic == ("AAL1", OTHER)
    assert (traffic.id, traffic.revision, resolution.revision) == ("AAL1-1", 0, 1)
    assert traffic.evidence.tracks == (OTHER,)
    assert (traffic_s, resolution_s) == (14.0, 29.0)
    for t_s, alert in flight.told[:2]:
        left_s = 60.0 - t_s
        assert alert.evidence.time_to_closest_approach_s == pytest.approx(left_s, abs=0.1)
        assert alert.evidence.vertical_at_closest_approach_m == pytest.approx(0.0, abs=0.1)


def test_who_has_never_been_close_is_none() -> None:
    """One that draws away from within the limits."""
    flight = meets(Flight(), closing_m_s=-5.0, from_m=900.0)
    assert flight.told == []


def recommended(flight: Flight) -> list[Any]:
    return [alert.recommendations["AAL1"] for _, alert in flight.told if alert.recommendations]


def test_a_climb_is_advised_at_1500_ft_min_to_where_two_minutes_lead() -> None:
    flight = meets(Flight(altitude_ft=10_060), until_s=25.0)
    assert flight.notes()[1] == "climb, climb"
    first = recommended(flight)[0]
    assert first == Climb(sense="climb", altitude_ft=13_100.0, vertical_rate_fpm=1500)


def test_a_descent_is_advised_no_lower_than_1000_ft_above_the_ground() -> None:
    flight = meets(
        Flight(altitude_ft=2000, radio_height_ft=1800), altitude_ft=2100, until_s=32.0,
        closing_m_s=100.0, from_m=4000.0,
    )  # fmt: skip
    first = recommended(flight)[0]
    assert (first.sense, first.vertical_rate_fpm) == ("descend", 1500)
    assert first.altitude_ft == 1200.0  # 1,000 ft above ground at 200 ft.


def test_who_does_not_follow_is_told_to_increase_5_s_later() -> None:
    flight = meets(Flight(altitude_ft=10_050), until_s=40.0)
    times = {alert.evidence.note: t_s for t_s, alert in flight.told}
    assert times["increase climb, increase climb"] - times["climb, climb"] >= 5.0
    assert recommended(flight)[1].vertical_rate_fpm == 2500
    assert not [note for note in flight.notes() if note == "descend, descend"]


@pytest.mark.parametrize(("rate_fpm", "note"), [(-250, "monitor vertical speed"),
                                                (-1000, "level off, level off"),
                                                (-3000, "level off, level off")])  # fmt: skip
def test_who_need_only_not_descend_is_told_to_level_off_or_to_stay(
    rate_fpm: int, note: str
) -> None:
    """600 ft above is enough at level 5: 350 ft at the closest approach."""
    above_ft = 10_550 - round(rate_fpm / 60.0 * 21.0)
    flight = meets(Flight(altitude_ft=above_ft, rate_fpm=rate_fpm), until_s=24.0)
    assert note in flight.notes()
    t_s, _ = next(each for each in flight.told if each[1].evidence.note == note)
    stopping_s = 5.0 + 0.5 * abs(rate_fpm) * FOOT_PER_MINUTE / (0.25 * 9.80665)
    lost_ft = abs(rate_fpm) / 60.0 * stopping_s if note.startswith("level") else 0.0
    now_ft = above_ft + rate_fpm / 60.0 * t_s
    level = recommended(flight)[0]
    assert isinstance(level, MaintainLevel)
    assert level.altitude_ft == 100.0 * round((now_ft - lost_ft) / 100.0)


@pytest.mark.parametrize(("away_m_s", "is_increased"), [(-0.5, True), (0.5, False)])
def test_nothing_is_increased_against_who_draws_away_however_slowly(
    away_m_s: float, is_increased: bool
) -> None:
    """Two that fly abreast at one altitude, a few metres apart, of which one does not follow."""
    flight = Flight()
    for t in range(12):
        flight.hears(float(t), 12.0 - 0.5 * min(t, 5) + away_m_s * max(t - 5, 0))
    assert "climb, climb" in flight.notes()
    assert ("increase climb, increase climb" in flight.notes()) is is_increased


# --- its end ------------------------------------------------------------------------------------


def passed(flight: Flight, altitude_ft: int) -> list[tuple[float, Alert]]:
    """Let an intruder pass 800 m aside at 40 s."""
    for t in range(70):
        flight.hears(float(t), math.hypot(800.0, 200.0 * (t - 40.0)), altitude_ft)
    return flight.told


def ended_s(told: list[tuple[float, Alert]]) -> float:
    ((t_s, alert),) = (each for each in told if not each[1].active)
    assert alert.severity is Severity.INFO
    assert alert.evidence.note == "clear of conflict"
    assert alert.recommendations == {}
    return t_s


def test_a_traffic_advisory_lasts_8_s_after_the_last_that_was_wrong() -> None:
    told = passed(Flight(), 10_800)
    assert {alert.severity for _, alert in told} == {Severity.CAUTION, Severity.INFO}
    # The tracker takes a second or two to see that it draws away.
    assert 48.0 <= ended_s(told) <= 51.0


def test_a_resolution_advisory_lasts_3_s_after_it() -> None:
    told = passed(Flight(), 10_000)
    assert {alert.severity for _, alert in told} >= {Severity.WARNING, Severity.INFO}
    assert 43.0 <= ended_s(told) <= 46.0


def test_who_has_not_gone_since_the_end_is_not_announced_again_but_is_resolved_again() -> None:
    """It slows down until it closes within 45 s, and not within 30 s: traffic, but no threat."""
    flight, range_m = Flight(), 9000.0
    for t in range(60):
        flight.hears(float(t), range_m)
        range_m -= 200.0 if t < 25 else 60.0
    assert [(alert.id, alert.evidence.note) for _, alert in flight.told] == [
        ("AAL1-1", "traffic, traffic"),
        ("AAL1-1", "climb, climb"),
        ("AAL1-1", "clear of conflict"),
        ("AAL1-2", "climb, climb"),
    ]


def test_who_comes_back_after_all_was_well_is_announced_again() -> None:
    flight = Flight()
    for t in range(240):
        flight.hears(float(t), 7000.0 + 6500.0 * math.cos(math.tau * t / 160.0))
    traffic = [alert.id for _, alert in flight.told if alert.evidence.note == "traffic, traffic"]
    assert traffic == ["AAL1-1", "AAL1-2"]


# --- with others --------------------------------------------------------------------------------


@pytest.mark.parametrize(("has_tcas", "told"), [(True, "climb"), (False, None)])
def test_who_has_tcas_is_told_the_own_sense(has_tcas: bool, told: str | None) -> None:
    flight = meets(Flight(altitude_ft=10_050), until_s=25.0, has_tcas=has_tcas)
    assert flight.notes()[1] == "climb, climb"
    assert flight.senses.get((OWN, OTHER)) == told


def test_who_was_told_a_sense_takes_the_other_one() -> None:
    senses: Senses = {(OTHER, OWN): "climb"}
    flight = meets(Flight(altitude_ft=10_050, senses=senses), until_s=25.0)
    assert flight.notes()[1] == "descend, descend"


def test_a_mode_c_intruder_has_no_name() -> None:
    flight = meets(Flight(), until_s=25.0, mode="C", icao24=None)
    assert {alert.traffic for _, alert in flight.told} == {("AAL1",)}
    assert {alert.evidence.tracks for _, alert in flight.told} == {()}


@pytest.mark.parametrize(("miss_m", "severity"), [(400.0, Severity.WARNING),
                                                  (3000.0, Severity.CAUTION)])  # fmt: skip
def test_the_filter_keeps_a_resolution_back_from_who_passes_beyond_dmod(
    miss_m: float, severity: Severity
) -> None:
    flight = Flight(filters_misses=True)
    for t in range(32):
        flight.hears(float(t), math.hypot(miss_m, 9000.0 - 200.0 * t))
    assert max((alert.severity for _, alert in flight.told), key=lambda each: each.rank) is severity


@pytest.mark.parametrize(("above_ft", "severity"), [(0, Severity.CAUTION),
                                                    (550, Severity.WARNING)])  # fmt: skip
def test_the_filter_judges_the_miss_distance_in_the_plane(
    above_ft: int, severity: Severity
) -> None:
    """The range to somebody higher is a little less in the plane: of 1,491 m, beyond the 0.8 NM of
    level 6, 168 m of height leave 1,481 m."""
    flight = Flight(filters_misses=True)
    for t in range(32):
        flight.hears(float(t), math.hypot(2710.0, 9000.0 - 200.0 * t), 10_000 + above_ft)
    assert max((alert.severity for _, alert in flight.told), key=lambda each: each.rank) is severity
