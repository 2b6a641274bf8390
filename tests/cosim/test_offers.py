"""Commands that calls have for people at seats: offered, and given when the person chooses."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from airhilt.cosim.replay import replay
from airhilt.record import Logged
from airhilt.scenario import Scenario
from airhilt.scenario.models.radio import ReceiverRadio
from breadth import mostly_slow
from nominal import nominal
from seats import SECOND, act, cards, contents, logged, offers, said, spoken, states, tower, voice

TURN = "American one two three, turn left heading two seven zero"


def ground(duration_s: float = 60.0) -> Scenario:
    """Ground lets DAL456 taxi at 16 s, beside the landing at Washington."""
    scenario = nominal("s01b_ground_nominal")
    return scenario.model_copy(update={"duration_s": duration_s, "cameras": ()})


def offered_ns(log: Sequence[Logged], seat: str, number: int = 1) -> int:
    """Return when a seat first had an offer."""
    having = (one for one in states(log, seat) if number in [of["number"] for of in one["offers"]])
    return int(next(having)["t_ns"])


def way_m(log: Sequence[Logged], actor: str) -> float:
    """Return how far an actor is at the end from where it began, roughly, in m."""
    states = contents(log, f"truth/state/{actor}")
    north, east = (states[-1][name] - states[0][name] for name in ("latitude_deg", "longitude_deg"))
    return float(((north * 111_000) ** 2 + (east * 87_000) ** 2) ** 0.5)


def call_end_ns(log: Sequence[Logged], name: str) -> int:
    (call,) = [one for one in contents(log, "truth/radio/") if one["id"] == name]
    return int(call["t_end_ns"])


@pytest.mark.parametrize(
    ("scenario", "seat", "line"),
    [
        (tower(90.0), "OPS1", "proceed"),
        pytest.param(ground(90.0), "DAL456", "taxi", marks=pytest.mark.slow),
    ],
    ids=["driver", "pilot at a stand"],
)
def test_a_person_goes_where_a_call_has_sent_it_and_when_the_person_chooses(
    tmp_path: Path, scenario: Scenario, seat: str, line: str
) -> None:
    waits = logged(scenario, tmp_path / "waits", [seat])
    (offer,) = offers(waits, seat)
    assert (offer["call"], offer["command"]["action"]) == (line, "taxi")
    assert offered_ns(waits, seat) == call_end_ns(waits, line)
    assert way_m(waits, seat) == 0.0

    given = [act(seat, 50.0, "fly", command=offer["command"])]
    log = logged(scenario, tmp_path / "goes", [seat], given)
    last = states(log, seat)[-1]
    assert (last["offers"], last["t_ns"]) == ([], 50 * SECOND)
    assert way_m(log, seat) > 50.0
    verdict = replay(tmp_path / "goes")
    assert verdict.identical, str(verdict)


def test_a_call_that_is_blocked_offers_nothing(tmp_path: Path) -> None:
    """Somebody speaks while the tower sends OPS1 to the runway; the tower says it again."""
    held = spoken("OPS2", 31.0, voice("alpha bravo charlie delta echo foxtrot"))
    log = logged(tower(60.0), tmp_path / "run", ["OPS1", "OPS2"], held, speech=True)
    blocked, again = [
        one for one in contents(log, "truth/radio/") if one["id"].startswith("proceed")
    ]
    assert len(blocked["blocked_by"]) == 1
    assert offered_ns(log, "OPS1") == again["t_end_ns"]


def test_a_clearance_that_a_person_says_is_offered_to_the_person_addressed(
    tmp_path: Path,
) -> None:
    given = [said("Washington_Tower", 5.0, TURN)]
    log = logged(tower(15.0), tmp_path / "run", ["tower", "AAL123"], given)
    (offer,) = offers(log, "AAL123")
    assert offer["command"]["action"] == "track"
    assert offer["call"] == "seat.Washington_Tower.1"
    assert not offers(log, "Washington_Tower")


def test_a_clearance_that_a_person_speaks_is_offered_as_it_was_recognised(tmp_path: Path) -> None:
    given = spoken("Washington_Tower", 5.0, voice(TURN))
    log = logged(tower(20.0), tmp_path / "run", ["tower", "AAL123"], given, speech=True)
    (offer,) = offers(log, "AAL123")
    assert offer["command"]["track_deg"] == pytest.approx(259.3, abs=0.05)


@pytest.mark.parametrize("snr_db", mostly_slow([-9.0, -5.0, 0.0], -5.0))
def test_no_mishearing_is_drawn_for_a_person(tmp_path: Path, snr_db: float) -> None:
    radio = tower().radio.model_copy(update={"receivers": {"OPS1": ReceiverRadio(snr_db=snr_db)}})
    scenario = tower(60.0).model_copy(update={"radio": radio})
    log = logged(scenario, tmp_path / "run", ["OPS1"])
    (offer,) = offers(log, "OPS1")
    assert offer["command"]["to"] == {"type": "hold_short", "runway": "01", "taxiway": "D"}


def test_what_waits_for_a_condition_is_offered_at_once_and_says_nothing_of_it(
    tmp_path: Path,
) -> None:
    """The tower clears DAL456 for take-off, and to turn once in the climb."""
    scenario = nominal("s01a_nominal").model_copy(update={"cameras": ()})
    log = logged(scenario, tmp_path / "run", ["DAL456"])
    assert [one["command"]["action"] for one in offers(log, "DAL456")] == ["take_off", "track"]
    for number in (1, 2):
        assert offered_ns(log, "DAL456", number) == call_end_ns(log, "takeoff")


def test_what_goes_with_the_own_call_is_offered_when_that_is_due(tmp_path: Path) -> None:
    """The crew of AAL123 climbs with its readback."""
    scenario = nominal("s02a_nominal").model_copy(update={"cameras": ()})
    log = logged(scenario, tmp_path / "run", ["AAL123"])
    (card,) = [one for one in cards(log, "AAL123") if one["line"] == "readback"]
    (offer,) = offers(log, "AAL123")
    assert (offer["call"], offer["command"]["action"]) == ("readback", "altitude")
    assert offered_ns(log, "AAL123") == card["due_ns"]


def test_an_offer_that_cannot_be_done_yet_stays(tmp_path: Path) -> None:
    """A driver who stands where no taxiway leads on cannot cross."""
    given = [
        said("Washington_Tower", 5.0, "Ops one, Washington Tower, cross runway zero one."),
        act("OPS1", 20.0, "fly", command={"action": "cross", "runway": "01"}),
    ]
    log = logged(tower(30.0), tmp_path / "run", ["tower", "OPS1"], given)
    assert [one["subject"] for one in contents(log, "truth/event") if one["kind"] == "unable"] == [
        "OPS1"
    ]
    assert [one["command"]["action"] for one in states(log, "OPS1")[-1]["offers"]] == ["cross"]


def test_who_leaves_takes_nothing_along_that_a_call_had_for_the_seat(tmp_path: Path) -> None:
    given = [
        act("OPS1", 2.0, "take"),
        act("OPS1", 50.0, "leave"),
    ]
    log = logged(tower(60.0), tmp_path / "run", ["OPS1"], given)
    assert offers(log, "OPS1")
    assert not states(log, "OPS1")[-1]["offers"]
    assert way_m(log, "OPS1") == 0.0
