"""Scores of recognisers: by lineage, with what calls mean, for calls of every kind."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import asr_speech
import eval_asr

TURN = "delta four five six turn left heading two seven zero"
CALLS: list[dict[str, Any]] = [
    {
        "text": TURN,
        "callsign": "DAL456",
        "roster": ["DAL456", "UAL12"],
        "items": [
            {"kind": "heading", "value": 270, "unit": "deg", "manner": "left", "status": "now",
             "begins": None, "ends": None}
        ],
    },
    {"text": "ops one all clear", "callsign": "OPS", "roster": ["OPS", "UAL12"], "items": []},
]  # fmt: skip


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    calls = tmp_path / "exam.jsonl"
    calls.write_text("".join(f"{json.dumps(call)}\n" for call in CALLS))
    asr_speech.write(tmp_path / "shards", "espeak", 0, 0, "en-us+m1", calls=calls)
    return tmp_path / "shards"


def test_each_lineage_is_scored_at_each_ratio_with_what_its_calls_mean(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(eval_asr, "RATIOS", (None,))
    monkeypatch.setattr(eval_asr, "SILENT_CALLS", 1)
    (row,) = eval_asr.evaluate("embedded", folder, 10)
    assert (row["lineage"], row["snr_db"], row["calls"]) == ("espeak", None, 2)
    assert row["items"] == 100.0
    assert row["wer"] < 40.0
    assert "| espeak, 2 calls | clean |" in capsys.readouterr().out


def test_a_lineage_that_is_not_asked_for_is_left_out(folder: Path) -> None:
    assert eval_asr.evaluate("embedded", folder, 10, ("pico",)) == []


def test_a_callsign_without_digits_is_never_one_digit_off(folder: Path) -> None:
    calls = [each for _, utterances in eval_asr.sets_of(folder, 10) for each in utterances]
    assert 0.0 <= eval_asr.misled(calls, "embedded", 10.0) <= 1.0


def test_the_roster_of_an_exam_is_the_one_it_names(folder: Path) -> None:
    ((_, calls),) = eval_asr.sets_of(folder, 10)
    assert eval_asr.rosters_for(calls) == [("DAL456", "UAL12"), ("OPS", "UAL12")]
