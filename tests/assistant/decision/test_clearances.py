"""Clearances and readbacks by themselves: what is in force, what is wrong, and what is in doubt."""

from __future__ import annotations

from typing import Any

import pytest

from airhilt.assistant.decision.clearances import Clearances
from airhilt.assistant.decision.guard import ConfidenceGuard, call_of
from airhilt.messages import TransmissionOpened
from airhilt.units import SECOND_NS
from decisions import transcript

CALLSIGNS = ("AAL123", "DAL456", "OPS1")
TOWER_KHZ, OTHER_KHZ = 119_100, 121_500


class Frequency:
    """Clearances that follow some calls; a word with a question mark is unsure."""

    def __init__(self, *calls: tuple[float, str], opened: bool = False) -> None:
        self.clearances = Clearances(ConfidenceGuard())
        self._opened = opened
        for end_s, text in calls:
            self.hears(end_s, text)

    def hears(
        self, end_s: float, text: str, *, begin_s: float | None = None, khz: int = TOWER_KHZ
    ) -> None:
        """Take a call of 3 s, or one that begins at another time."""
        end_ns = round(end_s * SECOND_NS)
        begin_ns = end_ns - 3 * SECOND_NS if begin_s is None else round(begin_s * SECOND_NS)
        given = transcript(f"at {end_s:g}", khz, begin_ns, end_ns, text)
        if self._opened:
            self.clearances.take_opening(
                TransmissionOpened(id=given.id, frequency_khz=khz, t_tx_ns=begin_ns)
            )
        self.clearances.take(call_of(given, CALLSIGNS), given)

    def in_force(self, t_s: float) -> list[tuple[str, str, str | None, bool]]:
        return [
            (each.callsign, each.action, each.runway, each.is_certain)
            for each in self.clearances.in_force(round(t_s * SECOND_NS))
        ]

    def wrong(self, t_s: float) -> list[tuple[Any, ...]]:
        """Return who read back wrongly, who was meant, and the transmissions."""
        return [
            (each.callsign, each.addressed, each.read.action, each.read.runway, *each.radio_ids)
            for each in self.clearances.discrepancies(round(t_s * SECOND_NS))
        ]

    def doubts(self, t_s: float) -> list[tuple[str, str, str]]:
        return [
            (each.callsign, each.slot, each.said.action)
            for each in self.clearances.doubts(round(t_s * SECOND_NS))
        ]

    def unanswered(self, t_s: float) -> list[tuple[str, str]]:
        return [
            (each.callsign, each.given.action)
            for each in self.clearances.unanswered(round(t_s * SECOND_NS))
        ]

    def holds(self, callsign: str, *runways: str) -> bool:
        return self.clearances.is_holding(callsign, runways)


CLEARED = "American one two three, runway zero one, cleared to land."
UNSURE = "American one two three, runway zero? one?, cleared to land."
WRONG = "Cleared to land runway one niner, American one two three."
DELTA_LINES_UP = "Delta four five six, runway zero one, line up and wait."
DELTA_HOLDS = "Delta four five six, hold short runway zero one."

# --- what is in force -------------------------------------------------------------------------


def test_a_readback_that_names_no_runway_is_for_that_of_the_instruction() -> None:
    heard = Frequency((3.0, CLEARED), (7.0, "Cleared to land, American one two three."))
    assert heard.in_force(8.0) == [("AAL123", "cleared_to_land", "01", True)]
    assert heard.wrong(8.0) == []


def test_a_readback_that_names_another_runway_is_believed_and_told() -> None:
    heard = Frequency((3.0, CLEARED), (7.0, WRONG))
    assert heard.in_force(8.0) == [("AAL123", "cleared_to_land", "19", True)]
    assert heard.wrong(8.0) == [("AAL123", "AAL123", "cleared_to_land", "19", "at 3", "at 7")]


def test_each_has_clearances_of_their_own_until_they_are_used() -> None:
    heard = Frequency((3.0, CLEARED), (8.0, DELTA_LINES_UP))
    heard.clearances.finish("AAL123", "line_up", "cross")
    assert [name for name, *_ in heard.in_force(9.0)] == ["AAL123", "DAL456"]
    heard.clearances.finish("AAL123", "line_up", "cleared_to_land")
    assert [name for name, *_ in heard.in_force(9.0)] == ["DAL456"]
    heard.clearances.finish("OPS1", "cross")
    assert [name for name, *_ in heard.in_force(9.0)] == ["DAL456"]


@pytest.mark.parametrize(
    "words",
    ["deer on runway zero one", "ident, maintain visual separation",
     "expect departure runway one niner"],
)  # fmt: skip
def test_what_is_no_clearance_leaves_clearances_as_they_are(words: str) -> None:
    heard = Frequency((3.0, CLEARED), (9.0, f"American one two three, {words}."))
    assert heard.in_force(10.0) == [("AAL123", "cleared_to_land", "01", True)]


@pytest.mark.parametrize(
    ("words", "runways", "holds"),
    [
        ("hold short runway zero one", ("01", "19"), True),
        ("hold short runway zero one", ("19", "01"), True),
        ("hold short runway zero one", ("15", "33"), False),
        ("hold position", ("15", "33"), True),
        ("taxi to the ramp", ("01", "19"), False),
    ],
)
def test_who_was_told_to_holds_short_of_that_runway_or_of_any(
    words: str, runways: tuple[str, ...], holds: bool
) -> None:
    heard = Frequency((3.0, f"Delta four five six, {words}."))
    assert heard.holds("DAL456", *runways) is holds
    assert not heard.holds("AAL123", *runways)


def test_who_holds_does_so_until_another_instruction_even_an_unsure_one() -> None:
    for words, holds in (
        ("wind calm", True),
        ("cross runway zero one", False),
        ("cross runway zero? one?", False),
        ("hold short runway zero? one?", True),
    ):
        heard = Frequency((3.0, DELTA_HOLDS), (9.0, f"Delta four five six, {words}."))
        assert heard.holds("DAL456", "01", "19") is holds


# --- what is wrong ----------------------------------------------------------------------------


@pytest.mark.parametrize(("begin_s", "is_wrong"), [(33.0, True), (33.1, False)])
def test_a_readback_begins_within_30_s_of_its_instruction(begin_s: float, is_wrong: bool) -> None:
    heard = Frequency((3.0, CLEARED))
    heard.hears(begin_s + 3.0, WRONG, begin_s=begin_s)
    assert bool(heard.wrong(37.0)) is is_wrong


@pytest.mark.parametrize(("t_s", "is_told"), [(127.0, True), (127.1, False)])
def test_a_wrong_readback_matters_for_two_minutes(t_s: float, is_told: bool) -> None:
    assert bool(Frequency((3.0, CLEARED), (7.0, WRONG)).wrong(t_s)) is is_told


def test_each_instruction_of_a_readback_is_compared() -> None:
    """The first one is right, and the second one is not."""
    heard = Frequency(
        (3.0, "Ops one, cross runway one five, hold short runway zero one."),
        (8.0, "Cross runway one five, hold short runway one niner, Ops one."),
    )
    assert heard.wrong(9.0) == [("OPS1", "OPS1", "hold_short", "19", "at 3", "at 8")]
    assert heard.in_force(9.0) == [("OPS1", "cross", "15", True)]
    assert heard.holds("OPS1", "19")


def test_who_reads_back_what_another_was_told_is_found_behind_those_who_have_answered() -> None:
    heard = Frequency(
        (3.0, DELTA_LINES_UP),
        (7.0, CLEARED),
        (11.0, "Cleared to land runway zero one, American one two three."),
        (15.0, "Line up and wait runway zero one, Ops one."),
    )
    assert heard.wrong(16.0) == [("OPS1", "DAL456", "line_up", "01", "at 3", "at 15")]


def test_nobody_is_taken_for_another_who_has_answered_or_was_told_something_else() -> None:
    answered = Frequency(
        (3.0, DELTA_LINES_UP),
        (7.0, "Line up and wait runway zero one, Delta four five six."),
        (11.0, "Line up and wait runway zero one, Ops one."),
    )
    assert answered.wrong(12.0) == []
    other = Frequency((3.0, DELTA_LINES_UP), (7.0, "Crossing runway zero one, Ops one."))
    assert other.wrong(8.0) == []


def test_who_is_given_the_same_as_another_reads_back_the_own_instruction() -> None:
    heard = Frequency(
        (3.0, DELTA_LINES_UP),
        (7.0, "Ops one, runway zero one, line up and wait."),
        (11.0, "Line up and wait runway zero one, Ops one."),
    )
    assert heard.wrong(12.0) == []


def test_what_was_not_told_and_is_read_back_is_wrong_if_it_clears() -> None:
    taxi = "Ops one, hold short runway zero one."
    heard = Frequency((3.0, taxi), (7.0, "Crossing runway zero one, Ops one."))
    assert heard.wrong(8.0) == [("OPS1", "OPS1", "cross", "01", "at 3", "at 7")]
    heard = Frequency((3.0, taxi), (7.0, "Hold position, Ops one."))
    assert heard.wrong(8.0) == []


@pytest.mark.parametrize(
    ("text", "is_settled"),
    [
        (CLEARED, True),  # Said again to who read back.
        (DELTA_LINES_UP, True),  # Said again to who was meant.
        ("Ops one, cross runway one five.", False),
        ("American one two three, runway zero? one?, cleared to land.", False),
    ],
)
def test_a_new_call_to_one_of_the_two_settles_a_wrong_readback(text: str, is_settled: bool) -> None:
    wrong = "Line up and wait runway zero one, American one two three."
    heard = Frequency((3.0, DELTA_LINES_UP), (7.0, wrong), (12.0, text))
    assert (heard.wrong(13.0) == []) is is_settled


# --- what is not answered ---------------------------------------------------------------------


def test_of_two_who_were_told_to_hold_the_one_who_has_not_answered_is_late() -> None:
    heard = Frequency(
        (3.0, "Ops one, hold position."),
        (7.0, "Holding position, Ops one."),
        (11.0, DELTA_HOLDS),
        opened=True,
    )
    assert heard.unanswered(15.9) == []
    assert heard.unanswered(16.0) == [("DAL456", "hold_short")]
    assert heard.unanswered(131.0) == [("DAL456", "hold_short")]
    assert heard.unanswered(131.1) == []


@pytest.mark.parametrize(
    ("words", "is_late"),
    [
        ("hold position", True), ("hold short runway zero one", True), ("go around", True),
        ("cancel takeoff clearance", True), ("cross runway zero one", False),
        ("hold short runway zero? one?", False),
    ],
)  # fmt: skip
def test_only_who_is_to_keep_off_must_answer(words: str, is_late: bool) -> None:
    heard = Frequency((3.0, f"Delta four five six, {words}."), opened=True)
    assert bool(heard.unanswered(10.0)) is is_late


def test_who_answers_without_words_of_an_instruction_has_answered() -> None:
    heard = Frequency((3.0, DELTA_HOLDS), (7.0, "Wilco, Delta four five six."), opened=True)
    assert heard.unanswered(20.0) == []


def test_who_is_asked_to_say_it_again_has_answered_once() -> None:
    heard = Frequency(
        (3.0, DELTA_HOLDS),
        (7.0, "Hold short runway zero one, Delta four five six."),
        (11.0, "Delta four five six, say again."),
        opened=True,
    )
    assert heard.unanswered(20.0) == []
    heard.hears(25.0, "Hold short runway one niner, Delta four five six.")
    assert heard.wrong(26.0) == [("DAL456", "DAL456", "hold_short", "19", "at 3", "at 25")]


@pytest.mark.parametrize(("asked_s", "is_compared"), [(123.0, True), (123.1, False)])
def test_a_readback_is_asked_for_again_within_two_minutes(
    asked_s: float, is_compared: bool
) -> None:
    heard = Frequency((3.0, DELTA_HOLDS), (7.0, "Hold short runway zero one, Delta four five six."))
    heard.hears(asked_s, "Delta four five six, say again.")
    heard.hears(asked_s + 5.0, "Hold short runway one niner, Delta four five six.")
    assert bool(heard.wrong(asked_s + 6.0)) is is_compared


# --- what is in doubt -------------------------------------------------------------------------


def test_what_is_in_doubt_clears_nobody_with_certainty() -> None:
    heard = Frequency((3.0, UNSURE))
    assert heard.in_force(4.0) == [("AAL123", "cleared_to_land", "01", False)]


@pytest.mark.parametrize(("t_s", "is_due"), [(33.0, False), (33.1, True), (123.0, True),
                                             (123.1, False)])  # fmt: skip
def test_a_doubt_is_due_once_no_readback_is_to_come_and_for_two_minutes(
    t_s: float, is_due: bool
) -> None:
    assert bool(Frequency((3.0, UNSURE)).doubts(t_s)) is is_due


@pytest.mark.parametrize(
    ("text", "begin_s", "khz", "is_due"),
    [
        ("Ready for departure, Delta four five six.", 3.0, TOWER_KHZ, True),
        ("Ready for departure, Delta four five six.", 2.9, TOWER_KHZ, False),
        ("Ready for departure, Delta four five six.", 5.0, OTHER_KHZ, False),
        ("Delta four five six, hold position.", 5.0, TOWER_KHZ, False),
    ],
)
def test_once_a_crew_has_spoken_instead_the_doubt_is_due(
    text: str, begin_s: float, khz: int, is_due: bool
) -> None:
    heard = Frequency((3.0, UNSURE))
    heard.hears(begin_s + 3.0, text, begin_s=begin_s, khz=khz)
    assert ("AAL123" in [name for name, *_ in heard.doubts(9.0)]) is is_due


def test_a_doubt_is_due_5_s_after_the_instruction_where_openings_are_heard() -> None:
    heard = Frequency((3.0, UNSURE), opened=True)
    assert heard.doubts(7.9) == []
    assert heard.doubts(8.0) == [("AAL123", "runway", "cleared_to_land")]


def test_who_is_asked_to_say_it_again_is_in_doubt_no_more() -> None:
    wrong = "Cleared to land runway zero? one?, American one two three."
    assert Frequency((3.0, wrong)).doubts(10.0) != []
    assert Frequency((3.0, wrong), (7.0, "American one two three, say again.")).doubts(10.0) == []
    assert Frequency((3.0, wrong), (7.0, "Delta four five six, say again.")).doubts(10.0) != []


@pytest.mark.parametrize(
    ("before", "said", "is_news"),
    [
        (CLEARED, "runway zero? one?, cleared to land", False),
        (CLEARED, "runway one? niner?, cleared to land", True),
        ("American one two three, runway one niner, cleared to land.",
         "runway zero? one?, cleared to land", True),
        (CLEARED, "runway zero? one?, cleared for takeoff", True),
        (UNSURE, "runway one? niner?, cleared to land", True),
        (CLEARED, "hold short runway zero? one?", True),
        (CLEARED, "taxi? to? the? ramp?", False),
    ],
)  # fmt: skip
def test_only_what_would_change_something_is_in_doubt(
    before: str, said: str, is_news: bool
) -> None:
    heard = Frequency((3.0, before), (40.0, f"American one two three, {said}."))
    later = [
        each for each in heard.clearances.doubts(75 * SECOND_NS) if each.transcript.id != "at 3"
    ]
    assert bool(later) is is_news


def test_a_readback_that_agrees_settles_what_is_in_doubt() -> None:
    heard = Frequency(
        (3.0, UNSURE), (7.0, "Cleared to land runway zero one, American one two three.")
    )
    assert heard.doubts(50.0) == []
    assert heard.in_force(50.0) == [("AAL123", "cleared_to_land", "01", True)]


def test_a_readback_in_doubt_that_differs_is_asked_for_at_once() -> None:
    heard = Frequency(
        (3.0, CLEARED), (7.0, "Cleared to land runway one? niner?, American one two three.")
    )
    assert heard.wrong(8.0) == []
    assert heard.doubts(7.0) == [("AAL123", "runway", "cleared_to_land")]
