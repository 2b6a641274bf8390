"""The baseline by ADS-B alone warns of what moves, and of nothing that is only said."""

from __future__ import annotations

from airfield import NORTH, Airfield, Mover, drives, lands
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template
from airhilt.engine_families import ASSISTANTS


def adsb_only() -> DecisionWorker:
    return DecisionWorker(ASSISTANTS.create("adsb_only"), Template())


def test_it_hears_and_sees_nothing() -> None:
    keys = {wanted.key for wanted in adsb_only().description.inputs}
    assert keys == {"briefing", "adsb/*"}


def test_it_warns_of_a_vehicle_on_the_runway_of_an_arrival() -> None:
    movers = [
        Mover("AAL123", NORTH, lands(90)),
        Mover("OPS1", NORTH, drives(40, 800.0), 90.0, "C2"),
    ]
    assert str(Airfield(movers, worker=adsb_only()).run(85.0).worst) == "WARNING"
