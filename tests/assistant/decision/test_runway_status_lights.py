"""The engine of the runway status lights: who is told of red lights, and what is done on red."""

from __future__ import annotations

from typing import Any

import pytest

from airfield import BRIEFING, HOLD_M, SOUTHEAST, WIDTH_M
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.wording.engines.template import Template
from airhilt.engine_families import ASSISTANTS
from airhilt.messages import CancelTakeoff, HoldPosition, Message, SurfaceTrack
from airhilt.units import SECOND_NS
from instants import surface_track


def lands(number: int = 1, callsign: str = "AAL123", along_m: float = -900.0, **how: Any) -> Any:
    return surface_track(along_m, 0.0, 70.0, number=number, height_m=60.0, callsign=callsign, **how)


def truck(before_m: float, speed_m_s: float, **how: Any) -> SurfaceTrack:
    """Return the track of a truck right of the runway, which it looks at, before the hold line."""
    usual: dict[str, Any] = {"number": 9, "callsign": "OPS1", "turned_deg": -90.0}
    along_m = how.pop("along_m", 800.0)
    return surface_track(along_m, HOLD_M + before_m, speed_m_s, **usual | how)


class Lights:
    """The engine, to which tracks come once a second."""

    def __init__(self, **configuration: float) -> None:
        self.engine = ASSISTANTS.create("runway_status_lights", configuration=configuration)
        self._t_s = 0
        self.told(BRIEFING)

    def told(self, *messages: Message) -> list[Alert]:
        """Return what is told a second later because of some messages."""
        self._t_s += 1
        t_ns = self._t_s * SECOND_NS
        for each in messages:
            if isinstance(each, SurfaceTrack):
                each = each.model_copy(update={"t_track_ns": t_ns})
            self.engine.receive(ReceivedMessage(each, t_ns, t_ns))
        return list(self.engine.decide(t_ns).alerts)


def words(alert: Alert) -> str:
    return Template().message(alert, alert.recipients[0])


def test_without_an_airport_there_is_nothing_to_say() -> None:
    assert ASSISTANTS.create("runway_status_lights").decide(0) == Decision()


def test_red_before_one_who_stands_is_an_advisory_and_against_it_a_warning_to_hold() -> None:
    lights = Lights()
    lights.told(truck(20.0, 4.0))
    (stands,) = lights.told(truck(5.0, 0.0), lands())
    assert (stands.severity, stands.recipients, stands.recommendations) == (
        "ADVISORY", ("OPS1",), {},
    )  # fmt: skip
    (drives,) = Lights().told(truck(5.0, 5.0), lands())
    assert (drives.severity, drives.recipients) == ("WARNING", ("OPS1",))
    assert drives.recommendations == {"OPS1": HoldPosition(runway="01")}
    assert words(drives) == "OPS1 hold position. Entrance lights red for runway 01, traffic AAL123"


def test_one_who_cannot_stop_short_of_the_runway_is_left_to_their_judgement() -> None:
    (told,) = Lights().told(truck(WIDTH_M / 2.0 + 20.0 - HOLD_M, 8.0), lands())
    assert (told.severity, told.recommendations) == ("WARNING", {})


@pytest.mark.parametrize(
    ("others", "is_told"),
    [
        ([], True),
        (
            [truck(5.0, 5.0, number=8, callsign=None, along_m=900.0)],
            False,
        ),  # A deer: the name may be of either.
        ([surface_track(500.0, 300.0, number=7, icao24="abcdef")], True),
    ],
)
def test_who_has_no_transponder_is_told_by_the_only_name_that_no_track_has(
    others: list[SurfaceTrack], is_told: bool
) -> None:
    told = Lights().told(truck(5.0, 5.0, callsign=None), lands(), *others)
    assert [each.recipients for each in told] == ([("OPS1",)] if is_told else [])


def test_a_crew_that_rolls_against_them_rejects_the_take_off() -> None:
    obstacle = truck(-HOLD_M, 0.0)
    told = Lights().told(surface_track(300.0, 0.0, 20.0, callsign="AAL123"), obstacle)
    assert [(each.severity, each.recipients) for each in told] == [("WARNING", ("AAL123",))]
    assert told[0].recommendations == {"AAL123": CancelTakeoff(runway="01")}


def test_intersection_lights_are_red_before_a_departure_while_somebody_lands_across() -> None:
    waits = surface_track(50.0, number=2, callsign="DAL456")
    (told,) = Lights().told(waits, lands(axis=SOUTHEAST, along_m=-500.0))
    assert words(told) == "DAL456 intersection lights red for runway 01, traffic AAL123"
    truck = surface_track(50.0, number=2, callsign="OPS1")
    assert Lights().told(truck, lands(axis=SOUTHEAST, along_m=-500.0)) == []  # It takes off never.


def test_the_numbers_of_the_lights_can_be_set() -> None:
    for arrival_m, is_lit in ((2900.0, False), (3100.0, True)):
        told = Lights(arrival_m=arrival_m).told(truck(5.0, 5.0), lands(along_m=-3000.0))
        assert bool(told) is is_lit


def test_red_lights_before_one_are_one_alert_whoever_lights_them() -> None:
    """One arrival after the other; the driver has come up to the line before."""
    lights = Lights()
    assert lights.told(truck(20.0, 4.0)) == []
    gone = surface_track(5000.0, 900.0, callsign="AAL123")
    told = lights.told(truck(5.0, 0.0), lands())
    told += lights.told(truck(5.0, 0.0), lands(), lands(2, "AAL456"))
    told += lights.told(truck(5.0, 0.0), gone, lands(2, "AAL456"))
    for _ in range(3):
        told += lights.told(
            truck(5.0, 0.0), surface_track(5000.0, 900.0, number=2, callsign="AAL456")
        )
    assert [(alert.id, alert.active) for alert in told] == [("lights-1", True), ("lights-1", False)]
    assert told[0].traffic == ("OPS1", "AAL123")
