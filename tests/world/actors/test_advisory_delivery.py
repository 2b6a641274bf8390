"""Actors react to an advisory once they have read it, or heard its instruction to the end."""

from __future__ import annotations

from functools import partial
from types import SimpleNamespace
from typing import Any, cast

import pytest

from airhilt.messages import (
    Advisory,
    AdvisoryAudio,
    EquipmentAlert,
    Evidence,
    LeaveSeat,
    MaintainLevel,
    SeatAction,
    Severity,
    Turn,
)
from airhilt.seats import Seats
from airhilt.sim import Director, Priority, Virtual
from airhilt.units import SECOND_NS, seconds_to_ns
from airhilt.world.actors.actor import Reaction, Unable
from airhilt.world.actors.advisory_delivery import AdvisoryDelivery


class Crew:
    """Reacts to everything after two seconds."""

    category = "aircraft"

    def __init__(self, unable: bool = False, responds: bool = True) -> None:
        self.spec = SimpleNamespace(callsign="AAL123", icao24="a1b2c3")
        self.body = SimpleNamespace(ended=None)
        self.heard: list[tuple[int, bool]] = []
        self.unable = unable
        self.responds = responds

    def hear(self, advisory: Advisory, channel: str) -> Reaction:
        self.heard.append((advisory.revision, advisory.active))
        if not self.responds:
            return Reaction.none("turn")
        return Reaction(2.0, self.act, "follows turn")

    def act(self) -> bool:
        if self.unable:
            raise Unable("unable to turn")
        return True


def advisory(
    revision: int = 0, severity: str = "WARNING", active: bool = True, recipient: str = "AAL123"
) -> Advisory:
    return Advisory(
        id="d-1", revision=revision, recipient=recipient, recipients=(recipient,),
        kind="runway_conflict", severity=Severity(severity), active=active, traffic=("AAL123",),
        message="turn", recommendation=Turn(degrees=-20.0), evidence=Evidence(sources=("adsb",)),
        t_ready_ns=0,
    )  # fmt: skip


FIRST = "turn left 20 degrees traffic four miles!"
"""Text whose instruction ends in its middle."""
LAST = "traffic four miles! turn left 20 degrees"


def audio(
    revision: int = 0,
    recipient: str = "AAL123",
    text: str = FIRST,
    word_ends: tuple[int, ...] = (),
) -> AdvisoryAudio:
    """Return a voice of four seconds."""
    return AdvisoryAudio(
        id="d-1", revision=revision, recipient=recipient, text=text, t_dec_ns=0, engine="test",
        samples=64_000, word_ends=word_ends, sha256="",
    )  # fmt: skip


class Told:
    def __init__(
        self,
        *messages: tuple[Any, ...],
        voiced: bool = True,
        lost_at_s: float | None = None,
        unable: bool = False,
        responds: bool = True,
    ) -> None:
        """Take in messages, each at its time in seconds, and let the crew react."""
        director = Director(Virtual())
        self.crew = Crew(unable, responds)
        self.events: list[tuple[str, str, str, float]] = []
        self.told: list[tuple[str, ...]] = []

        def event(kind: str, subject: str, text: str) -> None:
            self.events.append((kind, subject, text, director.now_ns / SECOND_NS))

        delivery = AdvisoryDelivery(
            director,
            {"AAL123": cast(Any, self.crew)},
            event,
            lambda *told: self.told.append(told),
            is_voiced=voiced,
            seats=Seats((), lambda _key, _state: None, director),
        )
        for at_s, message in messages:
            director.at(
                seconds_to_ns(at_s),
                lambda message=message: delivery.take("", message, b""),  # type: ignore[misc]
                Priority.RESULT,
            )
        if lost_at_s is not None:
            director.at(seconds_to_ns(lost_at_s), delivery.voice_lost, Priority.RESULT)
        director.run()

    @property
    def reacted_s(self) -> list[float]:
        return [at_s for kind, *_, at_s in self.events if kind == "pilot_reacts"]


def test_without_a_voice_an_advisory_is_read_as_it_is_decided() -> None:
    told = Told((10.0, advisory()), voiced=False)
    assert told.events == [("pilot_reacts", "AAL123", "follows turn (d-1)", 12.0)]


def test_a_spoken_advisory_is_heard_when_its_instruction_has_been_said() -> None:
    assert Told((10.0, advisory()), (11.0, audio())).reacted_s == [15.0]
    assert Told((10.0, advisory()), (11.0, audio(text=LAST))).reacted_s == [17.0]


def test_the_times_of_words_count_where_the_voice_gives_them() -> None:
    ends = tuple(8_000 * (n + 1) for n in range(7))
    assert Told((10.0, advisory()), (11.0, audio(word_ends=ends))).reacted_s == [15.0]
    assert Told((10.0, advisory()), (11.0, audio(word_ends=(1, 2, 3, 4, 5, 6, 7)))).reacted_s == [
        pytest.approx(13.0, abs=0.001)
    ]


def test_words_in_which_no_instruction_is_found_are_heard_to_their_end() -> None:
    assert Told((10.0, advisory()), (11.0, audio(text="look out"))).reacted_s == [17.0]


@pytest.mark.parametrize("severity", ["INFO", "ADVISORY"])
def test_what_is_not_spoken_is_read(severity: str) -> None:
    assert Told((10.0, advisory(severity=severity))).reacted_s == [12.0]


def test_what_is_over_is_read_and_its_voice_comes_too_late() -> None:
    told = Told((10.0, advisory()), (10.5, advisory(revision=1, active=False)), (11.0, audio()))
    assert told.crew.heard == [(1, False)]


def test_a_revision_that_comes_while_another_is_spoken_is_heard_after_it() -> None:
    told = Told((10.0, advisory()), (11.0, audio()), (12.0, advisory(revision=1)), (14.0, audio(1)))
    assert told.crew.heard == [(0, True), (1, True)]
    assert told.reacted_s == [15.0, 18.0]


def test_what_is_superseded_before_it_was_done_is_not_done() -> None:
    messages = [(10.0, advisory()), (11.0, advisory(1)), (11.5, advisory(2))]
    assert Told(*messages, voiced=False).reacted_s == [13.5]
    over = (11.9, advisory(3, active=False))
    assert Told(*messages, over, voiced=False).reacted_s == [13.9]


def test_what_is_over_before_its_instruction_has_been_said_is_not_acted_upon() -> None:
    told = Told((10.0, advisory()), (11.0, audio()), (12.0, advisory(revision=1, active=False)))
    assert told.crew.heard == [(1, False)]


def test_a_revision_of_which_a_later_one_was_heard_is_not_heard_any_more() -> None:
    told = Told((10.0, advisory()), (10.5, advisory(revision=1)), (11.0, audio(1)), (12.0, audio()))
    assert told.crew.heard == [(1, True)]


def test_what_is_being_said_when_the_voice_is_lost_is_heard_to_its_end() -> None:
    assert Told((10.0, advisory()), (11.0, audio()), lost_at_s=12.0).reacted_s == [15.0]


def test_when_the_voice_is_lost_what_waited_for_it_is_read() -> None:
    told = Told((10.0, advisory()), (15.0, advisory(revision=1)), lost_at_s=12.0)
    assert told.reacted_s == [14.0, 17.0]


def test_an_advisory_reaches_a_crew_by_its_address() -> None:
    told = Told((1.0, advisory(recipient="a1b2c3")), (2.0, audio(recipient="a1b2c3")))
    assert told.reacted_s == [6.0]


def test_an_advisory_for_somebody_else_reaches_nobody() -> None:
    assert Told((1.0, advisory(recipient="ATC")), voiced=False).events == []


def test_what_cannot_be_done_is_told() -> None:
    told = Told((1.0, advisory()), voiced=False, unable=True)
    assert told.events == [("unable", "AAL123", "unable to turn", 3.0)]


def test_who_does_not_respond_is_told_of_once() -> None:
    told = Told((1.0, advisory()), (2.0, advisory(1)), voiced=False, responds=False)
    assert told.events == [("no_response", "AAL123", "does not respond to turn (d-1)", 1.0)]


def equipment(revision: int = 0, active: bool = True, tells: bool = True) -> EquipmentAlert:
    level = MaintainLevel(altitude_ft=35_000.0) if tells else None
    update = {"id": "e-1", "recommendation": level}
    return EquipmentAlert(
        equipment="tcas", advisory=advisory(revision, active=active).model_copy(update=update)
    )


def test_an_alert_of_equipment_needs_no_voice_of_the_assistant() -> None:
    told = Told((1.0, equipment()))
    assert told.events == [("pilot_reacts", "AAL123", "follows turn (e-1)", 3.0)]


def test_the_assistant_is_not_followed_while_equipment_tells_what_to_do() -> None:
    told = Told((1.0, advisory()), (2.0, equipment()), (3.0, advisory(1)), voiced=False)
    assert [event[2] for event in told.events] == ["follows turn (e-1)"]


def test_an_alert_that_tells_nobody_what_to_do_leaves_the_assistant_in_force() -> None:
    told = Told((1.0, equipment(tells=False)), (2.0, advisory()), voiced=False)
    assert "follows turn (d-1)" in [event[2] for event in told.events]


def test_once_equipment_is_silent_the_assistant_is_followed_again() -> None:
    told = Told((1.0, equipment()), (4.0, equipment(1, active=False)), (5.0, advisory(1)),
                voiced=False)  # fmt: skip
    assert told.events[-1][2] == "follows turn (d-1)"


def test_the_end_of_an_advisory_is_heard_whatever_equipment_says() -> None:
    told = Told((1.0, equipment()), (2.0, advisory(1, active=False)), voiced=False)
    assert "follows turn (d-1)" in [event[2] for event in told.events]


def told_with_person(*, taken_s: float, left_s: float, until_s: float | None = None) -> list[float]:
    """Return when the crew reacts to an advisory of 1 s, which is over at a time.

    A person has its seat between two times.
    """
    director, crew, reacted_s = Director(Virtual()), Crew(), list[float]()

    def has_person(_name: str) -> bool:
        return taken_s <= director.now_ns / SECOND_NS < left_s

    delivery = AdvisoryDelivery(
        director,
        {"AAL123": cast(Any, crew)},
        lambda *_: reacted_s.append(director.now_ns / SECOND_NS),
        lambda *_: None,
        is_voiced=False,
        seats=cast(Seats, SimpleNamespace(has_person=has_person)),
    )
    messages = [(1.0, advisory())]
    messages += [] if until_s is None else [(until_s, advisory(revision=1, active=False))]
    for t_s, message in messages:
        take = partial(delivery.take, "advisory/AAL123", message, b"")
        director.at(seconds_to_ns(t_s), take, Priority.SCRIPT)
    leaves = SeatAction(holder="somebody", act=LeaveSeat())
    left = partial(delivery.take, "seat/AAL123/do", leaves, b"")
    director.at(seconds_to_ns(left_s), left, Priority.SCRIPT)
    director.at(seconds_to_ns(20.0), director.stop, Priority.OBSERVE)
    director.run()
    return reacted_s


def test_a_crew_does_not_act_under_the_hands_of_who_has_just_taken_its_seat() -> None:
    assert told_with_person(taken_s=5.0, left_s=9.0) == [3.0]
    assert told_with_person(taken_s=2.0, left_s=9.0) == []


def test_a_crew_whose_person_has_left_reacts_to_what_is_still_in_force() -> None:
    assert told_with_person(taken_s=0.0, left_s=9.0) == [11.0]
    assert told_with_person(taken_s=0.0, left_s=9.0, until_s=8.0) == []
