"""The reference engine warns of what will happen, once, and of nothing else."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from airhilt.assistant.decision.loss_prediction import SeparationConfig
from airhilt.messages import AdsbReport, Advisory, Climb, MaintainLevel, Severity, Turn
from airhilt.surveillance.receivers import Receiver
from breadth import mostly_slow
from decisions import reference
from encounters import Encounter, Flight, head_on

CREWS = ("AAL123", "DAL456")


@pytest.fixture(scope="module")
def ignored() -> Encounter:
    """Two fly at each other, and nobody does anything about it."""
    return head_on(300.0).fly()


def rises(encounter: Encounter, recipient: str) -> list[str]:
    """Return the severities that somebody was told, each once, in their order."""
    return list(dict.fromkeys(encounter.severities(recipient)))


def test_head_on_the_advisory_rises_to_caution_and_warning(ignored: Encounter) -> None:
    assert rises(ignored, "ATC") == ["ADVISORY", "CAUTION", "WARNING"]
    for crew in CREWS:
        assert rises(ignored, crew) == ["CAUTION", "WARNING"]


def test_crews_that_do_nothing_are_told_again_until_the_two_have_met(ignored: Encounter) -> None:
    warned_s = [t for t, a in ignored.told if a.recipient == "AAL123" and a.severity == "WARNING"]
    assert np.diff(warned_s).max() == pytest.approx(17.0, abs=1.0)
    assert 230.25 - 18.0 < warned_s[-1] < 231.0


def test_each_severity_comes_when_that_much_time_is_left(ignored: Encounter) -> None:
    """5 NM apart at 960 kt of closure is 18.75 s before the two meet at 230.25 s."""
    loss_s = 230.25 - 18.75
    told = reversed([(t, a) for t, a in ignored.told if a.active and a.recipient == "ATC"])
    times = {str(a.severity): t for t, a in told}
    for severity, left_s in (("ADVISORY", 180.0), ("CAUTION", 120.0), ("WARNING", 60.0)):
        assert times[severity] == pytest.approx(loss_s - left_s, abs=6.0)


def test_one_conflict_is_one_advisory_with_rising_revisions(ignored: Encounter) -> None:
    assert len({advisory.id for _, advisory in ignored.told}) == 1
    revisions = [advisory.revision for advisory in ignored.to("ATC")]
    assert revisions == list(range(len(revisions)))
    for advisory in ignored.to("ATC"):
        assert sorted(advisory.traffic) == list(CREWS)
        assert advisory.kind == "loss_of_separation"


def test_it_ends_with_an_inactive_info_once_the_two_are_past(ignored: Encounter) -> None:
    for recipient in ("ATC", *CREWS):
        *before, last = ignored.to(recipient)
        assert all(advisory.active for advisory in before)
        assert (last.active, last.severity, last.recommendation) == (False, Severity.INFO, None)
    past_s = 230.25 + 18.75
    assert ignored.told[-1][0] == pytest.approx(past_s + 8.0, abs=3.0)


def test_a_conflict_of_which_nothing_more_is_heard_is_carried_on_to_its_end() -> None:
    encounter = replace(head_on(300.0), silent_after_s=160.0).fly()
    assert rises(encounter, "ATC") == ["ADVISORY", "CAUTION", "WARNING"]
    assert not encounter.to("ATC")[-1].active
    assert encounter.told[-1][0] == pytest.approx(230.0 + 18.75 + 8.0, abs=5.0)


def senses(advisories: list[Advisory]) -> dict[str, str]:
    return {
        advisory.recipient: advisory.recommendation.sense
        for advisory in advisories
        if isinstance(advisory.recommendation, Climb)
    }


def test_of_two_at_one_level_one_climbs_and_the_other_descends(ignored: Encounter) -> None:
    for severity in (Severity.CAUTION, Severity.WARNING):
        told = [a for _, a in ignored.told if a.active and a.severity is severity]
        assert sorted(senses(told).values()) == ["climb", "descend"]


def test_the_sense_does_not_turn_round_when_the_severity_rises(ignored: Encounter) -> None:
    for crew in CREWS:
        assert len({a.recommendation.sense for a in ignored.to(crew) if a.active}) == 1


def test_an_advisory_says_why(ignored: Encounter) -> None:
    for t_s, advisory in ignored.told:
        if advisory.active:
            left_s = max(211.5 - t_s, 0.0)
            assert advisory.evidence.sources == ("adsb",)
            assert advisory.evidence.time_to_loss_s == pytest.approx(left_s, abs=6.0)
            assert advisory.evidence.horizontal_at_closest_approach_m < 2_000.0
            assert advisory.t_ready_ns == t_s * 1e9


@pytest.mark.parametrize("seed", mostly_slow(range(3), 0))
def test_crews_that_follow_keep_their_separation_and_are_told_once(seed: int) -> None:
    encounter = head_on(330.0, seed)
    encounter.obey = lambda advisory: advisory.severity.rank >= Severity.CAUTION.rank
    encounter.fly()
    assert encounter.least[CREWS] > 0.9
    for crew in CREWS:
        assert encounter.severities(crew) == ["CAUTION"]
        assert [advisory.active for advisory in encounter.to(crew)] == [True, False]


@pytest.mark.parametrize("seed", mostly_slow(range(3), 0))
@pytest.mark.parametrize(
    "second",
    [
        {"altitude_ft": 36_000.0},
        {"altitude_ft": 34_000.0},
        {"altitude_ft": 36_000.0, "track_deg": 0.0},
        {"offset_nm": 8.0},
        {"offset_nm": -8.0},
        {"track_deg": 90.0, "distance_nm": 38.7},
        {"track_deg": 0.0, "distance_nm": 43.0},
    ],
    ids=lambda second: ", ".join(f"{key} {value:g}" for key, value in second.items()),
)
def test_nobody_is_warned_of_traffic_1000_ft_or_8_nm_away(
    second: dict[str, float], seed: int
) -> None:
    encounter = head_on(300.0, seed, **second).fly()
    assert min(encounter.least.values()) > 0.95
    assert encounter.told == []


@pytest.mark.parametrize(("reports", "told"), [(1, False), (8, True)])
def test_one_report_that_is_out_of_line_is_not_a_conflict_and_some_in_a_row_are(
    reports: int, told: bool
) -> None:
    encounter = head_on(80.0, altitude_ft=36_000.0)
    hear = encounter._reports

    def corrupted(station: Receiver, t_ns: int, step: int) -> list[Any]:
        inputs = hear(station, t_ns, step)
        if 120 <= step < 120 + reports:
            report = AdsbReport.model_validate_json(inputs[-1].payload)
            wrong = report.model_copy(update={"altitude_ft": 35_300.0})
            inputs[-1] = replace(inputs[-1], payload=wrong.model_dump_json().encode())
        return inputs

    encounter._reports = corrupted
    assert bool(encounter.fly().told) == told


def test_without_traffic_there_is_nothing_to_say() -> None:
    encounter = Encounter([Flight("AAL123", "a1b2c3", 90.0, 30.0, 35_000)], 30.0)
    assert encounter.fly().told == []


CLEARED = "American one two three, climb and maintain flight level three three zero."
READ_BACK = "Climb and maintain flight level {}, American one two three."


def climbing(
    level_ft: int, read_back: str, seconds: float = 300.0, traffic: bool = True, seed: int = 1
) -> Encounter:
    """AAL123 is cleared from FL310 to FL330, and traffic comes the other way above at FL340."""
    flights = [Flight("AAL123", "a1b2c3", 90.0, 30.7, 31_000, rate_fpm=1500.0, seed=seed)]
    if traffic:
        flights.append(Flight("DAL456", "a4d5e6", 270.0, 30.7, 34_000, seed=seed))
    calls = [(20.0, 25.0, CLEARED), (26.0, 31.0, READ_BACK.format(read_back))]
    encounter = Encounter(flights, seconds, calls=calls)
    climb_at_s = 140.0
    plan = flights[0].advance

    def advance(step_s: float, clock: list[float] = [0.0]) -> None:  # noqa: B006
        clock[0] += step_s
        if clock[0] == climb_at_s:
            flights[0].climb(level_ft, 1500.0)
        plan(step_s)

    flights[0].advance = advance
    return encounter


@pytest.mark.parametrize("seed", mostly_slow(range(3), 0))
def test_a_climb_to_a_cleared_level_1000_ft_below_traffic_is_quiet(seed: int) -> None:
    encounter = climbing(33_000, "three three zero", seed=seed).fly()
    assert encounter.least[CREWS] == pytest.approx(1.0, abs=0.1)
    assert encounter.told == []


def test_the_same_climb_without_a_word_on_the_radio_is_not() -> None:
    encounter = climbing(33_000, "three three zero")
    encounter.calls = []
    assert "CAUTION" in encounter.fly().severities("ATC")


def test_a_readback_mismatch_with_traffic_there_is_a_caution_to_crew_and_controller() -> None:
    encounter = climbing(31_000, "three four zero", seconds=40.0).fly()
    told = [advisory for t_s, advisory in encounter.told if t_s == 31.0]
    assert {advisory.recipient for advisory in told} == {"AAL123", "ATC"}
    for advisory in told:
        assert (advisory.kind, advisory.severity) == ("readback_mismatch", "CAUTION")
        assert advisory.traffic == CREWS
        assert advisory.evidence.sources == ("radio", "adsb")
        assert len(advisory.evidence.radio_ids) == len(advisory.evidence.tracks) == 2
        for words in ("34000", "33000", "DAL456"):
            assert words in advisory.message
    assert {a.recommendation for a in told if a.recipient == "AAL123"} == {
        MaintainLevel(altitude_ft=33_000)
    }
    assert len(encounter.told) == 2


def test_a_readback_mismatch_without_traffic_is_nothing() -> None:
    assert climbing(31_000, "three four zero", seconds=60.0, traffic=False).fly().told == []


def test_a_readback_that_is_right_is_nothing() -> None:
    assert climbing(31_000, "three three zero", seconds=60.0).fly().told == []


def with_third(altitude_ft: int) -> Encounter:
    """Two head-on, and a third abreast of the first at another level."""
    encounter = head_on(330.0)
    encounter.flights.append(Flight("UAL7", "a00007", 90.0, 30.7, altitude_ft, offset_nm=1.0))
    encounter.obey = lambda advisory: advisory.severity.rank >= Severity.CAUTION.rank
    return encounter.fly()


@pytest.mark.parametrize("altitude_ft", [36_000, 34_000])
def test_nobody_is_sent_into_a_third_aircraft(altitude_ft: int) -> None:
    encounter = with_third(altitude_ft)
    assert min(encounter.least.values()) > 0.85
    assert {advisory.id for _, advisory in encounter.told} == {"decision-separation-1"}
    first = [a for _, a in encounter.told if a.active and a.severity is Severity.CAUTION]
    moves = senses(first)
    assert moves.get("AAL123") != ("climb" if altitude_ft > 35_000 else "descend")
    assert moves or any(isinstance(a.recommendation, Turn) for a in first)


def test_the_engine_declares_what_it_listens_to_and_never_truth() -> None:
    description = reference().description
    heard = {wanted.key for wanted in description.inputs}
    assert heard == {
        "briefing", "adsb/*", "asr/*", "asr/*/partial", "vision/*", "radio/*/audio",
        "camera/*/info",
    }  # fmt: skip
    assert description.modality == "decision"


def test_a_spike_is_told_at_the_level_that_has_held(monkeypatch: pytest.MonkeyPatch) -> None:
    """A glimpse of a WARNING in the second in which an ADVISORY becomes certain is not one yet."""
    encounter = head_on(300.0)
    levels = iter([Severity.ADVISORY, Severity.ADVISORY, Severity.WARNING, Severity.WARNING])
    monkeypatch.setattr(
        SeparationConfig, "severity_of", lambda config, loss_s: next(levels, Severity.ADVISORY)
    )
    encounter.fly()
    assert encounter.severities("ATC") == ["ADVISORY"]
