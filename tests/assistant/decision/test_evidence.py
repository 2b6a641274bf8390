"""An advisory says what it rests on: calls, cameras, tracks, rules, and shares where they are."""

from __future__ import annotations

import pytest

from airfield import NORTH, Airfield, Mover, lands, stands, takes_off
from airhilt.assistant.decision.engines.paper import PaperEngine
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template
from airhilt.messages import Told
from decisions import reference
from encounters import head_on
from field_cameras import beside_threshold, on_tower, silent
from projected import TRUCK

MISREAD = [
    (20.0, "American 123, runway zero one, cleared to land."),
    (25.0, "Cleared to land runway one niner, American 123."),
]


def paper() -> DecisionWorker:
    return DecisionWorker(PaperEngine(), Template())


@pytest.mark.parametrize("engine", [reference, paper])
def test_a_wrong_readback_names_both_calls_and_the_tracks(engine: type) -> None:
    movers = [Mover("AAL123", NORTH, lands(400.0)), Mover("DAL456", NORTH, takes_off(999.0))]
    field = Airfield(movers, MISREAD, engine()).run(30)
    told_s, told = field.first("CAUTION", "readback_mismatch")
    assert (told_s, told.recipients) == (25.0, ("AAL123", "ATC"))
    assert told.evidence.radio_ids == ("0", "1")
    assert told.evidence.tracks == (movers[0].icao24, movers[1].icao24)
    assert told.evidence.rules == ("readback_mismatch",)
    assert told.evidence.shares == {}, "both modalities are needed"


@pytest.mark.parametrize("engine", [reference, paper])
def test_what_cameras_show_names_them(engine: type) -> None:
    truck = silent(stands(800))
    cameras = [look(truck.body("truck", TRUCK)) for look in (on_tower, beside_threshold)]
    movers = [Mover("AAL123", NORTH, lands(30.0)), truck]
    _, told = Airfield(movers, worker=engine(), cameras=cameras).run(10).first("WARNING")
    assert told.evidence.camera_ids == ("threshold", "tower")
    assert told.evidence.tracks == (movers[0].icao24,)
    assert told.evidence.rules == ("occupancy",)
    assert told.evidence.time_to_go_s is not None


def test_a_score_tells_the_share_of_each_modality() -> None:
    """One camera has shown the truck for less than the time after which it is there for sure."""
    truck = silent(stands(800))
    camera = on_tower(truck.body("truck", TRUCK), confidence=0.6)
    calls = [(4.0, "American 123, runway zero one, cleared to land.")]
    field = Airfield([Mover("AAL123", NORTH, lands(30.0)), truck], calls, paper(), cameras=[camera])
    scored = [a.evidence for _, a in field.run(6).told if a.evidence.rules == ("score",)]
    assert scored
    for evidence in scored:
        assert set(evidence.shares) == set(evidence.sources)
        assert sum(evidence.shares.values()) == pytest.approx(1.0)


def test_a_loss_of_separation_rests_on_the_two_tracks_alone() -> None:
    told = head_on(240.0).fly().told
    evidence = next(advisory.evidence for _, advisory in told if advisory.active)
    assert evidence.sources == ("adsb",)
    assert len(evidence.tracks) == 2
    assert evidence.rules == ("loss_of_separation",)
    assert evidence.shares == {"adsb": 1.0}


@pytest.mark.parametrize(
    ("told", "recipients"),
    [
        (None, {"AAL123", "ATC"}),
        ("crew", {"AAL123"}),
        ("controller", {"ATC"}),
        ("both", {"AAL123", "ATC"}),
    ],
)
def test_who_is_told_of_a_conflict_can_be_chosen(told: Told | None, recipients: set[str]) -> None:
    movers = [Mover("AAL123", NORTH, lands(400.0)), Mover("DAL456", NORTH, takes_off(999.0))]
    worker = DecisionWorker(PaperEngine(), Template(), told=told)
    found = [each for _, each in Airfield(movers, MISREAD, worker).run(30).told]
    assert {each.recipient for each in found} == recipients
    assert all(set(each.recipients) == recipients for each in found)


def test_the_controller_is_told_what_is_recommended_to_each() -> None:
    movers = [Mover("AAL123", NORTH, lands(30.0)), Mover("DAL456", NORTH, stands(800))]
    found = [each for _, each in Airfield(movers, worker=reference()).run(10).told]
    own = {each.recipient: each.recommendation for each in found if each.recommendation}
    to_controller = [each.recommendations for each in found if each.recipient == "ATC"]
    assert own["AAL123"] in [each.get("AAL123") for each in to_controller]
    assert not any(each.recommendations for each in found if each.recipient != "ATC")
