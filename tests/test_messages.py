"""Every message on the bus is JSON with a schema, and says nothing that its schema does not."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest
from pydantic import TypeAdapter, ValidationError

from airhilt.messages import (
    BUS_MESSAGES,
    WORKER_MESSAGES,
    WORKER_OUTPUTS,
    ActorCommand,
    ActorTruth,
    AdsbReport,
    Advisory,
    Climb,
    Detection,
    Event,
    MaintainLevel,
    PageRefusal,
    PartialTranscript,
    RadarPlot,
    Recommendation,
    SeatAction,
    Severity,
    Status,
    Transcript,
    Turn,
    WorkerDescription,
    bus_message,
    json_schemas,
)

MODELS = {**BUS_MESSAGES, **WORKER_MESSAGES}

VIEW = {
    "latitude_deg": 38.8, "longitude_deg": -77.0, "height_m": 57.0, "heading_deg": 25.0,
    "pitch_deg": -4.0, "roll_deg": 0.0, "horizontal_fov_deg": 70.0, "width_px": 640,
    "height_px": 360, "carrier": None,
}  # fmt: skip
BOX = [10.0, 20.0, 45.5, 31.0]

EXAMPLES: dict[str, dict[str, Any]] = {
    "CameraInfo": {
        "camera": "tower", "rate_hz": 16.0, "width_px": 640, "height_px": 360,
        "horizontal_fov_deg": 70.0, "own_aircraft": [100, 20, 230280],
    },
    "CameraFrame": {
        "camera": "tower", "seq": 3, "t_frame_ns": 7, "view": VIEW, "sha256": "ab",
    },
    "Detections": {
        "camera": "tower", "seq": 3, "t_frame_ns": 7, "view": VIEW, "engine": "embedded",
        "detections": [
            {"label": "airplane", "confidence": 0.7, "box": BOX, "track_id": 4, "hits": 2},
        ],
    },
    "CameraTruth": {
        "camera": "tower", "seq": 3, "t_frame_ns": 7,
        "sightings": [{
            "actor": "AAL1", "label": "airplane", "box": BOX, "pixels": 120.5,
            "visible_fraction": 0.5, "truncation": 0.0, "range_m": 900.0, "transmission": 0.7,
        }],
    },
    "Clock": {"run": "r1", "phase": "running", "pace": "virtual"},
    "Briefing": {
        "controller": "Centre", "horizontal_separation_nm": 5.0, "vertical_separation_ft": 1000.0,
    },
    "Status": {"modality": "adsb", "state": "lost", "cause": "outage"},
    "Transmission": {"id": "a", "frequency_khz": 134325, "t_tx_ns": 1, "t_end_ns": 2, "samples": 9},
    "TransmissionOpened": {"id": "a", "frequency_khz": 134325, "t_tx_ns": 1},
    "TransmissionChunk": {
        "id": "a", "frequency_khz": 134325, "seq": 2, "first_sample": 16_000, "samples": 9,
        "sha256": "ab",
    },
    "TransmissionClosed": {
        "id": "a", "frequency_khz": 134325, "t_tx_ns": 1, "t_end_ns": 2, "samples": 9,
        "snr_db": 10.0,
    },
    "SeatAudioOpened": {"id": "a", "frequency_khz": 134325, "t_tx_ns": 1, "seat": "AAL1"},
    "SeatAudioChunk": {
        "id": "a", "frequency_khz": 134325, "seq": 2, "first_sample": 16_000, "samples": 9,
        "sha256": "ab", "seat": "AAL1",
    },
    "SeatAudioClosed": {
        "id": "a", "frequency_khz": 134325, "t_tx_ns": 1, "t_end_ns": 2, "samples": 9,
        "snr_db": 3.0, "seat": "AAL1",
    },
    "AdsbReport": {
        "icao24": "a1b2c3", "callsign": None, "latitude_deg": 1.5, "longitude_deg": -2.5,
        "altitude_ft": 35000.0, "ground_speed_kt": 450.0, "track_deg": 359.5,
        "vertical_rate_fpm": -64.0, "nacp": 9, "nacv": 2, "receiver": "r",
        "t_adsb_in_ns": 1, "t_adsb_out_ns": 2,
    },
    "RadarInfo": {
        "site": "KDCA", "kind": "terminal", "latitude_deg": 38.9, "longitude_deg": -77.0,
        "altitude_m": 27.5, "rotation_s": 4.8, "primary_range_m": 111120.0,
        "secondary_range_m": 222240.0,
    },
    "RadarPlot": {
        "site": "KDCA", "kind": "combined", "t_plot_ns": 1, "range_m": 9000.5,
        "azimuth_deg": 359.5, "mode_a": "1200", "mode_c_ft": -100,
    },
    "SurfaceTrack": {
        "airport": "KDCA", "track": 3, "kind": "combined", "t_track_ns": 1, "latitude_deg": 38.9,
        "longitude_deg": -77.0, "accuracy_m": 7.5, "altitude_ft": None, "on_ground": True,
        "ground_speed_kt": 14.0, "track_deg": 85.0, "icao24": "a0f001", "callsign": "OPS1",
    },
    "CockpitInstruments": {
        "callsign": "AAL1", "airspeed_kt": 280.5, "mach": 0.78, "altitude_ft": 35000,
        "vertical_speed_fpm": -700, "north": "magnetic", "heading_deg": 359.5, "track_deg": 1.0,
        "ground_speed_kt": 450.0, "pitch_deg": 2.5, "roll_deg": -25.0, "gear": 0.0, "flaps": 0.0,
        "on_ground": False, "mode": "en_route", "selected_altitude_ft": 33000,
        "selected_airspeed_kt": 280,
    },
    "VehiclePosition": {
        "callsign": "OPS1", "latitude_deg": 38.9, "longitude_deg": -77.0, "heading_deg": 85.0,
        "ground_speed_kt": 14.0,
    },
    "TcasReply": {
        "callsign": "AAL1", "own_icao24": "a1b2c3", "mode": "S", "icao24": "a4d5e6",
        "range_m": 9260.5, "bearing_deg": 359.9, "altitude_ft": 35025, "has_tcas": True,
    },
    "Transcript": {
        "id": "a", "frequency_khz": 134325, "t_tx_ns": 1, "t_end_ns": 2, "text": "climb",
        "confidence": 0.9, "engine": "text",
    },
    "EnhancedTransmission": {
        "id": "a", "frequency_khz": 134325, "t_tx_ns": 1, "t_end_ns": 2, "samples": 3,
        "sha256": "00", "enhancer": "spectral",
    },
    "PartialTranscript": {
        "id": "a", "frequency_khz": 134325, "t_tx_ns": 1, "t_heard_ns": 2, "text": "climb",
        "confidence": 0.9, "stable_words": 1, "engine": "text",
    },
    "Advisory": {
        "id": "s-1", "revision": 2, "recipient": "AAL1", "recipients": ["AAL1", "ATC"],
        "kind": "loss_of_separation", "severity": "CAUTION", "traffic": ["AAL1", "DAL2"],
        "message": "traffic", "t_ready_ns": 5,
        "recommendation": {
            "action": "altitude", "sense": "climb", "altitude_ft": 36000.0,
            "vertical_rate_fpm": 1500.0,
        },
        "evidence": {"sources": ["adsb"], "time_to_loss_s": 61.5},
    },
    "EquipmentAlert": {
        "equipment": "tcas",
        "advisory": {
            "id": "e-1", "revision": 0, "recipient": "AAL1", "recipients": ["AAL1"],
            "kind": "loss_of_separation", "severity": "WARNING", "traffic": ["AAL1", "DAL2"],
            "message": "climb, climb", "evidence": {"sources": ["tcas"]}, "t_ready_ns": 5,
        },
    },
    "AdvisoryAudio": {
        "id": "s-1", "revision": 2, "recipient": "AAL1", "text": "traffic", "t_dec_ns": 5,
        "engine": "espeak", "samples": 3, "sha256": "ab",
    },
    "ModelExchange": {
        "model": "gpt-oss:20b", "task": "wording", "advisories": ["s-1"], "question": "{}",
        "answer": "{}", "failure": "",
        "rejections": [{"subject": "s-1 to ATC", "answered": "all clear", "reason": "no"}],
    },
    "ActorCommand": {"command": {"action": "turn", "degrees": -30.0}},
    "PageRefusal": {"text": "refused a page of another version"},
    "SeatAction": {"holder": "a1", "act": {"do": "text", "text": "American one, cleared to land"}},
    "SeatState": {
        "seat": "TOWER", "frequencies_khz": [118_300], "tuned_khz": [118_300],
        "is_recognised": True, "voice_is_recorded": True,
        "question": {"number": 1, "scale": "isa", "asked_ns": 5},
    },
    "ActorTruth": {
        "actor": "AAL1", "category": "aircraft", "icao24": "a1b2c3", "phase": "glide",
        "on_ground": False, "latitude_deg": 1.0, "longitude_deg": 2.0,
        "altitude_m": 3.0, "height_agl_m": 3.0, "velocity_north_m_s": 4.0,
        "velocity_east_m_s": 5.0, "velocity_down_m_s": 6.0, "roll_deg": 7.0, "pitch_deg": 8.0,
        "heading_deg": 9.0, "true_airspeed_m_s": 10.0, "calibrated_airspeed_m_s": 11.0,
        "target_altitude_m": 12.0,
    },
    "SpokenTruth": {
        "id": "a", "speaker": "AAL1", "addressed": None, "frequency_khz": 134325, "text": "roger",
        "t_tx_ns": 1, "t_end_ns": 2,
    },
    "HearingTruth": {
        "id": "a", "actor": "AAL1", "outcome": "misheard", "text": "rocker", "source": "ear",
    },
    "ConflictTruth": {"phase": "nmac", "actors": ["AAL1", "DAL2"], "horizontal_m": 100.5},
    "RunwayTruth": {
        "runway": "01-19", "occupants": ["OPS1"],
        "arrivals": [{"actor": "AAL1", "runway": "01", "time_to_threshold_s": 31.5}],
    },
    "DroppedMessages": {"keys": "advisory/*", "cause": "size", "messages": 3},
    "Event": {"kind": "command", "subject": "AAL1", "text": "climb"},
    "WorkerDescription": {
        "name": "asr", "modality": "asr", "inputs": [{"key": "radio/*/tx", "policy": "latest"}],
        "latency": {"median_s": 0.5, "sigma": 0.1},
    },
    "Grant": {
        "t_ns": 5, "seq": 0,
        "inputs": [{"key": "k", "t_in_ns": 4, "size": 9, "attachment": {"a": [1]}}],
    },
    "StepReply": {
        "seq": 0, "compute_s": 0.1, "outputs": [{"key": "asr/1", "size": 3, "t_out_ns": 9}],
        "wake_ns": 10,
    },
}  # fmt: skip


def made(model: type[Any], **changes: Any) -> Any:
    return model.model_validate(EXAMPLES[model.__name__] | changes)


def test_messages_say_nothing_that_their_schema_does_not_and_stay_as_they_are() -> None:
    for model in MODELS.values():
        message = made(model)
        assert model.model_validate_json(message.model_dump_json()) == message
        with pytest.raises(ValidationError, match="Extra inputs are not permitted"):
            made(model, colour="red")
        with pytest.raises(ValidationError, match="frozen"):
            setattr(message, next(iter(model.model_fields)), 1)


def test_every_message_on_the_bus_carries_its_time_which_is_never_negative() -> None:
    for model in BUS_MESSAGES.values():
        assert made(model).t_ns == 0
        with pytest.raises(ValidationError, match="greater than or equal to 0"):
            made(model, t_ns=-1)


def test_a_key_tells_the_class_of_its_messages_unless_it_has_several() -> None:
    for template, model in BUS_MESSAGES.items():
        key, _, one_of_several = template.partition(" ")
        key = re.sub(r"{\w+}", "A_1", key)
        assert bus_message(key) is (None if one_of_several else model), template
        assert bus_message(f"{key}/more/of/it") is None


def refuses_what_is_not_finite(model: Any, example: dict[str, Any], field: str) -> None:
    for value in ("NaN", "Infinity", "-Infinity"):
        text = json.dumps(example | {field: "HERE"}).replace('"HERE"', value)
        with pytest.raises(ValidationError):
            TypeAdapter(model).validate_json(text)


def test_numbers_are_finite() -> None:
    for model, field in (
        (AdsbReport, "latitude_deg"), (AdsbReport, "altitude_ft"), (ActorTruth, "altitude_m"),
        (Transcript, "confidence"),
    ):  # fmt: skip
        refuses_what_is_not_finite(model, EXAMPLES[model.__name__], field)
    climb = {
        "action": "altitude", "sense": "climb", "altitude_ft": 1.0, "vertical_rate_fpm": 1.0
    }  # fmt: skip
    refuses_what_is_not_finite(Recommendation, climb, "altitude_ft")
    refuses_what_is_not_finite(Recommendation, climb, "vertical_rate_fpm")
    refuses_what_is_not_finite(
        Recommendation, {"action": "maintain", "altitude_ft": 1.0}, "altitude_ft"
    )
    refuses_what_is_not_finite(Recommendation, {"action": "turn", "degrees": 1.0}, "degrees")


def test_a_recommendation_is_told_by_its_action() -> None:
    adapter = TypeAdapter(Recommendation)
    for recommendation in (
        Climb(sense="descend", altitude_ft=33_000.0, vertical_rate_fpm=1_500.0),
        MaintainLevel(altitude_ft=33_000.0),
        Turn(degrees=30.0),
    ):
        assert adapter.validate_json(recommendation.model_dump_json()) == recommendation
    with pytest.raises(ValidationError, match="does not match any of the expected tags"):
        adapter.validate_python({"action": "hover"})


def test_severities_rise_from_info_to_warning() -> None:
    order = [Severity.INFO, Severity.ADVISORY, Severity.CAUTION, Severity.WARNING]
    assert [severity.rank for severity in order] == [0, 1, 2, 3]
    assert list(Severity) == order
    assert made(Advisory, severity="WARNING").severity is Severity.WARNING


def test_what_cannot_be_is_refused(subtests: pytest.Subtests) -> None:
    for model, field, value in [
        (AdsbReport, "icao24", "A1B2C3"),
        (AdsbReport, "icao24", "a1b2c"),
        (AdsbReport, "track_deg", 360.0),
        (AdsbReport, "nacp", 12),
        (AdsbReport, "latitude_deg", 90.5),
        (RadarPlot, "mode_a", "1280"),
        (RadarPlot, "azimuth_deg", 360.0),
        (Transcript, "confidence", 1.1),
        (Advisory, "severity", "PANIC"),
        (Advisory, "revision", -1),
        (Event, "kind", "party"),
        (WorkerDescription, "name", "My Worker"),
        (WorkerDescription, "inputs", []),
    ]:
        with subtests.test(str((model, field, value))), pytest.raises(ValidationError):
            made(model, **{field: value})


def test_there_is_a_schema_for_every_key() -> None:
    schemas = json_schemas()
    assert set(schemas) == set(MODELS)
    assert json.loads(json.dumps(schemas)) == schemas
    for key, model in MODELS.items():
        assert schemas[key]["title"] == model.__name__
        assert set(schemas[key]["properties"]) == set(model.model_fields)
        assert schemas[key]["additionalProperties"] is False


def test_the_schema_has_the_limit_of_every_key_that_others_publish_on() -> None:
    limits = {
        key: schema["x-airhilt-limit"]
        for key, schema in json_schemas().items()
        if "x-airhilt-limit" in schema
    }
    assert limits["advisory/{recipient}"] == {"size_bytes": 32_000, "rate_hz": 50}
    assert {MODELS[key] for key in limits} == {
        *WORKER_OUTPUTS.values(), PartialTranscript, ActorCommand, PageRefusal, SeatAction,
    }  # fmt: skip


def test_what_a_worker_may_publish_is_on_the_bus_and_no_truth() -> None:
    for first, model in WORKER_OUTPUTS.items():
        assert model in BUS_MESSAGES.values()
        assert first != "truth"


def test_a_detection_whose_box_has_no_room_is_refused() -> None:
    for box in ((5.0, 5.0, 5.0, 5.0), (30.0, 10.0, 8.0, 6.0), (1.0, 9.0, 8.0, 2.0)):
        with pytest.raises(ValidationError, match="no width and height"):
            Detection(label="airplane", confidence=0.5, box=box)


def test_a_modality_that_is_no_text_is_refused_as_any_wrong_value() -> None:
    for modality in (["asr"], {"asr": 1}, None, 7):
        with pytest.raises(ValidationError, match="modality"):
            Status.model_validate({"modality": modality, "state": "on"})
