"""Runs to be looked at."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from airhilt import run
from airhilt.scenario import Scenario
from airhilt.scenario.models.radio import ReceiverRadio
from nominal import nominal
from seats import logged, spoken, tower, voice
from shortened import shortened
from stations import PretendedRun, seat_page


@pytest.fixture(scope="session")
def spoken_run(encounter: Scenario, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run of 25 s with calls and a warning, all of which can be heard."""
    out = tmp_path_factory.mktemp("spoken") / "run"
    short = encounter.model_copy(update={"duration_s": 25.0})
    return run(short, out=out, latency="fixed", report=False).folder


@pytest.fixture
def brief_file(encounter: Scenario, tmp_path: Path) -> Path:
    """The first 12 s of the encounter as a file."""
    path = tmp_path / "brief.json"
    path.write_text(json.dumps(shortened(encounter.model_dump(mode="json"), 12.0)))
    return path


@pytest.fixture(scope="session")
def airport_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run of 6 s at an airport, without sound and pictures."""
    out = tmp_path_factory.mktemp("airport") / "run"
    short = nominal("s01b_dropped_hold").model_copy(update={"duration_s": 6.0, "cameras": ()})
    return run(short, out=out, latency="fixed", assistant="none", speech=False, report=False).folder


@pytest.fixture(scope="session")
def noisy_seat(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run in which the pilot has a worse receiver than the units' site."""
    radio = tower().radio.model_copy(
        update={"receivers": {"AAL123": ReceiverRadio(snr_db=0.0)}, "snr_db": 30.0}
    )
    out = tmp_path_factory.mktemp("noisy") / "run"
    words = spoken("Washington_Tower", 4.0, voice("American one two three, cleared to land"))
    scenario = tower(10.0).model_copy(update={"radio": radio})
    logged(scenario, out, ["tower", "AAL123"], words, speech=True)
    return out


@pytest.fixture
def seat() -> Iterator[tuple[PretendedRun, str]]:
    """A run that is only pretended, and the URL of its page."""
    with seat_page() as served:
        yield served
