"""Runs in which an arrival goes around, and its tower brings it back to the runway."""

from __future__ import annotations

from pathlib import Path

import airhilt
from airhilt.record import open_run
from airhilt.scenario import Scenario
from seats import calls, logged
from tower_calls import TOWER, TOWER_KHZ, Seen, scenario_of


def gone_around(situation: str, callsign: str, spoken: str, duration_s: float) -> Scenario:
    """Return a scenario in which an arrival is told to go around at 5 s, and says that it does."""
    document = scenario_of(situation, (), duration_s).model_dump(mode="json")
    told = {
        "id": "told", "at_s": 5, "speaker": TOWER, "to": callsign, "frequency_khz": TOWER_KHZ,
        "text": f"{spoken}, go around.",
        "commands": [{"actor": callsign, "command": {"action": "go_around"}}],
    }  # fmt: skip
    read_back = {
        "id": "read_back", "at_s": 10, "speaker": callsign, "to": TOWER,
        "frequency_khz": TOWER_KHZ, "text": f"Going around, {spoken}.",
    }  # fmt: skip
    document["radio"]["lines"] += [told, read_back]
    return Scenario.model_validate(document)


def test_an_arrival_that_went_around_is_sent_round_the_circuit_and_cleared_to_land(
    tmp_path: Path,
) -> None:
    scenario = gone_around("short_final", "AAL123", "American one two three", 600.0)
    log = logged(scenario, tmp_path / "run", [])
    said = [each["text"].lower() for each in calls(log) if each["speaker"] == TOWER]
    (joins,) = [number for number, text in enumerate(said) if "downwind" in text]
    (cleared,) = [number for number, text in enumerate(said) if "cleared to land" in text]
    assert joins < cleared
    assert Seen(log, "AAL123", 60.0).lands_on("01")


def test_a_crew_that_goes_around_on_advice_says_so_and_its_tower_acts_on_that(
    tmp_path: Path,
) -> None:
    out = tmp_path / "run"
    airhilt.run(
        "s01a_tight_timing", out=out, recipients="crew", speech=False, cameras=False, report=False,
        latency="fixed",
    )  # fmt: skip
    said = [(each["speaker"], each["text"].lower()) for each in calls(list(open_run(out).log()))]
    tells = said.index(("AAL123", "washington tower, american one twenty three, going around."))
    after = [text for speaker, text in said[tells:] if speaker != "AAL123"]
    assert any("downwind" in text for text in after)
