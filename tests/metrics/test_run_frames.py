"""The frames of a run have what was published, at the time at which it was."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

import airhilt
from airhilt.errors import RunFolderError
from airhilt.messages import (
    Advisory,
    CameraView,
    ConflictTruth,
    Detection,
    Detections,
    Event,
    Evidence,
    Message,
    RunwayTruth,
    Severity,
    Turn,
)
from airhilt.record import RunFolder
from airhilt.scenario import Scenario
from airhilt.units import SECOND_NS
from damage import flip
from radio_folder import RadioFolder, busy_radio

VIEW = CameraView(
    latitude_deg=38.9, longitude_deg=-77.0, height_m=30.0, heading_deg=0.0, pitch_deg=0.0,
    roll_deg=0.0, horizontal_fov_deg=60.0, width_px=640, height_px=360,
)  # fmt: skip


def published(message: Message, column: str) -> Any:
    """Return what the column of a message must have."""
    if not hasattr(message, column):
        time_ns = getattr(message, f"{column.removesuffix('_s')}_ns")
        return None if time_ns is None else time_ns / SECOND_NS
    value = getattr(message, column)
    return "; ".join(value) if isinstance(value, tuple) else value


def assert_as_published(frame: pd.DataFrame, messages: list[Any]) -> None:
    assert messages
    assert frame.index.tolist() == [each.t_ns / SECOND_NS for each in messages]
    for name in frame.columns:
        for cell, message in zip(frame[name], messages, strict=True):
            expected = published(message, name)
            assert pd.isna(cell) if expected is None else cell == expected, (name, message)


@pytest.mark.parametrize(("method", "key"), [("states", "truth/state"), ("adsb", "adsb")])
def test_frames_of_a_flight_have_each_message_as_it_was_published(
    recorded_run: Path, method: str, key: str
) -> None:
    run = airhilt.open_run(recorded_run)
    assert_as_published(getattr(run, method)(), list(run.messages(key)))


@pytest.mark.parametrize(("method", "key"), [("calls", "truth/radio"), ("transcripts", "asr")])
def test_frames_of_the_radio_have_each_message_as_it_was_published(
    tmp_path: Path, method: str, key: str
) -> None:
    run = airhilt.open_run(busy_radio(tmp_path / "run"))
    assert_as_published(getattr(run, method)(), list(run.messages(key)))


def test_a_detection_is_a_row_with_its_box_and_its_picture(tmp_path: Path) -> None:
    folder = RadioFolder(tmp_path / "run")
    seen = [
        Detection(label="truck", confidence=0.9, box=(1.0, 2.0, 3.0, 5.0), track_id=7, hits=4),
        Detection(label="deer", confidence=0.5, box=(10.0, 20.0, 30.0, 50.0)),
    ]
    for seq, found in enumerate(([], seen)):
        times = {"t_ns": seq * SECOND_NS + 1, "t_frame_ns": seq * SECOND_NS}
        looked = Detections(
            **times, camera="tower", seq=seq, view=VIEW, detections=found, engine="mine"
        )
        folder.write("vision/tower", looked)
    truck, deer = airhilt.open_run(folder.close()).detections().to_dict("records")
    assert truck == {
        "camera": "tower", "seq": 1, "t_frame_s": 1.0, "label": "truck", "confidence": 0.9,
        "left_px": 1.0, "top_px": 2.0, "right_px": 3.0, "bottom_px": 5.0, "track_id": 7, "hits": 4,
        "engine": "mine",
    }  # fmt: skip
    assert (deer["label"], deer["bottom_px"], deer["hits"]) == ("deer", 50.0, 1)
    assert pd.isna(deer["track_id"])


def test_an_advisory_is_a_row_with_its_evidence_and_what_it_recommends(tmp_path: Path) -> None:
    folder = RadioFolder(tmp_path / "run")
    shared: dict[str, Any] = {
        "revision": 0, "kind": "loss_of_separation", "severity": Severity.WARNING,
        "recipients": ("AAL1", "ATC"), "traffic": ("AAL1", "DAL2"), "message": "Turn right",
    }  # fmt: skip
    evidence = Evidence(sources=("adsb", "asr"), time_to_loss_s=40.0)
    first = Advisory(
        t_ns=2 * SECOND_NS, id="mine-1", recipient="AAL1", **shared, evidence=evidence,
        recommendation=Turn(degrees=30.0), t_ready_ns=SECOND_NS,
    )  # fmt: skip
    folder.write("advisory/AAL1", first)
    frame = airhilt.open_run(folder.close()).advisories()
    (row,) = frame.to_dict("records")
    assert (row["severity"], row["traffic"], row["t_ready_s"]) == ("WARNING", "AAL1; DAL2", 1.0)
    assert (row["evidence_sources"], row["evidence_time_to_loss_s"]) == ("adsb; asr", 40.0)
    assert (row["recommendation_action"], row["recommendation_degrees"]) == ("turn", 30.0)
    assert pd.isna(row["recommendation_altitude_ft"])
    assert frame.attrs["units"]["recommendation_degrees"] == "deg"
    assert "if nobody reacts" in frame.attrs["descriptions"]["evidence_time_to_loss_s"]


def test_what_happened_is_in_one_frame_in_the_order_of_time(tmp_path: Path) -> None:
    folder = RadioFolder(tmp_path / "run")
    conflict = ConflictTruth(
        t_ns=SECOND_NS, phase="opened", actors=("AAL1", "TRUCK1"), horizontal_m=900.0, runway="01"
    )
    folder.write("truth/conflict", conflict)
    runway = RunwayTruth(t_ns=2 * SECOND_NS, runway="01-19", occupants=("TRUCK1",), arrivals=())
    folder.write("truth/runway/01_19", runway)
    event = Event(t_ns=3 * SECOND_NS, kind="pilot_reacts", subject="AAL1", text="goes around")
    folder.write("truth/event", event)
    frame = airhilt.open_run(folder.close()).truth()
    assert frame.index.tolist() == [1.0, 2.0, 3.0]
    assert frame["kind"].tolist() == ["opened", "runway", "pilot_reacts"]
    assert frame["subject"].tolist() == ["AAL1; TRUCK1", "TRUCK1", "AAL1"]
    assert frame["runway"].tolist()[:2] == ["01", "01-19"]
    assert (frame["horizontal_m"].iloc[0], frame["text"].iloc[2]) == (900.0, "goes around")


def test_a_step_of_a_worker_is_a_row_at_the_time_of_its_result(recorded_run: Path) -> None:
    lines = [json.loads(line) for line in (recorded_run / "latency.jsonl").read_text().splitlines()]
    frame = airhilt.open_run(recorded_run).latencies()
    assert frame["seq"].tolist() == [line["seq"] for line in lines]
    assert frame["latency_s"].tolist() == [line["latency_ns"] / SECOND_NS for line in lines]
    assert frame.index.tolist() == [
        (line["t_start_ns"] + line["latency_ns"]) / SECOND_NS for line in lines
    ]


def test_a_run_without_such_messages_gives_an_empty_frame_with_its_columns(
    tmp_path: Path,
) -> None:
    frames = airhilt.open_run(RadioFolder(tmp_path / "run").close()).frames()
    assert all(frame.empty and frame.index.name == "t_s" for frame in frames.values())
    assert {"camera", "label", "left_px", "confidence"} <= set(frames["detections"].columns)
    assert frames["states"].dtypes["latitude_deg"] == "float64"


def test_of_a_damaged_log_the_frames_have_what_can_be_read(run_copy: Path) -> None:
    whole = airhilt.open_run(run_copy).states()
    flip(run_copy / "log.mcap", 8 * 2500)
    with pytest.warns(UserWarning, match=r"log\.mcap: damaged from"):
        damaged = airhilt.open_run(run_copy)
    left = damaged.states()
    assert 0 < len(left) < len(whole)
    assert damaged.damage
    kept = whole.reset_index().merge(left.reset_index(), how="inner")
    assert len(kept) == len(left), "each row is one that the run wrote"


def test_a_message_that_no_version_writes_is_named_with_its_key(tmp_path: Path) -> None:
    folder = RadioFolder(tmp_path / "run")
    folder.write("truth/state/AAL1", Event(kind="finished", subject="run", text=""))
    event = RunwayTruth(runway="01", occupants=(), arrivals=())
    folder.write("truth/conflict", event)
    run = airhilt.open_run(folder.close())
    with pytest.raises(RunFolderError, match=r"log\.mcap: truth/conflict: .*this version"):
        run.truth()
    with pytest.raises(RunFolderError, match=r"log\.mcap: truth/state/AAL1: .*this version"):
        list(run.messages("truth/state"))


def test_messages_are_those_of_a_key_and_below_it(tmp_path: Path) -> None:
    run = airhilt.open_run(busy_radio(tmp_path / "run"))
    every = [type(each).__name__ for each in run.messages()]
    transcripts = list(run.messages("asr/119100"))
    assert transcripts == list(run.messages("asr"))
    assert len(transcripts) == every.count("Transcript")
    assert list(run.messages("as")) == []


def test_a_run_that_was_made_and_one_that_was_opened_are_the_same(
    encounter: Scenario, tmp_path: Path
) -> None:
    brief = encounter.model_copy(update={"duration_s": 2.0})
    made = airhilt.run(brief, out=tmp_path / "run", assistant="none", speech=False, report=False)
    opened = airhilt.open_run(tmp_path / "run")
    assert type(made) is type(opened) is airhilt.Result
    assert (made.folder, made.summary) == (opened.folder, opened.summary)
    pd.testing.assert_frame_equal(made.states(), opened.states())
    assert "encounter, seed 0" in made._repr_html_() == opened._repr_html_()


def test_a_notebook_shows_a_run_that_has_no_numbers(tmp_path: Path) -> None:
    path = busy_radio(tmp_path / "<b>run")
    assert "summary.json: missing" in airhilt.open_run(path)._repr_html_()
    assert "<b>run" not in airhilt.open_run(path)._repr_html_()
    folder = RunFolder(path)
    folder.summary_path.write_text('{"scenario": 7}')
    with pytest.raises(RunFolderError, match=r"summary\.json: .*this version"):
        _ = airhilt.open_run(path).summary
