"""Nobody acts before the words of the instruction have been said, in the log of real runs."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import airhilt
from airhilt.messages import Event
from airhilt.record import read_log
from airhilt.units import SECOND_NS
from nominal import nominal

FIRST_SENTENCE = re.compile(r"[^.]+")
"""The sentence of the template that says what to do."""
REACTS = re.compile(r"(?:follows|holds) .*\((.+)\)")


def documents(folder: Path, prefix: str) -> Iterator[dict[str, Any]]:
    for logged in read_log(folder / "log.mcap"):
        if logged.key.startswith(prefix):
            yield json.loads(logged.data)


def said_ns(text: str, begin_ns: int, duration_ns: float) -> float:
    """Return when the first sentence of a text has been said, its characters in proportion."""
    found = FIRST_SENTENCE.match(text)
    assert found is not None
    return begin_ns + duration_ns * len(found[0]) / len(text)


def instruction_ends(folder: Path, channel: str) -> dict[tuple[str, str], float]:
    """Return when the first instruction of each advisory had been said, by id and recipient."""
    telling = {
        (told["id"], told["revision"], told["recipient"])
        for told in documents(folder, "advisory/")
        if told["recommendation"] is not None
    }
    ends: dict[tuple[str, str], float] = {}
    for name, end_ns in in_cockpit(folder) if channel == "cockpit" else on_frequency(folder):
        if name in telling:
            identity, _, recipient = name
            ends.setdefault((identity, recipient), end_ns)
    return ends


def in_cockpit(folder: Path) -> Iterator[tuple[tuple[str, int, str], float]]:
    for voice in documents(folder, "tts/"):
        duration_ns = voice["samples"] * SECOND_NS / voice["sample_rate_hz"]
        name = voice["id"], voice["revision"], voice["recipient"]
        yield name, said_ns(voice["text"], voice["t_ns"], duration_ns)


def on_frequency(folder: Path) -> Iterator[tuple[tuple[str, int, str], float]]:
    for call in documents(folder, "truth/radio/"):
        if call["speaker"] == "ASSISTANT":
            identity, revision, recipient = call["id"].removeprefix("advisory.").rsplit(".", 2)
            duration_ns = call["t_end_ns"] - call["t_tx_ns"]
            name = identity, int(revision), recipient
            yield name, said_ns(call["text"], call["t_tx_ns"], duration_ns)


@pytest.mark.parametrize("scenario", ["s02a_headon", "s01b_noncompliance"])
@pytest.mark.parametrize("channel", ["cockpit", "frequency"])
@pytest.mark.parametrize("crews", ["ideal", "icao"])
def test_who_hears_an_advisory_acts_after_its_instruction_has_been_said(
    scenario: str, channel: Any, crews: Any, tmp_path: Path
) -> None:
    out = tmp_path / "run"
    airhilt.run(
        nominal(scenario), out=out, advisory_channel=channel, crews=crews, latency="fixed",
        cameras=False, report=False, recipients="crew",
    )  # fmt: skip
    ends = instruction_ends(out, channel)
    reactions = 0
    for document in documents(out, "truth/event"):
        event = Event.model_validate(document)
        found = REACTS.fullmatch(event.text)
        if event.kind == "pilot_reacts" and found is not None:
            reactions += 1
            assert event.t_ns > ends[found[1], event.subject]
    assert reactions >= 1
