"""One message of each kind that reaches workers, to try a worker without a run."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator

from airhilt.messages import (
    AdsbReport,
    Advisory,
    AdvisoryAudio,
    Briefing,
    CameraFrame,
    CameraInfo,
    CameraView,
    Clock,
    Detection,
    Detections,
    Evidence,
    Message,
    RosterEntry,
    Severity,
    Status,
    Transcript,
    Transmission,
)
from airhilt.sim.worker import Input
from airhilt.units import SECOND_NS

CALLSIGNS, ADDRESSES = ("AAL123", "DAL456"), ("a00001", "a00002")
"""Callsigns and addresses of the aircraft in the samples."""
NAMES = (*CALLSIGNS, *ADDRESSES)
SILENCE = bytes(32_000)
"""PCM of one second."""
VIEW = CameraView(
    latitude_deg=38.85,
    longitude_deg=-77.04,
    height_m=10.0,
    heading_deg=0.0,
    pitch_deg=0.0,
    roll_deg=0.0,
    horizontal_fov_deg=40.0,
    width_px=64,
    height_px=48,
)
PIXELS = bytes(3 * VIEW.width_px * VIEW.height_px)
"""A black picture."""


def sample_inputs(t_ns: int) -> Iterator[Input]:
    """Yield an input of each kind, as if it arrived at a time after the first second of a run."""
    yield _json("clock", Clock(t_ns=t_ns, run="sample", pace="virtual", phase="running"))
    yield _json(
        "briefing",
        Briefing(
            t_ns=t_ns,
            controller="Washington Center",
            horizontal_separation_nm=5.0,
            vertical_separation_ft=1000.0,
            roster=tuple(
                RosterEntry(callsign=callsign, category="aircraft", type="B738")
                for callsign in CALLSIGNS
            ),
        ),
    )
    yield _json("status/asr", Status(t_ns=t_ns, modality="asr", state="on"))
    for icao24, callsign, latitude_deg in zip(ADDRESSES, CALLSIGNS, (38.80, 38.90), strict=True):
        yield _json(f"adsb/{icao24}", _report(t_ns, icao24, callsign, latitude_deg))
    yield from _call(t_ns)
    yield from _pictures(t_ns)
    yield from _advisory(t_ns)


def _json(key: str, message: Message) -> Input:
    return Input(key, message.t_ns, message.model_dump_json().encode())


def _raw(key: str, header: Message, data: bytes) -> Input:
    header = header.model_copy(update={"sha256": hashlib.sha256(data).hexdigest()})
    return Input(key, header.t_ns, data, header.model_dump(mode="json"))


def _report(t_ns: int, icao24: str, callsign: str, latitude_deg: float) -> AdsbReport:
    return AdsbReport(
        t_ns=t_ns,
        icao24=icao24,
        callsign=callsign,
        latitude_deg=latitude_deg,
        longitude_deg=-77.0,
        altitude_ft=35_000.0,
        emitter_category="A3",
        ground_speed_kt=450.0,
        track_deg=0.0,
        vertical_rate_fpm=0.0,
        nacp=9,
        nacv=2,
        receiver="sample",
        t_adsb_in_ns=t_ns,
        t_adsb_out_ns=t_ns,
    )


def _call(t_ns: int) -> Iterator[Input]:
    """Yield a transmission of silence, and the transcript of words that it may have had."""
    transmission = Transmission(
        t_ns=t_ns,
        id=f"sample-{t_ns}",
        frequency_khz=118_300,
        t_tx_ns=t_ns - SECOND_NS,
        t_end_ns=t_ns,
        samples=len(SILENCE) // 2,
        sha256="",
    )
    yield _raw("radio/118300/tx", transmission, SILENCE)
    transcript = Transcript(
        t_ns=t_ns,
        id=transmission.id,
        frequency_khz=transmission.frequency_khz,
        t_tx_ns=transmission.t_tx_ns,
        t_end_ns=t_ns,
        text="american one two three descend and maintain flight level three three zero",
        confidence=0.9,
        engine="sample",
    )
    yield _json("asr/118300", transcript)


def _pictures(t_ns: int) -> Iterator[Input]:
    """Yield a camera, a black picture, and detections that might be in one."""
    camera = CameraInfo(
        t_ns=t_ns,
        camera="sample",
        rate_hz=5.0,
        width_px=VIEW.width_px,
        height_px=VIEW.height_px,
        horizontal_fov_deg=VIEW.horizontal_fov_deg,
    )
    yield _json("camera/sample/info", camera)
    frame = CameraFrame(
        t_ns=t_ns,
        camera="sample",
        seq=t_ns // SECOND_NS,
        t_frame_ns=t_ns,
        view=VIEW,
        sha256="",
    )
    yield _raw("camera/sample/frame", frame, PIXELS)
    detections = Detections(
        t_ns=t_ns,
        camera="sample",
        seq=frame.seq,
        t_frame_ns=t_ns,
        view=VIEW,
        detections=(Detection(label="airplane", confidence=0.9, box=(20.0, 20.0, 30.0, 25.0)),),
        engine="sample",
    )
    yield _json("vision/sample", detections)


def _advisory(t_ns: int) -> Iterator[Input]:
    """Yield an advisory, and its voice."""
    advisory = Advisory(
        t_ns=t_ns,
        id="sample-1",
        revision=0,
        recipient="ATC",
        recipients=("ATC",),
        kind="loss_of_separation",
        severity=Severity.CAUTION,
        traffic=CALLSIGNS,
        message="AAL123 and DAL456 lose separation in 60 s",
        evidence=Evidence(sources=("adsb",)),
        t_ready_ns=t_ns,
    )
    yield _json("advisory/ATC", advisory)
    voice = AdvisoryAudio(
        t_ns=t_ns,
        id=advisory.id,
        revision=0,
        recipient="ATC",
        text="American one two three and Delta four five six lose separation in 60 seconds.",
        t_dec_ns=t_ns,
        engine="sample",
        samples=len(SILENCE) // 2,
        sha256="",
    )
    yield _raw("tts/sample-1", voice, SILENCE)
