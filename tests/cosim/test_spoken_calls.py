"""Spoken calls of people at seats: on the frequency, recognised, understood, done and recorded."""

from __future__ import annotations

import json
from base64 import b64encode
from pathlib import Path

import numpy as np
import pytest

from airhilt.audio.pcm import SAMPLE_RATE_HZ, to_pcm
from airhilt.cosim.recorded import UnregisteredMessage
from airhilt.cosim.replay import replay
from airhilt.errors import RunFolderError
from airhilt.sensors.radio.microphones import LONGEST_CALL_S
from seats import (
    SECOND,
    act,
    acts,
    calls,
    cards,
    contents,
    logged,
    notices,
    spoken,
    states,
    tower,
    voice,
)

TURN = "American one two three, turn left heading two seven zero"
LANDING = "American one two three, runway zero one, cleared to land"
SEAT = "Washington_Tower"


def holding(t_s: float, for_s: float, seat: str = SEAT) -> list[UnregisteredMessage]:
    """Return the messages of somebody who holds the button and says nothing."""
    return spoken(seat, t_s, np.zeros(round(for_s * SAMPLE_RATE_HZ), np.float32))


def test_a_crew_reads_back_and_does_what_was_recognised_and_it_replays(tmp_path: Path) -> None:
    said = [act(SEAT, 1.0, "take"), *spoken(SEAT, 5.0, voice(TURN))]
    log = logged(tower(20.0), tmp_path / "run", ["tower"], said, speech=True)
    first, readback = calls(log)[:2]
    assert (first["speaker"], first["text"], first["is_from_microphone"]) == (
        "Washington Tower", "", True,
    )  # fmt: skip
    assert first["t_tx_ns"] == 5 * SECOND
    assert "heading two seven zero" in contents(log, "asr/")[0]["text"]
    assert (readback["speaker"], readback["in_reply_to"]) == ("AAL123", first["id"])
    done = [one for one in contents(log, "truth/event") if one["kind"] == "command"]
    assert json.loads(done[0]["text"])["action"] == "track"
    (row,) = json.loads((tmp_path / "run" / "summary.json").read_text())["people"][0]["calls"]
    assert (row["call"], row["answer"]) == (first["id"], readback["text"])
    assert row["recognised"] == contents(log, "asr/")[0]["text"]
    verdict = replay(tmp_path / "run")
    assert verdict.identical, str(verdict)


def test_what_is_not_recognised_with_confidence_is_asked_for_again(tmp_path: Path) -> None:
    said = spoken(SEAT, 5.0, voice(TURN))
    log = logged(tower(20.0), tmp_path / "run", ["tower"], said, speech=True, snr_db=-3.0)
    assert contents(log, "truth/hearing/AAL123")[0]["outcome"] == "unsure"
    assert calls(log)[1]["text"].startswith("Say again")
    assert not [one for one in contents(log, "truth/event") if one["kind"] == "command"]


def test_a_spoken_call_of_the_script_is_done_once_it_is_taken(tmp_path: Path) -> None:
    said = spoken(SEAT, 3.0, voice(LANDING))
    log = logged(tower(12.0), tmp_path / "run", ["tower"], said, speech=True)
    assert [one["line"] for one in cards(log, SEAT)] == ["landing"]
    assert not states(log, SEAT)[-1]["tasks"]
    assert calls(log)[1]["id"] == "landing_readback"


def test_two_who_press_at_once_block_each_other_and_both_are_told(tmp_path: Path) -> None:
    said = [*holding(2.0, 2.0), *holding(2.5, 2.0, "AAL123")]
    seats = ["tower", "AAL123"]
    log = logged(tower(8.0), tmp_path / "run", seats, sorted(said, key=lambda one: one.t_ns),
                 speech=True)  # fmt: skip
    assert [len(one["blocked_by"]) for one in calls(log)] == [1, 1]
    assert not contents(log, "truth/hearing/")
    for seat in (SEAT, "AAL123"):
        assert "blocked" in notices(log, seat)[0]


def test_a_call_that_is_too_long_is_cut_and_its_person_told(tmp_path: Path) -> None:
    held = holding(1.0, LONGEST_CALL_S + 5.0)
    log = logged(tower(70.0), tmp_path / "run", ["tower"], held, speech=True)
    (call,) = [one for one in calls(log) if one["is_from_microphone"]]
    assert call["t_end_ns"] - call["t_tx_ns"] == LONGEST_CALL_S * SECOND
    assert notices(log, SEAT) == ["Your call was cut after 60 s."]


def test_a_microphone_whose_sound_does_not_come_any_more_is_released(tmp_path: Path) -> None:
    pressed = [act(SEAT, 1.0, "press")]
    log = logged(tower(8.0), tmp_path / "run", ["tower"], pressed, speech=True)
    (call,) = [one for one in calls(log) if one["is_from_microphone"]]
    assert call["t_end_ns"] == 4 * SECOND
    assert "no sound came" in notices(log, SEAT)[0]


def test_sound_that_comes_faster_than_anybody_speaks_is_cut(tmp_path: Path) -> None:
    half_a_second = b64encode(bytes(SAMPLE_RATE_HZ)).decode()
    said = (act(SEAT, 1.5, "say", pcm=half_a_second) for _ in range(8))
    given = [act(SEAT, 1.0, "press"), *said]
    log = logged(tower(8.0), tmp_path / "run", ["tower"], given, speech=True)
    assert "more sound came" in notices(log, SEAT)[0]
    (call,) = [one for one in calls(log) if one["is_from_microphone"]]
    assert call["t_end_ns"] - call["t_tx_ns"] < 4 * SECOND


def test_without_recording_of_voices_neither_log_nor_folder_has_them(tmp_path: Path) -> None:
    said = spoken(SEAT, 2.0, voice("hello"))
    out = tmp_path / "run"
    log = logged(tower(6.0), out, ["tower"], said, speech=True, voice_recording=False)
    pcm = to_pcm(voice("hello"))[6400:9600]
    assert {one.get("pcm", "") for one in acts(log, SEAT)} == {""}
    assert b64encode(pcm) not in b"".join(one.data for one in log)
    assert not list((out / "audio").glob("microphone*"))
    assert not states(log, SEAT)[0]["voice_is_recorded"]
    with pytest.raises(RunFolderError, match="no-voice-recording"):
        replay(out)


def test_calls_of_people_are_no_stuck_microphones(tmp_path: Path) -> None:
    logged(tower(3.5), tmp_path / "run", ["tower"], holding(1.0, 2.0), speech=True)
    radio = json.loads((tmp_path / "run" / "summary.json").read_text())["radio"]
    assert (radio["transmissions"], radio["stuck_microphone"]) == (1, 0)
    assert radio["hallucinated"] is None
