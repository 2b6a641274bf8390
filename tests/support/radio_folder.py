"""Run folders whose radio is what a test wants."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np

from airhilt.audio.pcm import to_pcm
from airhilt.audio.wav import write_wav
from airhilt.messages import (
    AdvisoryAudio,
    HearingTruth,
    Message,
    SpokenTruth,
    Transcript,
    Transmission,
)
from airhilt.options import Options
from airhilt.record import LogWriter, RunFolder, RunInfo
from airhilt.record.audio import audio_file
from airhilt.units import SECOND_NS

TOWER_KHZ = 119_100


def tone(seconds: float, hertz: float = 500.0) -> np.ndarray:
    return (0.3 * np.sin(2 * np.pi * hertz * np.arange(round(16_000 * seconds)) / 16_000)).astype(
        np.float32
    )


class RadioFolder:
    """A run folder that is written call by call."""

    def __init__(self, path: Path) -> None:
        path.mkdir(parents=True)
        options = Options(assistant="none", latency="fixed", cameras=False)
        self.folder = RunFolder(path)
        self.folder.write_info(
            RunInfo(
                run="radio-0", options=options, assistant="none", pace="virtual",
            scenario={}, realised={}, draws=[],
                endpoint="", started_at="", versions={}, platform={},
            )
        )  # fmt: skip
        self.folder.audio_path.mkdir()
        self.folder.latency_path.touch()
        self._log = LogWriter(self.folder.log_path)

    def write(self, key: str, message: Message) -> None:
        data = message.model_dump_json().encode()
        self._log.write(key, "run", type(message), message.t_ns, data)

    def call(
        self, name: str, begin_s: float, text: str, *heard: str, seconds: float = 1.0,
        speaker: str = "Tower", sound: bool = True, blocked_by: tuple[str, ...] = (),
        outcome: str = "understood", received: bool = True, engine: str = "embedded",
        snr_db: float | None = None,
    ) -> RadioFolder:  # fmt: skip
        begin_ns, end_ns = round(begin_s * SECOND_NS), round((begin_s + seconds) * SECOND_NS)
        shared = {
            "id": name, "frequency_khz": TOWER_KHZ, "t_tx_ns": begin_ns, "t_end_ns": end_ns,
        }  # fmt: skip
        said = SpokenTruth(
            t_ns=end_ns, **shared, speaker=speaker, addressed="AAL123" if text else None,
            text=text, blocked_by=blocked_by, snr_db=snr_db,
        )  # fmt: skip
        self.write(f"truth/radio/{name}", said)
        if received:
            audio = tone(seconds) if sound else np.zeros(0, np.float32)
            header = Transmission(
                t_ns=end_ns, **shared, samples=len(audio), snr_db=snr_db,
                sha256=hashlib.sha256(to_pcm(audio)).hexdigest(),
            )  # fmt: skip
            if sound:
                write_wav(audio_file(self.folder.audio_path, header), audio)
            self.write(f"radio/{TOWER_KHZ}/tx", header)
        for words in heard:
            transcript = Transcript(
                t_ns=end_ns + SECOND_NS // 4, **shared, text=words, confidence=0.83, engine=engine
            )
            self.write(f"asr/{TOWER_KHZ}", transcript)
        if text:
            hearing = HearingTruth(
                t_ns=end_ns, id=name, actor="AAL123", outcome=outcome, text=text, source="ear"
            )
            self.write("truth/hearing/AAL123", hearing)
        return self

    def voice(self, name: str, at_s: float, text: str) -> RadioFolder:
        audio = tone(1.0, 300.0)
        header = AdvisoryAudio(
            t_ns=round(at_s * SECOND_NS), id=name, revision=0, recipient="ATC", text=text,
            t_dec_ns=round((at_s - 0.2) * SECOND_NS), engine="espeak", samples=len(audio),
            sha256=hashlib.sha256(to_pcm(audio)).hexdigest(),
        )  # fmt: skip
        write_wav(audio_file(self.folder.audio_path, header), audio)
        self.write(f"tts/{name}", header)
        return self

    def close(self) -> Path:
        self._log.close()
        return self.folder.path


def busy_radio(path: Path) -> Path:
    """A run with everything that happens on a radio."""
    radio = RadioFolder(path)
    landing = "American one two three, runway zero one, cleared to land"
    radio.call(
        "clearance", 1.0, landing, "american one three runway zero one cleared to land now",
        seconds=3.0, outcome="misheard",
    )  # fmt: skip
    radio.call("readback", 5.0, "Cleared to land, American one two three", speaker="AAL123")
    radio.call("carrier", 8.0, "", "", speaker="DAL456", seconds=4.0, blocked_by=("roger",))
    radio.call("roger", 9.0, "Roger", "rogers", blocked_by=("carrier",), outcome="missed")
    radio.call("distant", 14.0, "Good day", received=False)
    radio.voice("decision-1", 16.0, "AAL123 go around")
    return radio.close()
