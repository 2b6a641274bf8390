"""Seats of people: what they say is said, understood and done, and repeats in a replay."""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from itertools import count
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from airhilt.assistant.tts.worker import TtsWorker
from airhilt.cosim.recorded import UnregisteredMessage
from airhilt.cosim.replay import replay
from airhilt.errors import ScenarioError, SpeechError
from airhilt.record import Logged
from airhilt.scenario import Scenario
from airhilt.sim import pace
from airhilt.units import seconds_to_ns
from breadth import mostly_slow
from nominal import nominal
from seats import (
    SECOND,
    act,
    calls,
    cards,
    contents,
    logged,
    message,
    notices,
    offers,
    once,
    said,
    states,
    tower,
)


def taken(seat: str) -> UnregisteredMessage:
    """Return the act of a person who takes a seat as the run begins."""
    return act(seat, 1.0, "take")


def test_the_script_of_a_seat_is_told_to_its_person_and_not_said(tmp_path: Path) -> None:
    log = logged(tower(), tmp_path / "run", ["tower"])
    card = cards(log, "Washington_Tower")[0]
    assert card["addressed"] == "AAL123"
    assert "cleared to land" in card["text"]
    assert not [call for call in calls(log) if call["speaker"] == "Washington Tower"]


def test_what_a_person_says_in_its_place_is_the_line_of_the_script(tmp_path: Path) -> None:
    own = "American one two three, Washington Tower, wind calm, runway zero one, cleared to land"
    log = logged(tower(), tmp_path / "run", ["tower"], [said("Washington_Tower", 5.0, own)])
    card = cards(log, "Washington_Tower")[0]
    by_tower, by_crew = calls(log)[:2]
    assert (by_tower["id"], by_tower["text"]) == (card["line"], own)
    assert by_tower["t_tx_ns"] == 5 * SECOND
    assert by_crew["speaker"] == "AAL123"
    assert "cleared to land" in by_crew["text"].lower()


def test_a_crew_reads_back_and_does_what_only_a_person_has_told_it(tmp_path: Path) -> None:
    words = "American one two three, go around, climb and maintain three thousand"
    log = logged(tower(60.0), tmp_path / "run", ["tower"], [said("Washington_Tower", 5.0, words)])
    readback = next(call for call in calls(log) if call["speaker"] == "AAL123")
    assert readback["in_reply_to"] == "seat.Washington_Tower.1"
    assert "go" in readback["text"].lower()
    commands = [one for one in contents(log, "truth/event") if one["kind"] == "command"]
    assert json.loads(commands[0]["text"])["action"] == "go_around"
    states = contents(log, "truth/state/AAL123")
    assert states[-1]["altitude_m"] > states[0]["altitude_m"]


def test_a_heading_that_a_person_tells_a_crew_at_an_airport_is_magnetic(tmp_path: Path) -> None:
    """At Washington the compass shows 10.7 degrees more."""
    words = "American one two three, turn left heading two seven zero"
    log = logged(tower(30.0), tmp_path / "run", ["tower"], [said("Washington_Tower", 5.0, words)])
    commands = [one for one in contents(log, "truth/event") if one["kind"] == "command"]
    assert json.loads(commands[0]["text"])["track_deg"] == pytest.approx(259.3, abs=0.05)


@pytest.mark.parametrize(
    ("words", "drives"),
    [
        ("Ops one, drive to delta, hold short of runway zero one.", True),
        ("Ops one, Washington Tower, hold short of runway zero one, drive to delta.", False),
        ("Ops one, drive to delta, hold short of runway one niner.", False),
    ],
)
def test_words_that_mean_what_the_script_has_let_it_be_done(
    tmp_path: Path, words: str, drives: bool
) -> None:
    given = [
        said("Washington_Tower", 5.0, "American one two three, runway zero one, cleared to land."),
        said("Washington_Tower", 35.0, words),
    ]
    log = logged(tower(60.0), tmp_path / "run", ["tower"], given)
    commands = [one for one in contents(log, "truth/event") if one["kind"] == "command"]
    by_driver = [json.loads(one["text"])["action"] for one in commands if one["subject"] == "OPS1"]
    assert by_driver == (["taxi"] if drives else ["taxi_to"])


def test_a_ground_controller_has_the_taxiways_and_nothing_of_the_tower(tmp_path: Path) -> None:
    ground = nominal("s01b_ground_nominal").model_copy(update={"duration_s": 110.0, "cameras": ()})
    lines = {line.id: line.text for line in ground.radio.lines}
    given = [
        said("Washington_Ground", 10.0, lines["hold"]),
        said("Washington_Ground", 20.0, lines["taxi"]),
        said("Washington_Ground", 85.0, lines["proceed"]),
    ]
    log = logged(ground, tmp_path / "run", ["ground"], given)
    told = [one["line"] for one in cards(log, "Washington_Ground")]
    assert told == ["hold", "taxi", "proceed", "handover"]
    commands = [one for one in contents(log, "truth/event") if one["kind"] == "command"]
    assert [(one["subject"], json.loads(one["text"])["action"]) for one in commands] == [
        ("AAL123", "land"), ("OPS1", "hold_position"), ("DAL456", "taxi"), ("OPS1", "taxi"),
    ]  # fmt: skip
    assert states(log, "Washington_Ground")[0]["frequencies_khz"] == [121_700]
    by_crews = [one["speaker"] for one in calls(log) if one["frequency_khz"] == 121_700]
    assert by_crews.count("DAL456") == 1


def test_nobody_speaks_or_acts_for_the_person_in_an_aircraft(tmp_path: Path) -> None:
    log = logged(tower(), tmp_path / "run", ["AAL123"])
    assert [call["speaker"] for call in calls(log)].count("AAL123") == 0
    commands = [one for one in contents(log, "truth/event") if one["kind"] == "command"]
    assert not [one for one in commands if one["subject"] == "AAL123"]


def test_a_seat_is_told_what_it_sees(tmp_path: Path) -> None:
    log = logged(tower(2.0), tmp_path / "run", ["tower", "AAL123", "OPS2"])
    seats = ("Washington_Tower", "AAL123", "OPS2")
    shown = {one["seat"]: one for seat in seats for one in states(log, seat)}
    assert shown["OPS2"]["frequencies_khz"] == [119_100]  # It has no line in the script.
    parts = ("category", "has_adsb_in", "recipients")
    assert {seat: tuple(one[part] for part in parts) for seat, one in shown.items()} == {
        "Washington Tower": ("unit", False, ["Washington Tower", "ATC"]),
        "AAL123": ("aircraft", True, ["AAL123", shown["AAL123"]["icao24"]]),
        "OPS2": ("vehicle", False, ["OPS2", shown["OPS2"]["icao24"]]),
    }


def test_words_on_a_frequency_that_nobody_has_reach_nobody(tmp_path: Path) -> None:
    given = [act("Washington_Tower", 2.0, "text", text="hello", frequency_khz=136_000)]
    log = logged(tower(10.0), tmp_path / "run", ["tower"], given, speech=True)
    (call,) = calls(log)
    assert (call["frequency_khz"], call["text"]) == (136_000, "hello")


def test_a_run_with_a_person_is_replayed_without_the_person(tmp_path: Path) -> None:
    words = "American one two three, go around"
    given = [said("Washington_Tower", 5.0, words)]
    logged(tower(30.0), tmp_path / "run", ["tower"], given, speech=True)
    verdict = replay(tmp_path / "run")
    assert verdict.identical, str(verdict)


def test_the_script_goes_on_once_the_person_has_left_until_somebody_comes(tmp_path: Path) -> None:
    given = [
        act("Washington_Tower", 2.0, "take"),
        act("Washington_Tower", 8.0, "leave"),
        act("Washington_Tower", 20.0, "take"),
    ]
    log = logged(tower(), tmp_path / "run", ["tower"], given)
    by_tower = [call for call in calls(log) if call["speaker"] == "Washington Tower"]
    assert [(call["id"], call["t_tx_ns"]) for call in by_tower] == [("landing", 8 * SECOND)]
    tasks = once([card["line"] for card in one["tasks"]] for one in states(log, "Washington_Tower"))
    assert tasks == [[], ["landing"], ["proceed"]]
    assert "goes on by itself" in notices(log, "Washington_Tower")[0]
    told = [one for one in contents(log, "truth/event") if one["kind"] == "seat"]
    assert [(one["subject"], one["text"].split()[0]) for one in told] == [
        ("Washington Tower", "a"), ("Washington Tower", "nobody"), ("Washington Tower", "a"),
    ]  # fmt: skip


@pytest.mark.parametrize("words", ["Say again, American one two three", "American one two three"])
def test_who_asks_for_the_last_call_again_gets_it(tmp_path: Path, words: str) -> None:
    log = logged(tower(25.0), tmp_path / "run", ["AAL123"], [said("AAL123", 12.0, words)])
    by_tower = [call["id"] for call in calls(log) if call["speaker"] == "Washington Tower"]
    again = ["landing.repeat-1"] if words.startswith("Say again") else []
    assert by_tower == ["landing", *again]


def listening(t_s: float, *frequencies_khz: int) -> UnregisteredMessage:
    return act("OPS1", t_s, "tune", frequencies_khz=frequencies_khz)


def test_what_a_person_listens_to_and_agrees_to_is_in_the_log_and_replays(tmp_path: Path) -> None:
    given = [
        taken("OPS1"), listening(5.0), listening(8.0, 119_100),
        act("OPS1", 9.0, "agree", uses=["voice", "words"]),
        act("OPS1", 10.0, "agree", uses=["words"]), act("OPS1", 11.0, "agree", uses=[]),
    ]  # fmt: skip
    log = logged(tower(12.0), tmp_path / "run", ["OPS1"], given)
    events = [one["text"] for one in contents(log, "truth/event") if one["kind"] == "seat"]
    assert events == [
        "a person has it", "listens to no frequency", "listens to 119.100 MHz",
        "agrees to speak and type; the voice is recorded", "agrees to type; the words are recorded",
        "agrees to nothing",
    ]  # fmt: skip
    assert once(one["tuned_khz"] for one in states(log, "OPS1")) == [[119_100], []]
    verdict = replay(tmp_path / "run")
    assert verdict.identical, str(verdict)


@pytest.mark.parametrize("is_on_again", [False, True])
def test_who_has_switched_the_receiver_off_gets_no_call(tmp_path: Path, is_on_again: bool) -> None:
    """The tower sends OPS1 to the runway at 30 s, and says it again while nobody answers."""
    given = [taken("OPS1"), listening(2.0)]
    given += [listening(36.0, 119_100)] if is_on_again else []
    log = logged(tower(70.0), tmp_path / "run", ["OPS1"], given)
    outcomes = [one["outcome"] for one in contents(log, "truth/hearing/OPS1")]
    assert outcomes[0] == "missed"
    assert ("understood" in outcomes) is is_on_again
    assert bool(offers(log, "OPS1")) is is_on_again


def test_who_reads_calls_gets_none_of_a_frequency_that_is_switched_off(tmp_path: Path) -> None:
    """The tower clears AAL123 to land at 1 s, and again while nobody answers."""
    given = [
        act("AAL123", 0.2, "take"),
        act("AAL123", 0.4, "tune", frequencies_khz=()),
        act("AAL123", 10.0, "tune", frequencies_khz=[119_100]),
    ]
    log = logged(tower(40.0), tmp_path / "run", ["AAL123"], given, topology="asr_first")
    outcomes = [one["outcome"] for one in contents(log, "truth/hearing/AAL123")]
    assert outcomes == ["missed", "understood"]


def test_an_aircraft_that_was_not_told_to_land_goes_around_and_says_so(tmp_path: Path) -> None:
    log = logged(tower(110.0), tmp_path / "run", ["AAL123"], [taken("AAL123")])
    (told,) = notices(log, "AAL123")
    assert told == "Unable: no clearance to land: going around"
    (event,) = [one for one in contents(log, "truth/event") if one["kind"] == "unable"]
    assert event["subject"] == "AAL123"


@pytest.mark.parametrize(
    ("reacts", "avoided"), mostly_slow([(True, True), (False, False)], (False, False))
)
def test_a_warning_helps_a_person_who_lands_only_if_the_person_reacts(
    tmp_path: Path, reacts: bool, avoided: bool
) -> None:
    scenario = nominal("s01b_noncompliance").model_copy(update={"cameras": ()})
    land, go_around = {"action": "land", "runway": "01"}, {"action": "go_around"}
    given = [taken("AAL123"), act("AAL123", 5.0, "fly", command=land)]
    if reacts:
        given.append(act("AAL123", 71.0, "fly", command=go_around))
    out = tmp_path / "run"
    logged(scenario, out, ["AAL123"], given, assistant="reference")
    assert json.loads((out / "summary.json").read_text())["avoided"] is avoided


@pytest.mark.parametrize("left_s", mostly_slow([None, 3.0, 95.0], None, 3.0))
def test_a_warning_at_empty_seats_helps_only_once_their_crews_fly_by_themselves(
    tmp_path: Path, left_s: float | None
) -> None:
    """Nobody takes the two seats, or their persons leave before the warning of 83 s, or after."""
    seats = ("AAL123", "DAL456")
    given = [
        act(seat, t_s, "take" if t_s == 2.0 else "leave")
        for t_s in (2.0, left_s or 0.0)
        for seat in seats
    ]
    scenario = nominal("s02a_headon").model_copy(update={"cameras": ()})
    out = tmp_path / "run"
    logged(scenario, out, seats, () if left_s is None else given, assistant="reference")
    summary = json.loads((out / "summary.json").read_text())
    assert summary["t_first_warning_s"] is not None
    assert summary["avoided"] is (left_s is not None)


def test_a_pause_and_slow_motion_are_events_and_replay(tmp_path: Path) -> None:
    given = [
        act("Washington_Tower", t_s, "pace", factor=factor)
        for t_s, factor in ((2.0, 0.0), (2.1, 0.5))
    ]
    log = logged(tower(5.0), tmp_path / "run", ["tower"], given)
    events = [one["text"] for one in contents(log, "truth/event") if one["kind"] == "pace"]
    assert events == ["paused", "0.5x"]
    assert replay(tmp_path / "run").identical


@pytest.mark.parametrize("pause", [True, False])
def test_the_wait_for_the_seats_is_in_the_log_and_replays(tmp_path: Path, pause: bool) -> None:
    given = [act("Washington_Tower", 1e-9, "take")]
    out, options = tmp_path / "run", {"wait_for_seats": True, "pause": pause}
    log = logged(tower(5.0), out, ["tower"], given, **options)
    events = [one for one in contents(log, "truth/event") if one["kind"] == "pace"]
    assert [(one["t_ns"], one["text"]) for one in events] == [(0, "paused"), (1, "realtime")]
    assert replay(out).identical


@pytest.mark.parametrize("seats", [("tower",), ()])
def test_a_run_with_people_that_was_stopped_loses_the_time_and_replays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, seats: tuple[str, ...]
) -> None:
    """Where nobody takes part, the log knows of no wall time."""
    readings = count()

    def clock_s() -> float:
        is_stopped_before = next(readings) >= 10
        return time.perf_counter() + (5.0 if is_stopped_before else 0.0)

    monkeypatch.setattr(pace, "time", SimpleNamespace(perf_counter=clock_s))
    log = logged(tower(3.0), tmp_path / "run", seats, pace="realtime")
    events = {one["text"] for one in contents(log, "truth/event") if one["kind"] == "pace"}
    assert events == ({"stalled"} if seats else set())
    assert replay(tmp_path / "run").identical


def test_nobody_is_on_the_air_in_a_pause(tmp_path: Path) -> None:
    given = [
        act("Washington_Tower", 2.0, "press"),
        act("Washington_Tower", 3.0, "pace", factor=0.0),
        act("Washington_Tower", 3.2, "pace", factor=1.0),
    ]
    log = logged(tower(8.0), tmp_path / "run", ["tower"], given, speech=True)
    (call,) = [one for one in calls(log) if one["is_from_microphone"]]
    assert call["t_end_ns"] == 3 * SECOND


@pytest.mark.parametrize("factor", [0.0, 0.25])
def test_time_passes_again_once_the_last_person_has_left(tmp_path: Path, factor: float) -> None:
    given = [
        act("Washington_Tower", 1.0, "take"),
        act("AAL123", 1.0, "take"),
        act("Washington_Tower", 2.0, "pace", factor=factor),
        act("AAL123", 3.0, "leave"),
        act("Washington_Tower", 3.5, "leave"),
    ]
    log = logged(tower(5.0), tmp_path / "run", ["tower", "AAL123"], given)
    events = [one for one in contents(log, "truth/event") if one["kind"] == "pace"]
    assert [(one["t_ns"], one["text"]) for one in events][1:] == [(3_500_000_000, "realtime")]
    assert replay(tmp_path / "run").identical


def spoken_from(log: Sequence[Logged]) -> list[str | None]:
    """Return what the person in AAL123 is told of the voice of the assistant, one after another."""
    return once(one["spoken_from"] for one in states(log, "AAL123"))


@pytest.mark.parametrize(("speech", "told"), [(True, ["CAUTION"]), (False, [None])])
def test_a_seat_is_told_which_advisories_are_spoken(
    encounter: Scenario, tmp_path: Path, speech: bool, told: list[str | None]
) -> None:
    short = encounter.model_copy(update={"duration_s": 1.0})
    log = logged(short, tmp_path / "run", ["AAL123"], assistant="reference", speech=speech)
    assert spoken_from(log) == told


def test_a_seat_is_told_when_the_voice_of_the_assistant_is_lost(
    encounter: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*_: object) -> None:
        raise SpeechError("no voice any more")

    monkeypatch.setattr(TtsWorker, "step", fails)
    short = encounter.model_copy(update={"duration_s": 5.0})
    log = logged(short, tmp_path / "run", ["AAL123"], assistant="reference", speech=True)
    assert spoken_from(log) == ["CAUTION", None]


def test_a_person_is_told_what_the_aircraft_cannot_do(tmp_path: Path) -> None:
    command = {"action": "altitude", "altitude_ft": 60_000}
    given = [act("AAL123", 2.0, "fly", command=command)]
    log = logged(tower(5.0), tmp_path / "run", ["AAL123"], given)
    (unable,) = notices(log, "AAL123")
    assert unable.startswith("Unable: 60000 ft")


def test_a_program_commands_no_actor_that_is_left_to_a_person(tmp_path: Path) -> None:
    given = [message("command/AAL123", 2.0, command={"action": "go_around"})]
    log = logged(tower(3.0), tmp_path / "run", ["AAL123"], given)
    (refused,) = [one for one in contents(log, "truth/event") if one["kind"] == "refused"]
    assert "left to a person" in refused["text"]
    assert not contents(log, "command/")


def test_a_seat_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"--seat 'UAL9'.*expected tower, or one of .*AAL123"):
        logged(tower(5.0), tmp_path / "run", ["UAL9"])


def test_there_is_no_seat_where_nobody_has_a_radio(tmp_path: Path) -> None:
    silent = tower(5.0)
    silent = silent.model_copy(update={"radio": silent.radio.model_copy(update={"lines": ()})})
    with pytest.raises(ScenarioError, match=r"--seat 'AAL123'.*no radio line.*radio/lines"):
        logged(silent, tmp_path / "run", ["AAL123"])


def test_the_summary_has_when_a_typed_call_was_audible_at_another_seat(tmp_path: Path) -> None:
    given = [
        taken("Washington_Tower"),
        taken("AAL123"),
        said("Washington_Tower", 1.0, "All stations, stand by."),
        act("AAL123", 2.0, "hear", id="seat.Washington_Tower.1", after_s=0.5),
    ]
    logged(tower(4.0), tmp_path / "run", ["tower", "AAL123"], given)
    controller, _ = json.loads((tmp_path / "run" / "summary.json").read_text())["people"]
    (call,) = controller["calls"]
    assert (call["call"], call["heard_at"]) == ("seat.Washington_Tower.1", 1)
    assert call["to_loudspeaker_s"] is None  # The run is in virtual time.


def is_followed(out: Path, advised: dict[str, Any], command: dict[str, Any]) -> bool:
    """Return whether the person in AAL123, who lands to the north, follows by a command."""
    name = {"id": "a-1", "revision": 0, "recipient": "AAL123"}
    advisory = {
        "kind": "loss_of_separation", "severity": "WARNING", "traffic": ["AAL123"],
        "recipients": ["AAL123"], "message": "", "t_ready_ns": 0,
        "evidence": {"sources": ["adsb"]}, "recommendation": advised,
    }  # fmt: skip
    given = [
        act("AAL123", 0.5, "take"),
        message("advisory/AAL123", 1.0, **name, **advisory),
        act("AAL123", 1.0, "perceive", **name, way="seen"),
        act("AAL123", 1.5, "fly", command=command),
    ]
    logged(tower(2.0), out, ["AAL123"], given)
    (of_crew,) = json.loads((out / "summary.json").read_text())["people"]
    return bool(of_crew["reactions"][0]["followed"])


@pytest.mark.parametrize(
    ("altitude_ft", "followed"), [(3000, True), (60_000, False), (1000, False)]
)
def test_advice_to_climb_is_followed_by_who_climbs_and_can(
    tmp_path: Path, altitude_ft: float, followed: bool
) -> None:
    """60,000 ft is above the ceiling of its type: its crew is unable."""
    climb = {"sense": "climb", "altitude_ft": 3000, "vertical_rate_fpm": 1500}
    command = {"action": "altitude", "altitude_ft": altitude_ft}
    found = is_followed(tmp_path / "run", {"action": "altitude", **climb}, command)
    assert found is followed


@pytest.mark.parametrize(("pace", "reaction_s"), [("realtime", 0.5), ("4x", None)])
def test_a_reaction_is_measured_in_a_run_that_begins_in_real_time_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, pace: str, reaction_s: float | None
) -> None:
    # A busy machine may stall for a second, which is not what this is about.
    monkeypatch.setattr("airhilt.cosim.pace_control.MOST_BEHIND_NS", seconds_to_ns(600.0))
    name = {"id": "a-1", "revision": 0, "recipient": "AAL123"}
    advised = {
        "kind": "runway_conflict", "severity": "WARNING", "traffic": ["AAL123"],
        "recipients": ["AAL123"], "message": "stop", "t_ready_ns": 0,
        "evidence": {"sources": ["adsb"]},
    }  # fmt: skip
    given = [
        act("AAL123", 0.5, "take"),
        message("advisory/AAL123", 1.0, **name, **advised),
        act("AAL123", 1.0, "perceive", **name, way="seen"),
        act("AAL123", 1.5, "text", text="Say again."),
    ]
    out = tmp_path / "run"
    logged(tower(2.0), out, ["AAL123"], given, pace=pace)
    (of_crew,) = json.loads((out / "summary.json").read_text())["people"]
    (found,) = of_crew["reactions"]
    assert (found["reaction_time_s"], found["is_real_time"]) == (reaction_s, reaction_s is not None)
