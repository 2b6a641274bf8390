"""The book of seats: who has which, and for whom a seat is kept."""

from __future__ import annotations

from dataclasses import dataclass

from airhilt.station.seat_book import HOLD_S, SeatBook


@dataclass(eq=False)
class Browser:
    """A browser with a name."""

    identity: str = ""


def book() -> SeatBook[Browser]:
    return SeatBook(["TOWER", "GROUND"])


def test_a_seat_is_for_one_person_and_each_has_one_seat() -> None:
    seats, one, two = book(), Browser("one"), Browser("two")
    assert seats.move(one, "TOWER") is None
    assert "Somebody has the seat TOWER" in (seats.why_not(two, "TOWER") or "")
    assert seats.why_not(one, "TOWER") is None
    assert seats.why_not(two, "GROUND") is None
    assert seats.move(one, "GROUND") == "TOWER"
    assert (seats.of(one), seats.of(two)) == ("GROUND", None)
    assert seats.why_not(two, "TOWER") is None


def test_a_seat_that_there_is_not_is_given_to_nobody() -> None:
    assert "no seat of this run" in (book().why_not(Browser(), "APPROACH") or "")


def test_each_person_is_told_which_seats_are_free_taken_or_the_own_one() -> None:
    seats, one, two = book(), Browser("one"), Browser("two")
    seats.move(one, "TOWER")
    assert seats.shown_to(one) == {"TOWER": "yours", "GROUND": "free"}
    assert seats.shown_to(two) == {"TOWER": "taken", "GROUND": "free"}
    seats.hold(one)
    assert seats.shown_to(two) == {"TOWER": "taken", "GROUND": "free"}


def test_a_seat_is_kept_for_who_is_gone_and_for_nobody_else() -> None:
    seats, lost, back = book(), Browser("one"), Browser("one")
    seats.move(lost, "TOWER")
    hold = seats.hold(lost)
    assert hold is not None
    assert (hold.seat, hold.seconds) == ("TOWER", HOLD_S)
    for other in (Browser("two"), Browser()):
        seats.give_back(other)
        assert seats.of(other) is None
        assert f"kept for {HOLD_S:g} s" in (seats.why_not(other, "TOWER") or "")
    assert seats.why_not(back, "TOWER") is None
    seats.give_back(back)
    assert seats.of(back) == "TOWER"
    assert not seats.expire(hold)
    assert seats.of(back) == "TOWER"


def test_a_seat_that_was_kept_long_enough_is_free() -> None:
    seats, lost = book(), Browser("one")
    seats.move(lost, "TOWER")
    hold = seats.hold(lost)
    assert hold is not None
    assert seats.expire(hold)
    assert seats.is_free("TOWER")
    assert not seats.expire(hold)
    seats.give_back(back := Browser("one"))
    assert seats.of(back) is None


def test_a_seat_that_is_lost_again_is_not_freed_by_the_first_loss() -> None:
    seats, lost = book(), Browser("one")
    seats.move(lost, "TOWER")
    first = seats.hold(lost)
    seats.give_back(back := Browser("one"))
    seats.hold(back)
    assert first is not None
    assert not seats.expire(first)
    assert not seats.is_free("TOWER")


def test_who_has_lost_two_seats_gets_one_back_and_the_other_is_still_kept() -> None:
    seats, first, second = book(), Browser("one"), Browser("one")
    seats.move(first, "TOWER")
    seats.move(second, "GROUND")
    seats.hold(first)
    seats.hold(second)
    seats.give_back(back := Browser("one"))
    assert sorted(seats.shown_to(back).values()) == ["taken", "yours"]


def test_nothing_is_kept_for_who_has_no_seat_and_nothing_given_to_who_has_no_name() -> None:
    seats, nameless = book(), Browser()
    assert seats.hold(nameless) is None
    seats.move(nameless, "TOWER")
    assert seats.hold(nameless) is not None
    seats.give_back(back := Browser())
    assert seats.of(back) is None
