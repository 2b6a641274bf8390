"""The ladder of the AIRHILT paper tells what its rungs say, no more and no less."""

from __future__ import annotations

from typing import Any

import pytest

from airfield import (
    BRIEFING,
    NORTH,
    Airfield,
    Mover,
    drives,
    lands,
    stands,
    takes_off,
)
from airhilt.assistant.decision.engines.paper import PaperEngine
from airhilt.assistant.decision.paper_ladder import PaperConfig
from airhilt.assistant.decision.visual_tracks import SightConfig
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template
from airhilt.messages import RosterEntry, Severity
from field_cameras import beside_threshold, on_tower, silent
from projected import TRUCK


def paper(config: PaperConfig | None = None) -> DecisionWorker:
    return DecisionWorker(PaperEngine(config), Template())


def flown(*movers: Mover, seconds: float, **how: Any) -> Airfield:
    return Airfield(list(movers), worker=how.pop("worker", paper()), **how).run(seconds)


def arrival(at_s: float = 90.0) -> Mover:
    return Mover("AAL123", NORTH, lands(at_s))


def lined_up(axis: Any = NORTH) -> Mover:
    return Mover("DAL456", axis, takes_off(999.0))


# --- (b) the runway is occupied -------------------------------------------------------------


LASTING = PaperConfig(sight=SightConfig(persistence_s=1000.0))
THREE = PaperConfig(sight=SightConfig(persistence_s=1000.0, cameras=3))


@pytest.mark.parametrize(
    ("config", "cameras", "is_warned"),
    [
        pytest.param(LASTING, 2, True, id="two agree at once"),
        pytest.param(PaperConfig(), 1, True, id="one persists"),
        pytest.param(LASTING, 1, False, id="one does not persist"),
        pytest.param(THREE, 2, False, id="K is not reached"),
    ],
)
def test_cameras_show_that_a_runway_is_occupied_if_enough_agree_or_one_persists(
    config: PaperConfig, cameras: int, is_warned: bool
) -> None:
    truck = silent(stands(800))
    looking = [look(truck.body("truck", TRUCK)) for look in (on_tower, beside_threshold)]
    field = flown(
        arrival(25.0), truck, seconds=15.0, worker=paper(config), cameras=looking[:cameras]
    )
    assert (field.worst is Severity.WARNING) == is_warned


# --- (a) and (c) what was said --------------------------------------------------------------


ALIKE = BRIEFING.model_copy(
    update={
        "roster": tuple(
            RosterEntry(callsign=callsign, category="aircraft", type="C172")
            for callsign in ("N172SP", "N552SP", "AAL123")
        )
    }
)


def test_a_callsign_that_may_be_one_of_two_is_a_caution_to_both() -> None:
    calls = [(20.0, "November two sierra papa, runway zero one, line up and wait.")]
    movers = (arrival(), Mover("N172SP", NORTH, stands(40, -100)))
    field = flown(*movers, seconds=25.0, calls=calls, briefing=ALIKE)
    told_s, told = field.first("CAUTION", "readback_mismatch")
    assert told_s == 20.0
    assert told.recipients == ("N172SP", "N552SP", "ATC")
    assert told.evidence.rules == ("recipient_ambiguity",)
    assert told.message.startswith("line up runway 01 may be for N172SP or N552SP")


def test_of_several_who_use_the_runway_the_one_on_it_is_named_first() -> None:
    calls = [(20.0, "November two sierra papa, runway zero one, line up and wait.")]
    movers = (arrival(), lined_up(), Mover("N172SP", NORTH, stands(40, -100)))
    field = flown(*movers, seconds=25.0, calls=calls, briefing=ALIKE)
    _, told = field.first("CAUTION", "readback_mismatch")
    assert set(told.traffic) == {"N172SP", "N552SP", "DAL456"}
    assert "DAL456" in told.message
    assert "AAL123" not in told.message


@pytest.mark.parametrize("release_s", [None, 2.0, 12.0])
def test_a_conflict_is_over_once_it_has_been_for_5_s_unless_told_otherwise(
    release_s: float | None,
) -> None:
    def over_s(config: PaperConfig) -> float:
        movers = arrival(110.0), Mover("OPS1", NORTH, drives(20.0), category="C2")
        told = flown(*movers, seconds=80.0, worker=paper(config)).told
        return next(t_s for t_s, each in told if not each.active)

    at_once_s = over_s(PaperConfig(release_s=0.0))
    config = PaperConfig() if release_s is None else PaperConfig(release_s=release_s)
    assert over_s(config) - at_once_s == pytest.approx(release_s or 5.0, abs=0.5)


# --- the score ------------------------------------------------------------------------------


def test_who_is_told_is_a_matter_of_configuration() -> None:
    def recipients(config: PaperConfig) -> set[str]:
        field = flown(arrival(60.0), lined_up(), seconds=20.0, worker=paper(config))
        return {advisory.recipient for _, advisory in field.told}

    assert recipients(PaperConfig()) == {"AAL123", "DAL456", "ATC"}
    assert recipients(PaperConfig(recipients=("controller",))) == {"ATC"}
    assert recipients(PaperConfig(recipients=("concerned",))) == {"AAL123", "DAL456"}
