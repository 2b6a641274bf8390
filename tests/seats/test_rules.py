"""Rules of a seat: who may act there, and what is refused with which reason."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter

from airhilt.messages import SeatAct, SeatAction, SeatState, WorkloadQuestion
from airhilt.seats import Seats
from airhilt.sim import Director, Virtual
from seats import state_of

ACT: TypeAdapter[SeatAct] = TypeAdapter(SeatAct)
KEY = "seat/TOWER/do"
SECRET = "a secret of one person"
SPEAK, TYPE = {"do": "press"}, {"do": "text", "text": "hello"}
ALL = {"do": "agree", "uses": ["voice", "words"]}
WORDS = {"do": "agree", "uses": ["words"]}


class Room:
    """The seats of a run, at which acts count once they are not refused."""

    def __init__(self, *states: SeatState) -> None:
        self.published: list[SeatState] = []
        self.seats = Seats(
            states or (state_of("TOWER"),),
            lambda _key, state: self.published.append(state),
            Director(Virtual()),
        )
        self.seats.open()

    def act(self, act: dict[str, Any], *, secret: str = SECRET, holder: str = "one") -> str:
        """Return why an act is refused; let it count if it is not."""
        action = SeatAction(holder=holder, secret=secret, act=ACT.validate_python(act))
        why = self.seats.refusal(KEY, action)
        if not why:
            self.seats.note_secret(KEY, action)
            self.seats.take(KEY, action.model_copy(update={"secret": ""}), b"")
        return why

    def after(self, *acts: dict[str, Any]) -> str:
        """Return why the last of some acts is refused; the others are not."""
        *before, last = acts
        assert [self.act(act) for act in before] == [""] * len(before)
        return self.act(last)

    @property
    def state(self) -> SeatState:
        return self.published[-1]


TAKE = {"do": "take"}


def test_a_seat_is_held_until_it_is_left_and_agreements_end_with_it() -> None:
    room = Room()
    assert room.after(TAKE, ALL) == ""
    assert (room.state.phase, room.state.holder) == ("taken", "one")
    assert room.state.uses == ("voice", "words")
    assert room.act({"do": "leave"}) == ""
    assert (room.state.phase, room.state.holder, room.state.uses) == ("left", None, ())
    assert room.after(TAKE, TYPE) == "you have not agreed to the use of what you type"


def test_of_two_who_take_a_seat_the_first_has_it() -> None:
    room = Room()
    assert room.act(TAKE) == ""
    other = {"secret": "a secret of another person", "holder": "two"}
    assert room.act(TAKE, **other) == "somebody has the seat TOWER already"
    for act in (ALL, TYPE, {"do": "leave"}):
        assert room.act(act, **other) == "somebody else has the seat TOWER"
    assert room.state.holder == "one"


def test_who_comes_back_with_the_secret_has_the_seat_as_it_was() -> None:
    """The old token ends after the new one is there: that does not end the hold."""
    room = Room()
    room.after(TAKE, ALL)
    assert room.act(TAKE, holder="again") == ""
    assert room.state.uses == ("voice", "words")
    assert room.act(TYPE) == "somebody else has the seat TOWER"
    assert not room.seats.ends_hold(KEY, "one")
    assert room.act(TYPE, holder="again") == ""
    assert room.seats.ends_hold(KEY, "again")


def test_a_token_that_has_ended_is_of_no_use_any_more() -> None:
    room = Room()
    assert not room.seats.ends_hold(KEY, "one")
    assert "has ended" in room.act(TAKE)


@pytest.mark.parametrize("secret", ["", "short", "a wrong secret, but long"])
def test_an_act_with_a_wrong_secret_is_refused(secret: str) -> None:
    room = Room()
    assert room.act(TAKE) == ""
    for act in (TYPE, ALL, {"do": "leave"}):
        assert room.act(act, secret=secret) == "somebody else has the seat TOWER"


def test_a_seat_is_not_taken_with_a_secret_that_can_be_guessed() -> None:
    assert "at least 16 characters" in Room().act(TAKE, secret="0123456789")


@pytest.mark.parametrize("act", [TYPE, SPEAK, ALL, {"do": "leave"}, {"do": "pace", "factor": 0}])
def test_nobody_acts_at_a_seat_that_is_free(act: dict[str, Any]) -> None:
    assert Room().act(act) == "nobody has the seat TOWER; take it first"


def test_there_is_nothing_to_do_at_a_seat_that_is_not_there() -> None:
    room = Room()
    action = SeatAction(holder="one", secret=SECRET, act=ACT.validate_python(TAKE))
    assert room.seats.refusal("seat/GROUND/do", action) == "no seat of this run; expected TOWER"


@pytest.mark.parametrize(
    ("agreed", "act", "refused"),
    [
        (None, TYPE, True), (None, SPEAK, True), (WORDS, TYPE, False), (WORDS, SPEAK, True),
        (ALL, TYPE, False), (ALL, SPEAK, False), ({"do": "agree", "uses": []}, TYPE, True),
    ],
)  # fmt: skip
def test_voice_and_words_are_refused_unless_they_are_agreed_to(
    agreed: dict[str, Any] | None, act: dict[str, Any], refused: bool
) -> None:
    acts = [TAKE, *([] if agreed is None else [agreed]), act]
    assert ("have not agreed" in Room().after(*acts)) is refused


PIECE = {"do": "say", "pcm": "AAA="}


@pytest.mark.parametrize(
    ("before", "act", "reason"),
    [
        ([ALL], PIECE, "your call was cut"),
        ([ALL, SPEAK, {"do": "release"}], PIECE, "your call was cut"),
        ([ALL, SPEAK, WORDS], PIECE, "you have not agreed to the use of your voice"),
        ([ALL, SPEAK, WORDS, ALL], PIECE, "your call was cut"),
        ([ALL, SPEAK, {"do": "release"}, SPEAK], PIECE, ""),
        ([], {"do": "tune", "frequencies_khz": [121_700]}, "your seat does not have that freq"),
        ([], {"do": "fly", "command": {"action": "go_around"}}, "the seat of a unit flies"),
        ([], {"do": "answer", "question": 1, "isa": 3}, "question 1 is not open at this seat"),
        ([], {"do": "pace", "factor": 0.0}, ""),
    ],
)
def test_what_makes_no_sense_now_is_refused_with_the_reason(
    before: list[dict[str, Any]], act: dict[str, Any], reason: str
) -> None:
    why = Room().after(TAKE, *before, act)
    assert why.startswith(reason)
    assert bool(why) == bool(reason)


@pytest.mark.parametrize(
    ("facts", "act", "reason"),
    [
        ({"may_pause": False}, {"do": "pace", "factor": 1.0}, "no pause and no slow motion"),
        ({"has_sound": False}, SPEAK, "no sound; type what you want to say"),
        ({"pace": "paused"}, SPEAK, "the run is paused; nobody hears you"),
    ],
)
def test_what_the_run_does_not_have_is_refused(
    facts: dict[str, Any], act: dict[str, Any], reason: str
) -> None:
    assert Room(state_of("TOWER", **facts)).after(TAKE, ALL, act).endswith(reason)


def test_a_call_that_was_cut_is_told_to_who_goes_on_speaking() -> None:
    room = Room()
    room.after(TAKE, ALL, SPEAK)
    room.seats.cut("TOWER", "Your call was cut after 60 s.")
    assert room.act(PIECE) == "your call was cut"
    assert room.state.notice is not None
    assert room.state.notice.text == "Your call was cut after 60 s."


def test_a_question_is_answered_once_by_who_is_asked() -> None:
    room = Room()
    room.after(TAKE)
    room.seats.ask("TOWER", WorkloadQuestion(number=2, scale="isa", asked_ns=0))
    assert "question 1 is not open" in room.act({"do": "answer", "question": 1, "isa": 3})
    assert room.act({"do": "answer", "question": 2, "isa": 3}) == ""
    assert room.state.question is None
    assert "question 2 is not open" in room.act({"do": "answer", "question": 2, "isa": 5})


ANY_ACT = st.sampled_from(
    [TAKE, {"do": "leave"}, ALL, WORDS, {"do": "agree", "uses": []}, SPEAK, PIECE, TYPE,
     {"do": "release"}]
)  # fmt: skip


@given(st.lists(st.tuples(ANY_ACT, st.sampled_from(["one", "two"])), max_size=30))
def test_no_word_counts_of_who_has_not_taken_the_seat_and_agreed(
    acts: list[tuple[dict[str, Any], str]],
) -> None:
    """Two people act in any order; each has another secret."""
    room, holder, uses = Room(), None, frozenset[str]()
    for act, who in acts:
        why = room.act(act, secret=f"the secret of {who}", holder=who)
        if act["do"] == "take" and holder in (None, who):
            uses = uses if holder == who else frozenset()
            holder = who
        elif holder == who and act["do"] == "agree":
            uses = frozenset(act["uses"])
        elif holder == who and act["do"] == "leave":
            holder, uses = None, frozenset()
        needed = {"press": {"voice"}, "say": {"voice"}}.get(act["do"], set())
        if not why:
            assert act["do"] in ("take", "leave") or holder == who
            assert needed <= uses
            assert act["do"] != "text" or uses
        assert room.state.holder == holder
        assert set(room.state.uses) == uses
