"""What comes of calls: they are taken, repeated, read back, corrected, or lost."""

from __future__ import annotations

from functools import partial
from typing import Any, cast

import pytest

from airhilt.messages import (
    Advisory,
    Confirm,
    Evidence,
    Severity,
    SpokenTruth,
    Transcript,
    Transmission,
    Word,
)
from airhilt.sensors.radio.hearing import Heard
from airhilt.sensors.radio.listeners import TRANSCRIPT_PATIENCE_S
from airhilt.sensors.radio.radio_call import MOST_TIMES
from airhilt.sensors.radio.readback_policy import REPEAT_AFTER_S, REPEAT_SPREAD_S
from airhilt.sensors.radio.stations import Stations
from airhilt.sim import Priority
from airhilt.units import FOOT, SECOND_NS, seconds_to_ns
from airhilt.world.site import FixedSite, ScenarioSite
from conversations import CLEARANCE, CLIMB, KHZ, MISSED, READBACK, TOWER, UNSURE, Sharp, World, line

CHECK = line("check", 2, "DAL456", TOWER, "Washington Center, Delta four five six.")
DEAF = {"type": "not_received", "line": "clearance", "actor": "AAL123"}


def test_without_noise_a_call_is_taken_when_it_ends_and_done_after_its_delay() -> None:
    world = World(CLEARANCE, READBACK).run()
    assert world.said() == ["clearance", "readback"]
    ((callsign, command, at_s),) = world.done
    assert (callsign, command.altitude_ft) == ("AAL123", 33_000)
    assert at_s == pytest.approx(world.spoken("clearance").t_end_ns / SECOND_NS + 2.0)
    assert world.hearings("AAL123") == [("clearance", "understood")]
    assert world.spoken("readback").in_reply_to == "clearance"


def test_who_answers_leaves_a_moment_of_silence_after_a_call_that_it_waited_for() -> None:
    world = World(CLEARANCE, READBACK, heard={("clearance", "AAL123"): MISSED}).run()
    silence_ns = world.spoken("readback").t_tx_ns - world.spoken("clearance.repeat-1").t_end_ns
    assert seconds_to_ns(0.2) <= silence_ns <= seconds_to_ns(1.0)


def test_a_line_begins_when_its_transmission_does() -> None:
    world = World(CLEARANCE, READBACK).run()
    assert world.begun == [
        (world.spoken(name).t_tx_ns / SECOND_NS, name) for name in ("clearance", "readback")
    ]


def test_a_call_that_is_missed_is_made_again_and_its_readback_waits_for_that() -> None:
    world = World(CLEARANCE, READBACK, heard={("clearance", "AAL123"): MISSED}).run()
    assert world.said() == ["clearance", "clearance.repeat-1", "readback"]
    first, again = world.spoken("clearance"), world.spoken("clearance.repeat-1")
    assert again.t_tx_ns - first.t_end_ns >= seconds_to_ns(REPEAT_AFTER_S)
    assert [at_s for *_, at_s in world.done] == [again.t_end_ns / SECOND_NS + 2.0]
    assert world.hearings("AAL123") == [
        ("clearance", "missed"), ("clearance.repeat-1", "understood"),
    ]  # fmt: skip


@pytest.mark.parametrize("unit", ["Atlanta Center", "Washington Center"])
def test_an_answer_that_tells_somebody_to_act_is_made_again_if_it_is_missed(unit: str) -> None:
    check = line("check", 2, "DAL456", unit, f"{unit}, Delta four five six.")
    answer = line(
        "answer", 10, unit, "DAL456", "Delta four five six, climb flight level three three zero.",
        answers="check", commands=[{"actor": "DAL456", "command": CLIMB}],
    )  # fmt: skip
    world = World(check, answer, heard={("answer", "DAL456"): MISSED}).run()
    assert world.said() == ["check", "answer", "answer.repeat-1"]
    assert [who for who, _, _ in world.done] == ["DAL456"]


def test_one_who_is_not_sure_asks_again() -> None:
    world = World(CLEARANCE, READBACK, heard={("clearance", "AAL123"): UNSURE}).run()
    assert world.said() == [
        "clearance", "clearance.say-again-1", "clearance.repeat-1", "readback",
    ]  # fmt: skip
    assert world.spoken("clearance.say-again-1").speaker == "AAL123"
    assert world.spoken("clearance.say-again-1").in_reply_to == "clearance"
    assert len(world.done) == 1


def test_a_crew_with_a_bad_receiver_asks_again_where_others_understand() -> None:
    other = line(
        "other", 60, TOWER, "DAL456", "Delta four five six, climb flight level three three zero.",
        commands=[{"actor": "DAL456", "command": CLIMB}],
    )  # fmt: skip
    receivers = {"AAL123": {"snr_db": -3.0}, "DAL456": {"snr_db": 3.0}}
    world = World(CLEARANCE, other, hearing=Sharp(0), snr_db=20.0, receivers=receivers).run()
    assert world.said()[:2] == ["clearance", "clearance.say-again-1"]
    assert world.hearings("DAL456") == [("other", "understood")]
    assert world.hearings(TOWER) == [
        (name, "understood") for name in world.said() if "say-again" in name or "end" in name
    ]
    assert [callsign for callsign, *_ in world.done] == ["DAL456"]


def test_a_receiver_below_the_squelch_gives_its_crew_nothing_and_the_assistant_all() -> None:
    receivers = {"AAL123": {"snr_db": -11.0}}
    world = World(CLEARANCE, READBACK, receivers=receivers).run()
    assert set(world.hearings("AAL123")) == {(name, "missed") for name in world.said()}
    assert "readback" not in world.said()
    texts = [one.id for one in world.published if isinstance(one, Transcript)]
    assert texts == world.said()


def test_a_unit_asks_the_caller_by_his_callsign() -> None:
    check = line("check", 2, "AAL123", TOWER, "Washington Center, American one two three.")
    world = World(check, heard={("check", TOWER): UNSURE}).run()
    assert world.said() == ["check", "check.say-again-1", "check.repeat-1"]
    question = world.spoken("check.say-again-1")
    assert (question.speaker, question.addressed) == (TOWER, "AAL123")
    assert question.text == "American one twenty three, say again."


def test_who_is_not_sure_of_two_calls_in_a_row_asks_once() -> None:
    one = line("one", 2, "AAL123", TOWER, "Washington Center, American one two three.")
    two = line("two", 2.5, "AAL123", TOWER, "Washington Center, American one two three, request.")
    world = World(one, two, heard={("one", TOWER): UNSURE, ("two", TOWER): UNSURE}).run()
    assert world.said() == ["one", "two", "one.say-again-1", "two.repeat-1"]


def test_a_question_that_nobody_hears_does_not_end_the_matter() -> None:
    heard = {("clearance", "AAL123"): UNSURE, ("clearance.say-again-1", TOWER): MISSED}
    assert World(CLEARANCE, READBACK, heard=heard).run().said()[-2:] == [
        "clearance.repeat-1", "readback",
    ]  # fmt: skip


def test_who_asked_for_a_call_and_missed_it_asks_once_more() -> None:
    heard = {("readback", TOWER): UNSURE, ("readback.repeat-1", TOWER): MISSED}
    world = World(CLEARANCE, READBACK, heard=heard).run()
    assert world.said() == [
        "clearance", "readback", "readback.say-again-1", "readback.repeat-1",
        "readback.say-again-2", "readback.repeat-2",
    ]  # fmt: skip


def test_what_was_replaced_before_it_was_read_back_is_not_read_back_any_more() -> None:
    end_s = World(CLEARANCE).run().spoken("clearance").t_end_ns / SECOND_NS
    descend = line(
        "descend", end_s + 0.5, TOWER, "AAL123",
        "American one two three, descend and maintain flight level two three zero.",
        commands=[{"actor": "AAL123", "command": CLIMB | {"altitude_ft": 23000}}],
    )  # fmt: skip
    world = World(CLEARANCE, descend, readbacks="generated").run()
    assert world.said() == ["clearance", "descend", "descend.readback"]


@pytest.mark.parametrize(("heard", "end"), [(MISSED, "no reply heard"), (UNSURE, "unreadable")])
def test_a_call_that_is_never_taken_is_said_twice_the_last_time_and_then_given_up(
    heard: Heard, end: str
) -> None:
    names = ["clearance", *(f"clearance.repeat-{n}" for n in range(1, MOST_TIMES))]
    world = World(CLEARANCE, READBACK, heard={(name, "AAL123"): heard for name in names}).run()
    assert [name for name in world.said() if "say-again" not in name] == [*names, "clearance.end"]
    assert world.spoken(names[-1]).text.count(CLEARANCE["text"]) == 2
    assert end in world.spoken("clearance.end").text
    assert world.done == []


def test_what_a_failure_makes_deaf_nobody_notices() -> None:
    world = World(CLEARANCE, READBACK, failures=[DEAF]).run()
    assert world.said() == ["clearance"]
    assert world.done == []
    assert world.hearings("AAL123") == [("clearance", "missed")]


def test_a_controller_who_checks_readbacks_notices_that_none_comes() -> None:
    world = World(CLEARANCE, READBACK, failures=[DEAF], controller_checks_readbacks=True).run()
    assert world.said() == ["clearance", "clearance.repeat-1", "readback"]
    assert [command.altitude_ft for _, command, _ in world.done] == [33_000]


def test_a_wrong_readback_stands_where_nobody_checks_it() -> None:
    wrong = {
        "type": "readback_wrong", "line": "readback", "text": WRONG,
        "commands": [{"actor": "AAL123", "command": CLIMB | {"altitude_ft": 35000}}],
    }  # fmt: skip
    spoken = line("clearance", 10, TOWER, "AAL123", CLEARANCE["text"])
    world = World(spoken, READBACK, failures=[wrong]).run()
    assert world.said() == ["clearance", "readback"]
    assert [command.altitude_ft for _, command, _ in world.done] == [35_000]


WRONG = "Climb and maintain flight level three five zero, American one two three."


def test_a_controller_who_checks_corrects_a_wrong_readback_and_the_crew_does_what_it_should() -> (
    None
):
    wrong = {
        "type": "readback_wrong", "line": "readback", "text": WRONG,
        "commands": [
            {"actor": "AAL123", "delay_s": 60, "command": CLIMB | {"altitude_ft": 35000}}
        ],
    }  # fmt: skip
    right = {**READBACK, "commands": [{"actor": "AAL123", "command": CLIMB}]}
    spoken = line("clearance", 10, TOWER, "AAL123", CLEARANCE["text"])
    world = World(spoken, right, failures=[wrong], controller_checks_readbacks=True).run()
    assert world.said() == [
        "clearance", "readback", "readback.correction", "readback.correction.readback",
    ]  # fmt: skip
    assert "negative" in world.spoken("readback.correction").text
    assert world.spoken("readback.correction.readback").text == READBACK["text"]
    assert [command.altitude_ft for _, command, _ in world.done] == [33_000]


def test_a_crew_that_took_the_call_of_another_one_does_not_do_it_once_it_is_said_again() -> None:
    commands = [
        {"actor": "AAL123", "delay_s": 60.0, "command": CLIMB},
        {"actor": "DAL456", "delay_s": 60.0, "command": CLIMB},
    ]
    spoken = {**CLEARANCE, "commands": commands}
    words = READBACK["text"].replace("American one two three", "Delta four five six")
    taken = line("taken", 16, "DAL456", TOWER, words, answers="clearance")
    for checks, who in ((True, ["AAL123"]), (False, ["AAL123", "DAL456"])):
        world = World(spoken, taken, controller_checks_readbacks=checks).run()
        assert world.said() == ["clearance", "taken", *["clearance.repeat-1"] * checks]
        assert sorted({callsign for callsign, _, _ in world.done}) == who


def test_a_controller_does_not_correct_what_another_one_has_said() -> None:
    """The crew tells the next unit wrongly what it was cleared to; that unit did not say it."""
    report = {**READBACK, "to": "Potomac Approach", "text": WRONG, "answers": "clearance"}
    world = World(CLEARANCE, report, controller_checks_readbacks=True).run()
    assert world.said() == ["clearance", "readback"]


def test_a_crew_does_what_it_has_misheard_and_reads_that_back() -> None:
    misheard = Heard("misheard", CLEARANCE["text"].replace("three three zero", "three five zero"))
    world = World(CLEARANCE, READBACK, heard={("clearance", "AAL123"): misheard}).run()
    assert world.hearings("AAL123") == [("clearance", "misheard")]
    assert [command.altitude_ft for _, command, _ in world.done] == [35_000]
    assert "three five zero" in world.spoken("readback").text.lower().replace("tree", "three")


def test_a_readback_that_no_line_gives_comes_where_the_scenario_asks_for_it() -> None:
    assert World(CLEARANCE).run().said() == ["clearance"]
    world = World(CLEARANCE, readbacks="generated").run()
    assert world.said() == ["clearance", "clearance.readback"]
    assert world.spoken("clearance.readback").speaker == "AAL123"
    assert World(CLEARANCE, READBACK, readbacks="generated").run().said() == [
        "clearance", "readback",
    ]  # fmt: skip


def asked(world: World, recipient: str, *names: str, t_s: float = 30.0) -> None:
    """Advise somebody at a time to confirm calls of AAL123."""
    advisory = Advisory(
        t_ns=seconds_to_ns(t_s), id="decision-1", revision=0, recipient=recipient,
        recipients=(recipient,), kind="clarification", severity=Severity.ADVISORY,
        traffic=("AAL123",), message="confirm", t_ready_ns=0,
        recommendation=Confirm(callsign="AAL123", slot="altitude"),
        evidence=Evidence(sources=("radio",), radio_ids=names),
    )  # fmt: skip
    take = partial(world.conversation.take, "advisory/ATC", advisory, b"")
    world.director.at(advisory.t_ns, take, Priority.SCRIPT)


def test_a_controller_who_is_asked_says_the_instruction_again_and_the_crew_reads_it_back() -> None:
    prompt = {TOWER: {"reaction_median_s": 3.0, "reaction_sigma": 0.0}}
    world = World(CLEARANCE, {**READBACK, "text": WRONG}, controllers=prompt)
    asked(world, "ATC", "clearance")
    asked(world, "ATC", "clearance")
    world.run_until(60.0)
    again = ["clearance.confirmation-1", "clearance.confirmation-1.readback"]
    assert world.said() == ["clearance", "readback", *again]
    assert world.spoken(again[0]).text == CLEARANCE["text"]
    assert world.spoken(again[0]).t_tx_ns == 33 * SECOND_NS
    assert world.spoken(again[1]).text == WRONG
    assert len(world.done) == 1


def test_a_controller_who_is_asked_about_a_readback_asks_the_crew_for_it() -> None:
    world = World(CLEARANCE, {**READBACK, "text": WRONG})
    asked(world, "ATC", "readback")
    world.run_until(60.0)
    request, again = world.said()[2:]
    assert (world.spoken(request).speaker, world.spoken(again).speaker) == (TOWER, "AAL123")
    assert "say again" in world.spoken(request).text
    assert world.spoken(again).text == WRONG


@pytest.mark.parametrize("call", ["clearance", "readback"])
def test_a_controller_who_has_heard_a_right_readback_does_not_ask_for_it(call: str) -> None:
    world = World(CLEARANCE, READBACK)
    asked(world, "ATC", call)
    assert world.run_until(60.0).said() == ["clearance", "readback"]


def test_a_crew_that_is_asked_says_its_own_call_again_without_being_asked_by_anybody() -> None:
    world = World(CLEARANCE, READBACK)
    asked(world, "AAL123")
    world.run_until(60.0)
    assert world.said()[2:] == ["readback.confirmation-1"]


def test_who_had_missed_the_call_takes_it_when_it_is_said_again() -> None:
    world = World(CLEARANCE, READBACK, failures=[DEAF])
    asked(world, "ATC", "clearance")
    world.run_until(60.0)
    assert world.said() == ["clearance", "clearance.repeat-1", "readback"]
    assert [callsign for callsign, _, _ in world.done] == ["AAL123"]


@pytest.mark.parametrize("recipient", ["ATC", "AAL123"])
def test_a_blocked_call_that_is_about_to_be_repeated_is_not_asked_for(recipient: str) -> None:
    """The two calls block each other at 10 s, and are made again at 19.5 s and 22.3 s."""
    other = line("request", 10.1, "DAL456", TOWER, "Washington Center, Delta four five six.")
    world = World(CLEARANCE, other)
    asked(world, recipient, "clearance", t_s=15.0)
    world.run_until(60.0)
    assert [name for name in world.said() if name.startswith("clearance")] == [
        "clearance", "clearance.repeat-1"
    ]  # fmt: skip


def test_a_call_that_is_on_the_air_is_not_made_again_because_it_is_asked_for() -> None:
    prompt = {TOWER: {"reaction_median_s": 3.0, "reaction_sigma": 0.0}}
    world = World(CLEARANCE, READBACK, controllers=prompt)
    asked(world, "ATC", "clearance", t_s=8.0)
    world.run_until(60.0)
    assert world.said() == ["clearance", "readback"]


def test_a_request_to_confirm_what_was_never_said_is_left_alone() -> None:
    world = World()
    asked(world, "ATC")
    world.run_until(60.0)
    assert world.said() == []


def test_two_calls_at_once_are_understood_by_nobody_and_both_are_made_again() -> None:
    other = line("request", 10.1, "DAL456", TOWER, "Washington Center, Delta four five six.")
    world = World(CLEARANCE, other).run()
    assert world.spoken("clearance").blocked_by == ("request",)
    assert world.spoken("request").blocked_by == ("clearance",)
    assert set(world.said()) == {
        "clearance", "request", "clearance.repeat-1", "request.repeat-1",
    }  # fmt: skip
    assert len(world.done) == 1
    texts = [one.id for one in world.published if isinstance(one, Transcript)]
    assert sorted(texts) == ["clearance.repeat-1", "request.repeat-1"]


def test_under_a_stuck_microphone_nothing_gets_through_and_then_it_does() -> None:
    stuck = {"type": "stuck_microphone", "actor": "DAL456", "at_s": 9, "for_s": 10}
    world = World(CHECK, CLEARANCE, failures=[stuck]).run()
    carrier = next(name for name in world.said() if name.startswith("stuck-microphone"))
    assert world.spoken("clearance").blocked_by == (carrier,)
    assert world.said()[-1] == "clearance.repeat-1"
    assert len(world.done) == 1


def test_who_has_a_stuck_microphone_is_heard_and_hears_nobody() -> None:
    climb = line(
        "climb", 12, TOWER, "DAL456",
        "Delta four five six, climb and maintain flight level three five zero.",
    )  # fmt: skip
    stuck = {"type": "stuck_microphone", "actor": "DAL456", "at_s": 1, "for_s": 30}
    world = World(CHECK, climb, failures=[stuck]).run()
    assert world.spoken("check").blocked_by == ()
    assert world.hearings(TOWER) == [("check", "understood")]
    assert world.hearings("DAL456")[0] == ("climb", "missed")


def test_it_is_told_when_microphones_are_stuck_and_when_none_is_any_more() -> None:
    failures = [
        {"type": "stuck_microphone", "actor": actor, "at_s": at_s, "for_s": 10}
        for actor, at_s in (("AAL123", 5), ("DAL456", 9))
    ]
    world = World(CHECK, CLEARANCE, failures=failures).run()
    assert world.microphones == [(5.0, "AAL123"), (9.0, "DAL456"), (19.0, None)]


def test_what_is_on_the_air_at_the_end_has_been_said_up_to_there_and_nobody_takes_it() -> None:
    stuck = {"type": "stuck_microphone", "actor": "AAL123", "at_s": 5, "for_s": 600}
    world = World(CLEARANCE, failures=[stuck]).run_until(12.0)
    carrier, clearance = world.said()
    assert world.spoken(clearance).blocked_by == (carrier,)
    received = [one for one in world.published if isinstance(one, Transmission)]
    spoken = [one for one in world.published if isinstance(one, SpokenTruth)]
    ends = [one.t_end_ns for one in spoken] + [one.t_end_ns for one in received]
    assert ends == [12 * SECOND_NS] * 4
    assert world.hearings("AAL123") == []


def test_a_call_that_the_end_cuts_off_gives_no_words() -> None:
    world = World(CLEARANCE).run_until(12.0)
    assert world.said() == ["clearance"]
    assert not any(isinstance(one, Transcript) for one in world.published)


def test_who_is_below_the_horizon_of_the_receiver_is_not_received() -> None:
    request = line("request", 30, "AAL123", TOWER, "Washington Center, American one two three.")
    world = World(request, CLEARANCE)
    world.actors["AAL123"].body.state = FixedSite(0.9, -1.34, altitude_m=3_000 * FOOT)
    world.run()
    assert "request" in world.said()
    received = {one.id for one in world.published if isinstance(one, (Transmission, Transcript))}
    assert received == {name for name in world.said() if name.startswith("clearance")}


def test_somebody_below_the_horizon_hears_nothing() -> None:
    world = World(CLEARANCE)
    far = FixedSite(0.9, -1.34, altitude_m=3_000 * FOOT)
    world.actors["AAL123"].body.state = far
    world.run()
    assert world.done == []
    assert {outcome for _, outcome in world.hearings("AAL123")} == {"missed"}


def test_an_aircraft_that_is_no_more_says_nothing() -> None:
    world = World(CLEARANCE, READBACK)
    world.actors["AAL123"].body.ended = "collision"
    assert "readback" not in world.run().said()


class Reading(World):
    """Crews get the transcript, which comes when and as the test says."""

    gives_transcripts = False

    def transcribe(
        self,
        text: str,
        at_s: float,
        name: str = "clearance",
        confidences: list[float] | None = None,
    ) -> Reading:
        words = tuple(
            Word(text=word, confidence=one)
            for word, one in zip(text.split(), confidences or [], strict=False)
        )
        transcript = Transcript(
            id=name, frequency_khz=KHZ, t_tx_ns=0, t_end_ns=0, text=text, words=words,
            confidence=1.0, engine="test",
        )  # fmt: skip
        self.director.at(
            seconds_to_ns(at_s),
            lambda: self.conversation.take(f"asr/{KHZ}", transcript, b""),
            Priority.RESULT,
        )
        return self


def test_a_crew_that_reads_takes_a_call_when_its_transcript_comes() -> None:
    world = Reading(CLEARANCE, READBACK, topology="asr_first")
    world.transcribe(
        "american one two three climb and maintain flight level three three zero", 20.0
    )
    world.run()
    assert [at_s for *_, at_s in world.done] == [22.0]
    assert world.spoken("readback").t_tx_ns >= 20 * SECOND_NS


def test_a_crew_that_reads_does_what_it_reads() -> None:
    world = Reading(CLEARANCE, READBACK, topology="asr_first")
    world.transcribe("american one two three climb and maintain flight level three five zero", 20.0)
    world.run()
    assert [command.altitude_ft for _, command, _ in world.done] == [35_000]


def test_a_crew_may_take_for_its_own_what_it_reads() -> None:
    world = Reading(CHECK, CLEARANCE, topology="asr_first")
    world.transcribe("delta four five six climb and maintain flight level three three zero", 18.0)
    world.run()
    assert ("DAL456", 33_000) in [(who, command.altitude_ft) for who, command, _ in world.done]


@pytest.mark.parametrize(
    "text",
    [CLEARANCE["text"], "american one two three climb and maintain flight level three four zero"],
)
def test_a_crew_lets_be_what_it_reads_for_others(text: str) -> None:
    world = Reading(CHECK, CLEARANCE, topology="asr_first").transcribe(text, 18.0).run()
    assert world.hearings("DAL456") == []
    assert {who for who, _, _ in world.done} == {"AAL123"}


def test_nobody_reads_a_call_that_was_blocked() -> None:
    over = line("over", 11, "DAL456", TOWER, "Washington Center, Delta four five six.")
    blocked = {"type": "blocked", "line": "over"}
    world = Reading(CLEARANCE, over, failures=[blocked], topology="asr_first")
    world.transcribe(CLEARANCE["text"], 16.0).run()
    assert world.spoken("clearance").blocked_by == ("over",)
    assert world.hearings("AAL123")[0] == ("clearance", "missed")
    assert "clearance.repeat-1" in world.said()
    assert world.done == []


def test_nobody_takes_for_his_own_what_was_blocked() -> None:
    over = line("over", 11, "AAL123", TOWER, "Washington Center, American one two three.")
    blocked = {"type": "blocked", "line": "over"}
    world = Reading(over, CHECK, CLEARANCE, failures=[blocked], topology="asr_first")
    world.transcribe("delta four five six climb and maintain flight level three three zero", 16.0)
    assert world.run().done == []


def test_a_crew_that_reads_asks_again_where_the_right_words_are_not_sure() -> None:
    world = Reading(CLEARANCE, topology="asr_first")
    confidences = [0.5] * len(CLEARANCE["text"].split())
    world.transcribe(CLEARANCE["text"], 16.0, confidences=confidences).run()
    assert world.hearings("AAL123")[0] == ("clearance", "unsure")
    assert "clearance.say-again-1" in world.said()
    assert world.done == []


def test_without_a_transcript_a_crew_that_reads_misses_the_call_after_20_s() -> None:
    assert TRANSCRIPT_PATIENCE_S == 20.0
    world = Reading(CLEARANCE, topology="asr_first").run()
    assert world.hearings("AAL123")[0] == ("clearance", "missed")
    first, again = world.spoken("clearance"), world.spoken("clearance.repeat-1")
    waited_s = (again.t_tx_ns - first.t_end_ns) / SECOND_NS
    soonest_s = TRANSCRIPT_PATIENCE_S + REPEAT_AFTER_S
    assert soonest_s <= waited_s <= soonest_s + REPEAT_SPREAD_S


def test_nobody_hears_who_exists_no_more_or_is_heard_by_them() -> None:
    world = World(CLEARANCE, READBACK)
    stations = Stations(cast(Any, world.actors), ScenarioSite.of(world.scenario), world.scenario)
    assert stations.is_there("AAL123")
    assert stations.audible("AAL123", TOWER)
    cast(Any, world.actors["AAL123"].body).ended = "collision"
    assert not stations.is_there("AAL123")
    assert not stations.audible("AAL123", TOWER)
    assert not stations.audible(TOWER, "AAL123")
    assert stations.audible(TOWER, TOWER)
