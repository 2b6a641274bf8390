"""The fixed sentences of alerts."""

from __future__ import annotations

from dataclasses import replace

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.findings import LossOfSeparation, Occupied
from airhilt.assistant.wording.engines.template import Template
from airhilt.messages import CONTROLLER, Climb, Evidence, HoldPosition, Severity
from airhilt.phraseology.aloud import read_aloud

OCCUPIED = Alert(
    id="01-DAL456",
    revision=0,
    kind="runway_conflict",
    severity=Severity.WARNING,
    recipients=("DAL456", "AAL123", CONTROLLER),
    traffic=("AAL123", "DAL456"),
    evidence=Evidence(sources=("adsb",), runway="01"),
    finding=Occupied("DAL456", "01"),
    recommendations={"DAL456": HoldPosition(runway="01")},
)


def test_who_occupies_a_runway_is_told_of_itself_and_others_of_it() -> None:
    told = {name: Template().message(OCCUPIED, name) for name in OCCUPIED.recipients}
    assert told["DAL456"] == "DAL456 hold position. You are on runway 01"
    assert told["AAL123"] == "AAL123 DAL456 is on runway 01"
    assert told[CONTROLLER] == "DAL456 is on runway 01; DAL456 hold position"


def test_who_is_to_act_is_told_first_what_to_do() -> None:
    finding = LossOfSeparation(("AAL123", "DAL456"), 31.0)
    down = Climb(sense="descend", altitude_ft=34_400.0, vertical_rate_fpm=1500.0)
    alert = replace(OCCUPIED, finding=finding, recommendations={"AAL123": down})
    told = Template().message(alert, "AAL123")
    assert told == "AAL123 descend to 34400 ft. Traffic DAL456, loss of separation in 31 s"
    faster = replace(
        alert, recommendations={"AAL123": down.model_copy(update={"vertical_rate_fpm": 2500.0})}
    )
    assert " at 2500 ft/min. " in Template().message(faster, "AAL123")


def test_separation_that_is_lost_already_is_lost_in_no_time() -> None:
    finding = LossOfSeparation(("AAL123", "DAL456"), 0.0)
    alert = replace(OCCUPIED, kind="loss_of_separation", finding=finding, recommendations={})
    told = Template().message(alert, "AAL123")
    assert told == "AAL123 traffic DAL456, loss of separation in 0 s"


def test_the_address_of_who_sends_no_callsign_is_written_but_not_spoken() -> None:
    down = Climb(sense="descend", altitude_ft=34_400.0, vertical_rate_fpm=1500.0)
    finding = LossOfSeparation(("AAL123", "a1b2c3"), 31.0)
    alert = replace(OCCUPIED, finding=finding, recommendations={"AAL123": down, "a1b2c3": down})
    told = {name: Template().message(alert, name) for name in ("AAL123", "a1b2c3", CONTROLLER)}
    assert told["AAL123"].endswith(". Traffic unknown callsign a1b2c3, loss of separation in 31 s")
    assert told["a1b2c3"].startswith("a1b2c3 descend to 34400 ft. Traffic AAL123")
    assert told[CONTROLLER].startswith("AAL123 and unknown callsign a1b2c3 lose separation in 31 s")
    aloud = {name: read_aloud(text, name, "faa") for name, text in told.items()}
    assert aloud["AAL123"].endswith(". Traffic unknown callsign, loss of separation in 31 seconds")
    assert aloud["a1b2c3"].startswith("unknown callsign, descend to flight level three four four")
    occupied = Template().message(replace(alert, finding=Occupied("a1b2c3", "01")), "AAL123")
    assert occupied.endswith(". Unknown callsign a1b2c3 is on runway 01")
    assert "Unknown callsign is on runway one" in read_aloud(occupied, "AAL123", "faa")
