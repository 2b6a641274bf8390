"""Advisories on the recipient's frequency are calls like others."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import airhilt
from airhilt.cosim.replay import replay
from airhilt.errors import AirhiltError
from airhilt.record import read_log
from airhilt.sensors.radio.frequency_arbiter import REACTION_S
from nominal import nominal

HOW: dict[str, Any] = {"latency": "fixed", "speech": False, "cameras": False}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("channel") / "run"
    airhilt.run(nominal("s01a_misaddressed"), out=out, advisory_channel="frequency", **HOW)
    return out


def messages(folder: Path, prefix: str) -> list[dict[str, Any]]:
    log = read_log(folder / "log.mcap")
    return [json.loads(each.data) for each in log if each.key.startswith(prefix)]


def test_they_are_transmissions_that_wait_for_a_free_frequency(folder: Path) -> None:
    calls = messages(folder, "truth/radio/")
    spoken = [call for call in calls if call["speaker"] == "ASSISTANT"]
    assert {call["addressed"] for call in spoken} >= {"AAL123", "DAL456"}
    assert {call["frequency_khz"] for call in spoken} == {119_100}
    for call in spoken:
        for other in calls:
            apart = other["t_end_ns"] <= call["t_tx_ns"] or call["t_end_ns"] <= other["t_tx_ns"]
            between_ns = abs(other["t_tx_ns"] - call["t_tx_ns"])  # Nobody notices who just began.
            assert other is call or apart or between_ns <= REACTION_S * 1e9
    received = {each["id"]: each["keyed_by"] for each in messages(folder, "radio/119100/tx")}
    assert all(received[call["id"]] == "ASSISTANT" for call in spoken)


def test_their_words_come_back_and_are_taken_for_nobodys_clearance(folder: Path) -> None:
    heard = [each for each in messages(folder, "asr/") if each["speaker"] == "ASSISTANT"]
    assert heard
    advisories = messages(folder, "advisory/")
    assert not any(
        name.startswith("advisory.") for one in advisories for name in one["evidence"]["radio_ids"]
    )
    assert not any(one["kind"] == "clarification" for one in advisories)


def test_a_crew_acts_once_it_has_heard_it_to_the_end(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    airhilt.run("s02a_headon", out=folder, advisory_channel="frequency", **HOW)
    reacts = [e for e in messages(folder, "truth/event") if e["kind"] == "pilot_reacts"]
    for callsign in ("AAL123", "DAL456"):
        heard = messages(folder, f"truth/hearing/{callsign}")
        told_ns = min(one["t_ns"] for one in heard if one["id"].startswith("advisory."))
        assert min(event["t_ns"] for event in reacts if event["subject"] == callsign) > told_ns


@pytest.mark.slow
def test_a_replay_is_identical(folder: Path) -> None:
    assert replay(folder).identical


def test_without_a_frequency_it_is_refused(tmp_path: Path) -> None:
    scenario = airhilt.load("s02a_headon")
    silent = scenario.model_copy(
        update={"radio": scenario.radio.model_copy(update={"lines": ()}), "failures": ()}
    )
    with pytest.raises(AirhiltError, match="has no radio calls, and so no frequency"):
        airhilt.run(silent, out=tmp_path / "run", advisory_channel="frequency", **HOW)
