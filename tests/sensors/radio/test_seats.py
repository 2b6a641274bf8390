"""People at seats: what the script has for them, what they say, and what they are offered."""

from __future__ import annotations

from functools import partial
from typing import Any, TypeVar

import numpy as np
import pytest

from airhilt.audio.pcm import SAMPLE_RATE_HZ, to_pcm
from airhilt.commands import AltitudeCommand, TrackCommand
from airhilt.messages import (
    CommandOffer,
    HearingTruth,
    LeaveSeat,
    Message,
    PressToTalk,
    ReleaseToTalk,
    SayText,
    SayVoice,
    SeatAct,
    SeatAction,
    SeatState,
    SpokenTruth,
    TakeSeat,
    TaskCard,
    Transcript,
    TuneFrequencies,
    Word,
    key_chunk,
)
from airhilt.seats.seats import MOST_OFFERS
from airhilt.sensors.radio.backends import TextRadio
from airhilt.sim import Priority
from airhilt.units import SECOND_NS, seconds_to_ns
from conversations import CLEARANCE, KHZ, READBACK, TOWER, World, line
from seats import once

M = TypeVar("M", bound=Message)
OTHER_KHZ = 121_500


class Sounding(TextRadio):
    """A radio that says to have sound, and keeps none."""

    has_sound = True


class Seated(World):
    """A radio with people at seats."""

    def of(self, model: type[M]) -> list[M]:
        return [each for each in self.published if isinstance(each, model)]

    def states(self, seat: str = TOWER) -> list[SeatState]:
        return [state for state in self.of(SeatState) if state.seat == seat]

    def cards(self, seat: str = TOWER) -> list[TaskCard]:
        """Return the task cards that a seat has had, each once."""
        return once(card for state in self.states(seat) for card in state.tasks)

    def offers(self, seat: str) -> list[CommandOffer]:
        return once(offer for state in self.states(seat) for offer in state.offers)

    def notices(self, seat: str = TOWER) -> list[str]:
        told = once(state.notice for state in self.states(seat))
        return [notice.text for notice in told if notice is not None]

    def at(self, t_s: float, action: Any) -> Seated:
        self.director.at(seconds_to_ns(t_s), action, Priority.SCRIPT)
        return self

    def act(self, t_s: float, seat: str, act: SeatAct) -> Seated:
        key, action = f"seat/{key_chunk(seat)}/do", SeatAction(holder="somebody", act=act)
        self.at(t_s, lambda: self.seats.take(key, action, b""))
        return self.at(t_s, lambda: self.conversation.take(key, action, b""))

    def says(self, t_s: float, seat: str, text: str, frequency_khz: int | None = None) -> Seated:
        return self.act(t_s, seat, SayText(text=text, frequency_khz=frequency_khz))

    def speaks(self, begin_s: float, end_s: float, seat: str) -> Seated:
        """Hold the button of a seat, and give it sound all the while."""
        self.act(begin_s, seat, PressToTalk())
        self.feeds(begin_s, end_s, seat)
        return self.act(end_s, seat, ReleaseToTalk())

    def feeds(self, begin_s: float, end_s: float, seat: str) -> None:
        pcm = to_pcm(np.full(SAMPLE_RATE_HZ // 2, 0.1, np.float32))
        for half in range(1, round(2 * (end_s - begin_s)) + 1):
            self.act(begin_s + half / 2, seat, SayVoice.model_construct(pcm=pcm))


def controller(*lines: dict[Any, Any], **more: Any) -> Seated:
    return Seated(*(lines or (CLEARANCE, READBACK)), seats=[TOWER], **more)


def crew(*lines: dict[Any, Any], **more: Any) -> Seated:
    return Seated(*(lines or (CLEARANCE, READBACK)), seats=["AAL123"], **more)


# --- what the script has for them ---------------------------------------------------------------


def test_a_line_of_a_seat_is_a_task_and_nobody_else_says_it() -> None:
    world = controller().run_until(60.0)
    (card,) = world.states()[-1].tasks
    assert (card.line, card.addressed) == ("clearance", "AAL123")
    assert (card.frequency_khz, card.text) == (KHZ, CLEARANCE["text"])
    assert card.due_ns == 10 * SECOND_NS
    assert world.said() == []
    assert world.done == []


def test_what_means_the_same_takes_the_place_of_the_line_and_the_script_goes_on_from_it() -> None:
    world = controller().says(20.0, TOWER, "American 123, climb flight level 330").run_until(60.0)
    assert world.said() == ["clearance", "readback"]
    said = world.spoken("clearance")
    assert (said.text, said.addressed) == ("American 123, climb flight level 330", "AAL123")
    ((actor, command, at_s),) = world.done
    assert (actor, command.altitude_ft) == ("AAL123", 33_000.0)
    assert at_s == pytest.approx(said.t_end_ns / SECOND_NS + 2.0)
    assert len(world.cards()) == 1
    last = world.states()[-1]
    assert (last.tasks, last.t_ns) == ((), said.t_end_ns)  # Once its addressee has taken it.


@pytest.mark.parametrize(
    "text",
    [
        "American 123, descend flight level 290, turn left heading 090",
        "Delta 456, climb flight level 330",
        "American 123, turn left heading 090",
    ],
)
def test_what_means_something_else_or_is_for_somebody_else_is_a_call_of_its_own(text: str) -> None:
    world = controller().says(20.0, TOWER, text).run_until(40.0)
    assert world.said()[0] == f"seat.{key_chunk(TOWER)}.1"
    assert len(world.states()[-1].tasks) == 1


def test_the_calls_of_a_seat_are_counted_and_make_their_addressee_do_what_they_mean() -> None:
    world = controller().says(2.0, TOWER, "American 123, turn left heading 090")
    world.says(9.0, TOWER, "American 123, hello").run_until(60.0)
    chunk = key_chunk(TOWER)
    own = [name for name in world.said() if name.startswith("seat.") and "readback" not in name]
    assert own == [f"seat.{chunk}.1", f"seat.{chunk}.2"]
    ((actor, command, _),) = world.done
    assert (actor, command.action) == ("AAL123", "track")


def test_the_crew_reads_back_what_a_person_says_and_no_line_does() -> None:
    world = controller(CLEARANCE).says(2.0, TOWER, "American 123, turn left heading 090")
    world.run_until(60.0)
    own = f"seat.{key_chunk(TOWER)}.1"
    assert world.said()[:2] == [own, f"{own}.readback"]
    assert world.spoken(f"{own}.readback").in_reply_to == own


def test_a_person_who_asks_hears_the_last_call_again() -> None:
    world = crew(line("hello", 5, TOWER, "AAL123", "American one two three, good evening."))
    world.says(12.0, "AAL123", "Say again, American 123").run_until(60.0)
    assert world.said() == ["hello", "seat.AAL123.1", "hello.repeat-1"]
    asked, again = world.spoken("seat.AAL123.1"), world.spoken("hello.repeat-1")
    assert asked.addressed == TOWER
    waited_s = (again.t_tx_ns - asked.t_end_ns) / SECOND_NS
    assert 1.0 <= waited_s <= 3.0


def test_nobody_makes_a_person_say_it_again() -> None:
    """A unit that is asked by a crew about a person's call leaves that to the person."""
    world = controller().says(2.0, TOWER, "American 123, good evening").run_until(4.0)
    assert world.said() == [f"seat.{key_chunk(TOWER)}.1"]


def test_where_the_person_leaves_the_script_says_what_waited_and_goes_on_by_itself() -> None:
    world = controller().act(20.0, TOWER, LeaveSeat()).run_until(60.0)
    assert world.said() == ["clearance", "readback"]
    assert world.spoken("clearance").t_tx_ns == 20 * SECOND_NS
    assert world.notices() == [f"Nobody is at the seat: the script of {TOWER} goes on by itself."]
    assert len(world.cards()) == 1
    assert world.states()[-1].tasks == ()


def test_who_comes_back_has_the_seat_again() -> None:
    world = controller().act(2.0, TOWER, LeaveSeat()).act(4.0, TOWER, TakeSeat()).run_until(60.0)
    assert world.said() == []
    assert len(world.cards()) == 1


def test_a_unit_that_calls_nobody_on_the_frequency_is_told_so() -> None:
    world = Seated(CLEARANCE, READBACK, seats=[TOWER])
    world.says(2.0, TOWER, "Speedbird one, line up and wait runway one").run_until(9.0)
    assert any("Nobody answers" in text for text in world.notices(TOWER))


def test_without_a_frequency_a_person_speaks_on_the_first_one_of_the_seat() -> None:
    elsewhere = line("other", 90, TOWER, "DAL456", "Delta four five six, hello.")
    world = controller(CLEARANCE, elsewhere | {"frequency_khz": OTHER_KHZ})
    world.says(2.0, TOWER, "American 123, hello").says(8.0, TOWER, "Delta 456, hello", OTHER_KHZ)
    world.run_until(20.0)
    assert [one.frequency_khz for one in world.of(SpokenTruth)] == [KHZ, OTHER_KHZ]


# --- what they hear -----------------------------------------------------------------------------


@pytest.mark.parametrize(("listened", "outcome"), [((KHZ,), "understood"), ((), "missed")])
def test_who_switches_a_frequency_off_hears_nothing_there(
    listened: tuple[int, ...], outcome: str
) -> None:
    world = crew().act(1.0, "AAL123", TuneFrequencies(frequencies_khz=listened)).run_until(16.0)
    assert world.hearings("AAL123") == [("clearance", outcome)]


def test_no_mistake_is_drawn_for_a_person() -> None:
    """Whatever the noise: a call that comes to the seat counts as heard."""
    world = crew(snr_db=-20.0, squelch_db=-30.0).run_until(16.0)
    (heard,) = world.of(HearingTruth)
    assert (heard.actor, heard.outcome, heard.text) == ("AAL123", "understood", CLEARANCE["text"])


def test_a_person_whose_call_was_blocked_is_told_so() -> None:
    world = crew(line("over", 20, TOWER, None, "All stations, hello to you all."))  # type: ignore[arg-type]
    world.says(20.0, "AAL123", "Center, American 123, request descent").run_until(40.0)
    assert world.notices("AAL123") == [
        "Your call was blocked: somebody else was on the air at the same time."
    ]


# --- what they are offered ----------------------------------------------------------------------


def test_a_crew_of_people_is_offered_what_an_automaton_would_do() -> None:
    world = crew().run_until(40.0)
    assert world.done == []
    (offer,) = world.offers("AAL123")
    assert (offer.call, offer.number) == ("clearance", 1)
    assert isinstance(offer.command, AltitudeCommand)
    offered = next(state for state in world.states("AAL123") if state.offers)
    # At once: the person decides when.
    assert offered.t_ns == world.spoken("clearance").t_end_ns


def test_an_offer_is_over_when_the_person_has_given_the_command_or_has_left() -> None:
    for ends in ("given", "left"):
        world = crew()
        if ends == "left":
            world.act(35.0, "AAL123", LeaveSeat())
        world.run_until(40.0)
        (offer,) = world.offers("AAL123")
        if ends == "given":
            world.seats.end_offer("AAL123", offer.command)
        assert world.states("AAL123")[-1].offers == ()


def test_the_newest_commands_are_offered_each_once() -> None:
    world = Seated(CLEARANCE, seats=["AAL123", "DAL456"])
    tracks = [TrackCommand(action="track", track_deg=float(deg)) for deg in range(MOST_OFFERS + 1)]
    for command in (*tracks, tracks[-2]):
        world.seats.offer("AAL123", "a-call", command)
    world.seats.offer("DAL456", "a-call", tracks[0])
    left = [one.command for one in world.states("AAL123")[-1].offers]
    assert left == [*tracks[1:-2], tracks[-1], tracks[-2]]
    assert len(world.states("DAL456")[-1].offers) == 1


# --- their microphones --------------------------------------------------------------------------


def test_a_person_whose_aircraft_is_no_more_is_told_that_nobody_hears() -> None:
    world = crew(READBACK, backend=Sounding(160.0))
    world.actors["AAL123"].body.ended = "collision"
    world.speaks(1.0, 2.0, "AAL123").run_until(5.0)
    assert world.notices("AAL123") == ["AAL123 is not there any more."]
    assert not [one for one in world.of(SpokenTruth) if one.is_from_microphone]


def test_a_pause_releases_every_button_and_after_it_people_speak_again() -> None:
    world = crew(READBACK, backend=Sounding(160.0)).act(1.0, "AAL123", PressToTalk())
    world.at(2.0, world.conversation.pause)
    world.speaks(3.0, 4.0, "AAL123").run_until(6.0)
    first, second = (one for one in world.of(SpokenTruth) if one.is_from_microphone)
    assert (first.t_tx_ns, first.t_end_ns) == (SECOND_NS, 2 * SECOND_NS)
    assert (second.id, second.t_tx_ns) == ("microphone.AAL123.2", 3 * SECOND_NS)


@pytest.mark.parametrize("fed_until_s", [2.0, 30.0])
def test_a_call_without_sound_for_3_s_is_cut(fed_until_s: float) -> None:
    world = crew(READBACK, backend=Sounding(160.0)).act(1.0, "AAL123", PressToTalk())
    world.feeds(1.0, fed_until_s, "AAL123")
    world.run_until(60.0)
    (said,) = (one for one in world.of(SpokenTruth) if one.is_from_microphone)
    silent_s = said.t_end_ns / SECOND_NS - fed_until_s
    assert 3.0 <= silent_s <= 4.2
    assert world.notices("AAL123") == ["Your call was cut: no sound came for 3 s."]


def test_a_call_of_a_minute_is_cut() -> None:
    world = crew(READBACK, backend=Sounding(160.0)).act(1.0, "AAL123", PressToTalk())
    world.feeds(1.0, 90.0, "AAL123")
    world.run_until(90.0)
    (said,) = (one for one in world.of(SpokenTruth) if one.is_from_microphone)
    assert (said.t_end_ns - said.t_tx_ns) / SECOND_NS == pytest.approx(60.0, abs=0.5)
    assert world.notices("AAL123") == ["Your call was cut after 60 s."]


# --- what is recognised of them -----------------------------------------------------------------


def recognised(text: str, confidence: float = 1.0, *, seat: str = TOWER) -> Seated:
    """Return a radio on which a person has spoken for two seconds, and what was recognised."""
    late = READBACK | {"at_s": 50.0}
    lines = (CLEARANCE, READBACK) if seat == TOWER else (late,)
    world = Seated(*lines, seats=[seat], backend=Sounding(160.0)).speaks(12.0, 14.0, seat)
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
    assert world.cards()
    assert world.states()[-1].tasks == ()


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


def test_of_several_crews_the_one_that_heard_its_callsign_asks_for_unsure_words_again() -> None:
    everybody = line("all", 5, TOWER, "", "All stations, information kilo.") | {"to": None}
    hello = line("hello", 50, "AAL123", TOWER, "Hello.")
    world = Seated(everybody, hello, seats=[TOWER], backend=Sounding(160.0), strangers=("DAL456",))
    world.speaks(12.0, 14.0, TOWER)
    words = transcript("american one two three contact ground", 0.79)
    world.at(15.0, partial(world.conversation.take, f"asr/{KHZ}", words, b"")).run_until(40.0)
    assert [outcome for _, outcome in world.hearings("AAL123")] == ["unsure"]
    assert any("say-again" in name for name in world.said())


def test_without_a_task_words_that_name_nobody_are_for_the_only_crew_on_the_frequency() -> None:
    """With several crews there, they are for none of them."""
    hello = line("hello", 50, "AAL123", TOWER, "Hello.")
    others = ("DAL456", "UAL88", "BAW21", "DLH9")
    for strangers, outcomes in ((others, ["unsure"]), ((), [])):
        world = Seated(hello, seats=[TOWER], backend=Sounding(160.0), strangers=strangers)
        world.speaks(12.0, 14.0, TOWER)
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
