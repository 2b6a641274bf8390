"""The assistant's voice."""

from __future__ import annotations

import hashlib
from typing import Any

import pytest

from airhilt.assistant.tts.worker import TtsWorker
from airhilt.audio.pcm import Audio, from_pcm
from airhilt.errors import SpeechError
from airhilt.messages import Advisory, AdvisoryAudio, Briefing, Evidence, Severity
from airhilt.sim.worker import Input, Output
from airhilt.voices.engine import VoiceSpec
from tone import Tone


def advisory(**changes: Any) -> Advisory:
    given: dict[str, Any] = {
        "t_ns": 5_000, "id": "decision-1", "revision": 2, "recipient": "AAL123",
        "recipients": ("ATC", "AAL123"), "kind": "runway_conflict", "severity": "WARNING",
        "traffic": ("AAL123", "DAL456"), "message": "Go around, runway occupied",
        "evidence": Evidence(sources=("adsb",)), "t_ready_ns": 4_000,
    }  # fmt: skip
    return Advisory.model_validate(given | changes)


def spoken(worker: TtsWorker, *told: Advisory) -> tuple[Output, ...]:
    inputs = [
        Input(f"advisory/{one.recipient}", one.t_ns, one.model_dump_json().encode()) for one in told
    ]
    return worker.step(6_000, inputs).outputs


def test_a_warning_is_spoken_with_all_that_the_log_needs() -> None:
    (output,) = spoken(TtsWorker(Tone()), advisory())
    header = AdvisoryAudio.model_validate(output.attachment)
    assert output.key == "tts/decision-1"
    assert output.t_out_ns is None
    assert (header.id, header.revision, header.recipient) == ("decision-1", 2, "AAL123")
    assert header.text == "Go around, runway occupied"
    assert header.t_dec_ns == 5_000
    assert header.engine == "tone"
    assert header.samples == len(from_pcm(output.payload)) > 0
    assert header.sha256 == hashlib.sha256(output.payload).hexdigest()


def test_no_advisory_that_waits_is_left_out() -> None:
    assert {wanted.policy for wanted in TtsWorker(Tone()).description.inputs} == {"fifo"}


@pytest.mark.parametrize(
    ("severity", "is_spoken"),
    [("INFO", False), ("ADVISORY", False), ("CAUTION", True), ("WARNING", True)],
)
def test_only_what_is_urgent_is_spoken(severity: str, is_spoken: bool) -> None:
    assert bool(spoken(TtsWorker(Tone()), advisory(severity=severity))) == is_spoken


def test_the_least_level_can_be_chosen() -> None:
    worker = TtsWorker(Tone(), speak_min_level=Severity.WARNING)
    assert spoken(worker, advisory(severity="CAUTION")) == ()


def test_the_end_of_a_conflict_is_not_spoken() -> None:
    assert spoken(TtsWorker(Tone()), advisory(active=False)) == ()


def test_callsigns_runways_and_units_are_spoken_as_on_the_radio() -> None:
    message = "AAL123 traffic N54G on runway 01L, 30 s to go; descend to 34400 ft at 1500 ft/min"
    (output,) = spoken(TtsWorker(Tone(), style="icao"), advisory(message=message))
    assert AdvisoryAudio.model_validate(output.attachment).text == (
        "traffic November fife fower golf on runway zero one left, "
        "30 seconds to go, descend to flight level tree fower fower "
        "at one thousand fife hundred feet per minute"
    )


@pytest.mark.parametrize(
    ("channel", "first"), [("cockpit", "go around. "), ("frequency", "American one twenty three, ")]
)
def test_its_own_callsign_is_said_to_a_crew_on_a_frequency_alone(channel: Any, first: str) -> None:
    worker = TtsWorker(Tone())
    briefing = Briefing(
        controller="TWR",
        horizontal_separation_nm=5.0,
        vertical_separation_ft=1000.0,
        advisory_channel=channel,
    )
    worker.step(0, [Input("briefing", 0, briefing.model_dump_json().encode())])
    (output,) = spoken(worker, advisory(message="AAL123 go around. OPS1 is on runway 01"))
    assert AdvisoryAudio.model_validate(output.attachment).text.startswith(first)


class Broken(Tone):
    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        raise SpeechError("voice broken: no breath")


def test_a_voice_that_fails_is_the_loss_of_the_worker_by_name() -> None:
    with pytest.raises(SpeechError, match="no breath"):
        spoken(TtsWorker(Broken()), advisory())
