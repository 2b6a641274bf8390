"""What the report of a run shows of its radio."""

from __future__ import annotations

import base64
import io
import wave
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from airhilt.report import sounds, write_report
from radio_folder import RadioFolder, busy_radio
from report_pages import shown as data


@pytest.fixture
def radio(tmp_path: Path) -> RadioFolder:
    return RadioFolder(tmp_path / "run")


def shown(folder: Path) -> dict[str, Any]:
    return data(write_report(folder))


def test_calls_are_in_the_order_in_which_they_began(tmp_path: Path) -> None:
    calls = shown(busy_radio(tmp_path / "run"))["sections"]["radio"]["calls"]
    assert [call["id"] for call in calls] == [
        "clearance", "readback", "carrier", "roger", "distant"
    ]  # fmt: skip
    first = calls[0]
    assert (first["from"], first["to"], first["who"], first["addressed"]) == (
        1.0, 4.0, "Tower", "AAL123"
    )  # fmt: skip
    assert first["hearings"][0]["outcome"] == "misheard"
    assert calls[3]["blocked_by"] == ["carrier"]
    assert [call["received"] for call in calls] == [True, True, True, True, False]


def test_words_that_differ_are_told_apart_from_those_that_do_not(radio: RadioFolder) -> None:
    radio.call("roger", 1.0, "American 123, roger", "american one two three wilco")
    (call,) = shown(radio.close())["sections"]["radio"]["calls"]
    (transcript,) = call["transcripts"]
    kinds = [(one["kind"], one["said"], one["heard"]) for one in transcript["words"]]
    assert kinds == [
        ("equal", "american one two three", "american one two three"),
        ("substitute", "roger", "wilco"),
    ]
    assert (transcript["confidence"], transcript["after_end_s"]) == (0.83, 0.25)


def test_sound_lies_in_the_page_with_all_that_a_radio_carries(radio: RadioFolder) -> None:
    radio.call("roger", 1.0, "Roger", seconds=2.0)
    (call,) = shown(radio.close())["sections"]["radio"]["calls"]
    kind, _, encoded = call["sound"]["src"].partition(",")
    assert kind == "data:audio/wav;base64"
    with wave.open(io.BytesIO(base64.b64decode(encoded))) as file:
        assert (file.getframerate(), file.getnframes()) == (8_000, 16_000)
        samples = np.frombuffer(file.readframes(16_000), "<i2")
    assert np.abs(np.fft.rfft(samples)).argmax() / 2.0 == pytest.approx(500.0, abs=1.0)
    assert np.abs(samples[100:-100]).max() == pytest.approx(0.3 * 32_768, rel=0.03)


def test_spoken_advisories_have_their_sound_and_how_late_they_were(radio: RadioFolder) -> None:
    radio.voice("decision-1", 4.0, "AAL123 go around")
    (voice,) = shown(radio.close())["sections"]["radio"]["advisories"]
    assert (voice["from"], voice["to"], voice["said"]) == (4.0, 5.0, "AAL123 go around")
    assert voice["after_decision_s"] == pytest.approx(0.2)
    assert "src" in voice["sound"]


def test_sound_that_has_no_room_is_a_link_to_its_file(
    radio: RadioFolder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sounds, "MOST_CHARACTERS", 30_000)
    for number in range(3):
        radio.call(f"call{number}", 2.0 * number, "Roger")
    folder = radio.close()
    page = shown(folder)
    inside, *links = (call["sound"] for call in page["sections"]["radio"]["calls"])
    assert "src" in inside
    assert links == [{"href": "audio/call1.wav"}, {"href": "audio/call2.wav"}]
    assert all((folder / link["href"]).is_file() for link in links)
    assert any("2 calls and advisories" in note for note in page["notes"])
    elsewhere = data(write_report(folder, tmp_path / "page.html"))
    assert elsewhere["sections"]["radio"]["calls"][1]["sound"] == {"href": "run/audio/call1.wav"}


def test_sound_of_something_else_is_not_played(radio: RadioFolder) -> None:
    radio.call("one", 1.0, "Roger").call("two", 3.0, "Roger").call("three", 5.0, "Roger", seconds=2)
    folder = radio.close()
    (folder / "audio" / "one.wav").unlink()
    (folder / "audio" / "three.wav").replace(folder / "audio" / "two.wav")
    page = shown(folder)
    assert [call["sound"] for call in page["sections"]["radio"]["calls"]] == [None, None, None]
    assert any("sound of 3 calls" in note for note in page["notes"])
