"""People at seats: what the script has for them, what they say, and what they are offered."""

from __future__ import annotations

from functools import partial
from typing import Any, TypeVar

import numpy as np
import pytest

from airhilt.audio.pcm import SAMPLE_RATE_HZ, to_pcm
from airhilt.commands import AltitudeCommand
from airhilt.messages import (
    CommandOffer,
    HearingTruth,
    Message,
    MicrophoneAudio,
    SeatNotice,
    Severity,
    SpokenTruth,
    SpokenWords,
    TaskCard,
    Transcript,
    Word,
)
from airhilt.sensors.radio.backends import TextRadio
from airhilt.sensors.radio.hearing import key_chunk
from airhilt.sim import Priority
from airhilt.units import SECOND_NS, seconds_to_ns
from conversations import CLEARANCE, KHZ, READBACK, TOWER, World, line

M = TypeVar("M", bound=Message)
OTHER_KHZ = 121_500


class Sounding(TextRadio):
    """A radio that says to have sound, and keeps none."""

    has_sound = True


class Seated(World):
    """A radio with people at seats."""

    def of(self, model: type[M]) -> list[M]:
        return [each for each in self.published if isinstance(each, model)]

    def notices(self) -> list[str]:
        return [each.text for each in self.of(SeatNotice)]

    def at(self, t_s: float, action: Any) -> None:
        self.director.at(seconds_to_ns(t_s), action, Priority.SCRIPT)

    def says(self, t_s: float, seat: str, text: str, frequency_khz: int | None = None) -> None:
        words = SpokenWords(t_ns=0, text=text, frequency_khz=frequency_khz)
        self.at(t_s, lambda: self.conversation.take_from_seat(key_chunk(seat), words))

    def microphone(self, t_s: float, seat: str, phase: Any, seconds: float = 0.0) -> None:
        pcm = to_pcm(np.full(round(seconds * SAMPLE_RATE_HZ), 0.1, np.float32))
        audio = MicrophoneAudio.model_construct(
            t_ns=0, phase=phase, frequency_khz=None, delay_s=0.0, pcm=pcm
        )
        self.at(t_s, lambda: self.conversation.take_from_seat(key_chunk(seat), audio))


def controller(*lines: dict[Any, Any], **more: Any) -> Seated:
    return Seated(*(lines or (CLEARANCE, READBACK)), seats=[TOWER], **more)


def crew(*lines: dict[Any, Any], **more: Any) -> Seated:
    return Seated(*(lines or (CLEARANCE, READBACK)), seats=["AAL123"], **more)


# --- what the script has for them ---------------------------------------------------------------


def test_a_line_of_a_seat_is_a_task_and_nobody_else_says_it() -> None:
    world = controller().run_until(60.0)
    (card,) = world.of(TaskCard)
    assert (card.line, card.seat, card.addressed) == ("clearance", TOWER, "AAL123")
    assert (card.frequency_khz, card.text, card.is_done) == (KHZ, CLEARANCE["text"], False)
    assert card.t_ns == 10 * SECOND_NS
    assert world.said() == []
    assert world.done == []


def test_what_means_the_same_takes_the_place_of_the_line_and_the_script_goes_on_from_it() -> None:
    world = controller()
    world.says(20.0, TOWER, "American 123, climb flight level 330")
    world.run_until(60.0)
    assert world.said() == ["clearance", "readback"]
    said = world.spoken("clearance")
    assert (said.text, said.addressed) == ("American 123, climb flight level 330", "AAL123")
    ((actor, command, at_s),) = world.done
    assert (actor, command.altitude_ft) == ("AAL123", 33_000.0)
    assert at_s == pytest.approx(said.t_end_ns / SECOND_NS + 2.0)
    opened, done = world.of(TaskCard)
    assert (opened.is_done, done.is_done) == (False, True)
    assert done.t_ns == said.t_end_ns  # Once its addressee has taken it.


@pytest.mark.parametrize(
    "text",
    [
        "American 123, descend flight level 290, turn left heading 090",
        "Delta 456, climb flight level 330",
        "American 123, turn left heading 090",
    ],
)
def test_what_means_something_else_or_is_for_somebody_else_is_a_call_of_its_own(text: str) -> None:
    world = controller()
    world.says(20.0, TOWER, text)
    world.run_until(40.0)
    assert world.said()[0] == f"seat.{key_chunk(TOWER)}.1"
    assert [card.is_done for card in world.of(TaskCard)] == [False]


def test_the_calls_of_a_seat_are_counted_and_make_their_addressee_do_what_they_mean() -> None:
    world = controller()
    world.says(2.0, TOWER, "American 123, turn left heading 090")
    world.says(9.0, TOWER, "American 123, hello")
    world.run_until(60.0)
    chunk = key_chunk(TOWER)
    own = [name for name in world.said() if name.startswith("seat.") and "readback" not in name]
    assert own == [f"seat.{chunk}.1", f"seat.{chunk}.2"]
    ((actor, command, _),) = world.done
    assert (actor, command.action) == ("AAL123", "track")


def test_the_crew_reads_back_what_a_person_says_and_no_line_does() -> None:
    world = controller(CLEARANCE)
    world.says(2.0, TOWER, "American 123, turn left heading 090")
    world.run_until(60.0)
    own = f"seat.{key_chunk(TOWER)}.1"
    assert world.said()[:2] == [own, f"{own}.readback"]
    assert world.spoken(f"{own}.readback").in_reply_to == own


def test_a_person_who_asks_hears_the_last_call_again() -> None:
    world = crew(line("hello", 5, TOWER, "AAL123", "American one two three, good evening."))
    world.says(12.0, "AAL123", "Say again, American 123")
    world.run_until(60.0)
    assert world.said() == ["hello", "seat.AAL123.1", "hello.repeat-1"]
    asked, again = world.spoken("seat.AAL123.1"), world.spoken("hello.repeat-1")
    assert asked.addressed == TOWER
    waited_s = (again.t_tx_ns - asked.t_end_ns) / SECOND_NS
    assert 1.0 <= waited_s <= 3.0


def test_nobody_makes_a_person_say_it_again() -> None:
    """A unit that is asked by a crew about a person's call leaves that to the person."""
    world = controller()
    world.says(2.0, TOWER, "American 123, good evening")
    world.run_until(4.0)
    assert world.said() == [f"seat.{key_chunk(TOWER)}.1"]


def test_where_the_person_leaves_the_script_says_what_waited_and_goes_on_by_itself() -> None:
    world = controller()
    world.at(20.0, lambda: world.conversation.occupy(key_chunk(TOWER), is_taken=False))
    world.run_until(60.0)
    assert world.said() == ["clearance", "readback"]
    assert world.spoken("clearance").t_tx_ns == 20 * SECOND_NS
    assert world.notices() == [f"Nobody is at the seat: the script of {TOWER} goes on by itself."]
    assert [card.is_done for card in world.of(TaskCard)] == [False, True]
    assert not world.conversation.has_person(TOWER)


def test_who_comes_back_has_the_seat_again() -> None:
    world = controller()
    for at_s, is_taken in ((2.0, False), (4.0, True)):
        world.at(
            at_s,
            lambda is_taken=is_taken: world.conversation.occupy(
                key_chunk(TOWER), is_taken=is_taken
            ),
        )
    world.run_until(60.0)
    assert world.conversation.has_person(TOWER)
    assert world.said() == []
    assert len(world.of(TaskCard)) == 1


def test_without_a_frequency_a_person_speaks_on_the_first_one_of_the_seat() -> None:
    elsewhere = line("other", 90, TOWER, "DAL456", "Delta four five six, hello.")
    world = controller(CLEARANCE, elsewhere | {"frequency_khz": OTHER_KHZ})
    world.says(2.0, TOWER, "American 123, hello")
    world.says(8.0, TOWER, "Delta 456, hello", OTHER_KHZ)
    world.run_until(20.0)
    assert [one.frequency_khz for one in world.of(SpokenTruth)] == [KHZ, OTHER_KHZ]


# --- what they hear -----------------------------------------------------------------------------


@pytest.mark.parametrize(("listened", "outcome"), [((KHZ,), "understood"), ((), "missed")])
def test_who_switches_a_frequency_off_hears_nothing_there(
    listened: tuple[int, ...], outcome: str
) -> None:
    world = crew()
    world.at(1.0, lambda: world.conversation.listen("AAL123", listened))
    world.run_until(16.0)
    assert world.hearings("AAL123") == [("clearance", outcome)]


def test_it_is_news_only_if_other_frequencies_are_listened_to_than_before() -> None:
    conversation = crew().conversation
    assert not conversation.listen("AAL123", [KHZ])  # All of its frequencies, at first.
    assert conversation.listen("AAL123", [])
    assert not conversation.listen("AAL123", ())
    assert conversation.listen("AAL123", [KHZ])


def test_no_mistake_is_drawn_for_a_person() -> None:
    """Whatever the noise: a call that comes to the seat counts as heard."""
    world = crew(snr_db=-20.0, squelch_db=-30.0)
    world.run_until(16.0)
    (heard,) = world.of(HearingTruth)
    assert (heard.actor, heard.outcome, heard.text) == ("AAL123", "understood", CLEARANCE["text"])


def test_a_person_whose_call_was_blocked_is_told_so() -> None:
    world = crew(line("over", 20, TOWER, None, "All stations, hello to you all."))  # type: ignore[arg-type]
    world.says(20.0, "AAL123", "Centre, American 123, request descent")
    world.run_until(40.0)
    assert world.notices() == [
        "Your call was blocked: somebody else was on the air at the same time."
    ]


# --- what they are offered ----------------------------------------------------------------------


def test_a_crew_of_people_is_offered_what_an_automaton_would_do() -> None:
    world = crew()
    world.run_until(40.0)
    assert world.done == []
    (offer,) = world.of(CommandOffer)
    assert (offer.seat, offer.call, offer.number) == ("AAL123", "clearance", 1)
    assert isinstance(offer.command, AltitudeCommand)
    assert offer.t_ns == world.spoken("clearance").t_end_ns  # At once: the person decides when.


def test_an_offer_is_over_when_the_person_has_given_the_command_or_has_left() -> None:
    for ends in ("given", "left"):
        world = crew().run_until(40.0)
        (offer,) = world.of(CommandOffer)
        if ends == "given":
            world.conversation.commanded("AAL123", offer.command)
        else:
            world.conversation.occupy("AAL123", is_taken=False)
        opened, over = world.of(CommandOffer)
        assert (opened.is_over, over.is_over, over.number) == (False, True, 1)


# --- their microphones --------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("case", "notice"),
    [
        ("paused", "The run is paused. Nobody hears you."),
        ("silent", "This run has no sound. Type what you want to say."),
        ("gone", "AAL123 is not there any more."),
        ("heard", None),
    ],
)
def test_a_person_who_cannot_be_heard_is_told_why(case: str, notice: str | None) -> None:
    world = crew(READBACK, backend=None if case == "silent" else Sounding(160.0))
    if case == "gone":
        world.actors["AAL123"].body.ended = "collision"
    if case == "paused":
        world.conversation.pause(is_paused=True)
    world.microphone(1.0, "AAL123", "pressed")
    world.microphone(1.5, "AAL123", "samples", 0.5)
    world.microphone(2.0, "AAL123", "released")
    world.run_until(5.0)
    assert world.notices() == ([] if notice is None else [notice])
    spoken = [one for one in world.of(SpokenTruth) if one.is_from_microphone]
    assert [one.id for one in spoken] == ([] if notice else ["microphone.AAL123.1"])


def test_a_pause_releases_every_button_and_after_it_people_speak_again() -> None:
    world = crew(READBACK, backend=Sounding(160.0))
    world.microphone(1.0, "AAL123", "pressed")
    world.at(2.0, lambda: world.conversation.pause(is_paused=True))
    world.at(2.0, lambda: world.conversation.pause(is_paused=False))
    world.microphone(3.0, "AAL123", "pressed")
    world.microphone(4.0, "AAL123", "released")
    world.run_until(6.0)
    first, second = (one for one in world.of(SpokenTruth) if one.is_from_microphone)
    assert (first.t_tx_ns, first.t_end_ns) == (SECOND_NS, 2 * SECOND_NS)
    assert (second.id, second.t_tx_ns) == ("microphone.AAL123.2", 3 * SECOND_NS)


@pytest.mark.parametrize("fed_until_s", [2.0, 30.0])
def test_a_call_without_sound_for_3_s_is_cut(fed_until_s: float) -> None:
    world = crew(READBACK, backend=Sounding(160.0))
    world.microphone(1.0, "AAL123", "pressed")
    at_s = 1.0
    while at_s <= fed_until_s:
        world.microphone(at_s + 0.1, "AAL123", "samples", 0.5)
        at_s += 0.5
    world.run_until(60.0)
    (said,) = (one for one in world.of(SpokenTruth) if one.is_from_microphone)
    silent_s = said.t_end_ns / SECOND_NS - fed_until_s
    assert 3.0 <= silent_s <= 4.2
    assert world.notices() == ["Your call was cut: no sound came for 3 s."]


def test_a_call_of_a_minute_is_cut() -> None:
    world = crew(READBACK, backend=Sounding(160.0))
    world.microphone(1.0, "AAL123", "pressed")
    for tenth in range(15, 900, 5):
        world.microphone(tenth / 10, "AAL123", "samples", 0.5)
    world.run_until(90.0)
    (said,) = (one for one in world.of(SpokenTruth) if one.is_from_microphone)
    assert (said.t_end_ns - said.t_tx_ns) / SECOND_NS == pytest.approx(60.0, abs=0.5)
    assert world.notices() == ["Your call was cut after 60 s."]


# --- what is recognised of them -----------------------------------------------------------------


def recognised(text: str, confidence: float = 1.0, *, seat: str = TOWER) -> Seated:
    """Return a radio on which a person has spoken for two seconds, and what was recognised."""
    late = READBACK | {"at_s": 50.0}
    lines = (CLEARANCE, READBACK) if seat == TOWER else (late,)
    world = Seated(*lines, seats=[seat], backend=Sounding(160.0))
    world.microphone(12.0, seat, "pressed")
    world.microphone(13.0, seat, "samples", 0.5)
    world.microphone(14.0, seat, "released")
    words = transcript(text, confidence, seat)
    for at_s in (15.0, 16.0):  # Only the first time counts.
        world.at(at_s, lambda: world.conversation.take(f"asr/{KHZ}", words, b""))
    return world.run_until(60.0)


def transcript(text: str, confidence: float, seat: str = TOWER) -> Transcript:
    """Return what was recognised of what a seat said from 12 s to 14 s."""
    return Transcript(
        t_ns=0, id=f"microphone.{key_chunk(seat)}.1", frequency_khz=KHZ, text=text,
        t_tx_ns=12 * SECOND_NS, t_end_ns=14 * SECOND_NS, confidence=confidence, engine="test",
        words=tuple(Word(text=each, confidence=confidence) for each in text.split()),
    )  # fmt: skip


def test_what_was_recognised_surely_is_done() -> None:
    world = recognised("american one two three climb flight level three three zero")
    assert [command.altitude_ft for _, command, _ in world.done] == [33_000.0]
    assert world.hearings("AAL123")[0][1] == "understood"
    assert [card.is_done for card in world.of(TaskCard)] == [False, True]


@pytest.mark.parametrize(
    ("text", "confidence"),
    [
        ("american one two three climb flight level three three zero", 0.79),
        ("climb flight level three three zero", 1.0),
        ("", 1.0),
    ],
)
def test_who_is_not_sure_of_what_was_recognised_asks_again(text: str, confidence: float) -> None:
    """The addressee of the open task is not sure that it was for it."""
    world = recognised(text, confidence)
    assert world.done == []
    assert world.hearings("AAL123")[0][1] == "unsure"
    assert any("say-again" in name for name in world.said())


def test_without_a_task_words_that_name_nobody_are_for_the_only_crew_on_the_frequency() -> None:
    """With several crews there, they are for none of them."""
    for others, outcomes in (((), ["unsure"]), (("DAL456",), [])):
        crews = [line(f"hello-{name}", 50, name, TOWER, "Hello.") for name in ("AAL123", *others)]
        world = Seated(*crews, seats=[TOWER], backend=Sounding(160.0))
        world.microphone(12.0, TOWER, "pressed")
        world.microphone(14.0, TOWER, "released")
        words = transcript("climb flight level three three zero", 1.0)
        take = partial(world.conversation.take, f"asr/{KHZ}", words, b"")
        world.at(15.0, take)
        world.run_until(40.0)
        assert [outcome for _, outcome in world.hearings("AAL123")] == outcomes


@pytest.mark.parametrize(
    ("text", "outcome"),
    [
        ("american one two three climbing flight level three three zero", "understood"),
        ("climbing flight level three three zero", "unsure"),  # Nobody knows whose it is.
    ],
)
def test_a_crew_always_calls_its_unit(text: str, outcome: str) -> None:
    world = recognised(text, seat="AAL123")
    heard = [one for one in world.of(HearingTruth) if one.actor == TOWER]
    assert (heard[0].id, heard[0].outcome) == ("microphone.AAL123.1", outcome)


# --- what they are told -------------------------------------------------------------------------


def test_a_seat_is_told_what_it_has() -> None:
    world = Seated(CLEARANCE, READBACK, seats=[TOWER, "AAL123"], backend=Sounding(160.0))
    told = {
        info.seat: info
        for info in world.conversation.infos(
            is_recognised=True, voice_is_recorded=False, may_pause=True,
            spoken_from=Severity.CAUTION,
        )
    }  # fmt: skip
    crew_of, unit = told["AAL123"], told[TOWER]
    spec = next(each for each in world.scenario.actors if each.callsign == "AAL123")
    assert (crew_of.category, crew_of.icao24) == ("aircraft", spec.icao24)
    assert crew_of.recipients == ("AAL123", spec.icao24)
    assert (unit.category, unit.icao24) == ("unit", None)
    assert unit.recipients[0] == TOWER
    for info in told.values():
        assert info.frequencies_khz == (KHZ,)
        assert (info.has_sound, info.is_recognised, info.voice_is_recorded) == (True, True, False)
        assert (info.may_pause, info.longest_call_s) == (True, 60.0)
        assert info.spoken_from is Severity.CAUTION
        assert not info.has_own_receiver
