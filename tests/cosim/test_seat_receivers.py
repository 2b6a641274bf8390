"""Seats whose receiver is worse than others: they hear their own sound, and it is recorded."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from airhilt.audio.pcm import from_pcm
from airhilt.cosim.replay import replay
from airhilt.messages import SeatAudioClosed, Transmission
from airhilt.record import Logged, RunFolder
from airhilt.record.audio import audio_file, recorded_pcm
from airhilt.scenario import Scenario
from airhilt.scenario.models.radio import ReceiverRadio
from seats import act, contents, logged, spoken, states, tower, voice

SEAT = "Washington_Tower"
SAID = spoken(SEAT, 5.0, voice("American one two three, go around"))
LEFT = act(SEAT, 3.0, "leave")
"""The tower's person leaves, so that the script goes on and the pilot hears something."""


def noisy(duration_s: float = 12.0, **receivers: float) -> Scenario:
    scenario = tower(duration_s)
    given = {name: ReceiverRadio(snr_db=snr_db) for name, snr_db in receivers.items()}
    radio = scenario.radio.model_copy(update={"snr_db": 20.0, "receivers": given})
    return scenario.model_copy(update={"radio": radio})


def streamed(log: list[Logged], seat: str) -> list[dict[str, Any]]:
    return contents(log, f"seat/{seat}/audio")


def test_a_pilot_with_a_bad_receiver_hears_each_call_with_more_noise(tmp_path: Path) -> None:
    log = logged(noisy(AAL123=-5.0), tmp_path / "run", ["AAL123"], speech=True)
    assert states(log, "AAL123")[0]["has_own_receiver"]
    closed = [one for one in streamed(log, "AAL123") if one["phase"] == "closed"]
    whole = [one for one in contents(log, "radio/") if "phase" not in one]
    assert [(one["id"], one["snr_db"]) for one in closed] == [
        (one["id"], -5.0) for one in whole if one["snr_db"] == 20.0
    ]
    folder = RunFolder(tmp_path / "run")
    at_site = recorded_pcm(folder.audio_path, Transmission.model_validate(whole[0]))
    at_seat = recorded_pcm(folder.audio_path, SeatAudioClosed.model_validate(closed[0]))
    assert len(at_site) == len(at_seat)
    assert from_pcm(at_site).std() > 0.0
    assert at_site != at_seat


def test_what_a_person_speaks_is_heard_so_too_and_the_run_repeats(tmp_path: Path) -> None:
    out = tmp_path / "run"
    log = logged(noisy(AAL123=3.0), out, ["tower", "AAL123"], SAID, speech=True)
    (closed,) = [one for one in streamed(log, "AAL123") if one["phase"] == "closed"]
    assert closed["id"].startswith("microphone.")
    assert closed["snr_db"] == 3.0
    assert not streamed(log, SEAT)
    verdict = replay(out)
    assert verdict.identical, verdict.difference


def test_a_receiver_changes_nothing_but_the_sound_of_its_seat(tmp_path: Path) -> None:
    scenarios = {"without": noisy(), "with": noisy(AAL123=3.0)}
    logs = {
        name: logged(one, tmp_path / name, ["tower", "AAL123"], SAID, speech=True)
        for name, one in scenarios.items()
    }
    assert not [one for one in logs["without"] if one.key.endswith("/audio") and "seat" in one.key]
    told = {
        name: [(one.key, one.t_ns, one.data) for one in log if not one.key.startswith("seat/")]
        for name, log in logs.items()
    }
    assert told["without"] == told["with"]


def test_where_nobody_may_sit_there_is_no_sound_of_a_seat(tmp_path: Path) -> None:
    log = logged(noisy(2.0, AAL123=3.0), tmp_path / "run", ["tower"], speech=True)
    assert not streamed(log, "AAL123")
    assert not states(log, SEAT)[0]["has_own_receiver"]


@pytest.mark.parametrize("is_recorded", [True, False])
def test_the_voice_of_a_person_is_kept_at_a_seat_only_where_voices_are_recorded(
    tmp_path: Path, is_recorded: bool
) -> None:
    out = tmp_path / "run"
    log = logged(
        noisy(8.0, AAL123=3.0), out, ["tower", "AAL123"], SAID, speech=True,
        voice_recording=is_recorded,
    )  # fmt: skip
    (closed,) = [one for one in streamed(log, "AAL123") if one["phase"] == "closed"]
    file = audio_file(out / "audio", SeatAudioClosed.model_validate(closed))
    assert file.exists() is is_recorded


def test_a_run_without_speech_tells_a_seat_when_its_frequency_is_busy(tmp_path: Path) -> None:
    log = logged(noisy(AAL123=3.0), tmp_path / "run", ["tower", "AAL123"], [LEFT])
    phases = [one["phase"] for one in streamed(log, "AAL123")]
    assert phases[:2] == ["opened", "closed"]
