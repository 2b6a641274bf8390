"""A radio with sound: voices in, the audio of a receiver out."""

from __future__ import annotations

import hashlib

import numpy as np

from airhilt.audio.wav import SAMPLE_BYTES, to_pcm
from airhilt.messages import Transmission
from airhilt.sensors.radio.backend import Reception
from airhilt.sensors.radio.channel import WHISTLES_HZ, BackgroundNoise, Channel, Other
from airhilt.sensors.radio.frequency_arbiter import OnAir
from airhilt.sim.streams import stream
from airhilt.units import SECOND_NS
from airhilt.voices.engine import SAMPLE_RATE_HZ, Audio, TtsEngine


class AudioRadio:
    """Calls are spoken with everybody's own voice, and go through a channel."""

    def __init__(self, voices: TtsEngine, channel: Channel, seed: int) -> None:
        self._voices = voices
        self._channel = channel
        self._seed = seed

    def speak(self, speaker: str, text: str) -> tuple[Audio, float]:
        """Return a text in the voice of a speaker, and how long it takes.

        Raises
        ------
        airhilt.errors.SpeechError
            The voices have failed.
        """
        speech = self._voices.synthesise(text, self._voices.voice_of(speaker))
        return speech, len(speech) / SAMPLE_RATE_HZ

    def receive(
        self,
        on_air: OnAir,
        heard_over: tuple[OnAir, ...],
        snr_db: float | None,
        background: BackgroundNoise,
    ) -> Reception:
        """Return what the units' receiver gives out of a transmission that has ended."""
        said = on_air.utterance
        audio = self._channel.transmit(
            _speech_of(on_air),
            snr_db,
            stream(self._seed, f"channel/{said.id}"),
            [self._beside(on_air, other) for other in heard_over],
            background,
        )
        pcm = to_pcm(audio)
        header = Transmission(
            t_ns=on_air.t_end_ns,
            id=said.id,
            frequency_khz=said.frequency_khz,
            t_tx_ns=on_air.t_tx_ns,
            t_end_ns=on_air.t_end_ns,
            snr_db=snr_db,
            samples=len(pcm) // SAMPLE_BYTES,
            sha256=hashlib.sha256(pcm).hexdigest(),
        )
        return Reception(header, pcm)

    def _beside(self, on_air: OnAir, other: OnAir) -> Other:
        """Return another transmission as it lies over one.

        How far their carriers are apart is the pair's: both ways round they whistle the same.
        """
        pair = "/".join(sorted((on_air.utterance.id, other.utterance.id)))
        whistle_hz = stream(self._seed, f"whistle/{pair}").uniform(*WHISTLES_HZ)
        begin = _samples(other.t_tx_ns - on_air.t_tx_ns)
        return Other(_speech_of(other), begin, whistle_hz)


def _speech_of(on_air: OnAir) -> Audio:
    """Return what was said while it was on the air; silence from a button that is stuck."""
    count = max(_samples(on_air.t_end_ns - on_air.t_tx_ns), 1)
    return np.zeros(count, np.float32) if on_air.speech is None else on_air.speech[:count]


def _samples(duration_ns: int) -> int:
    return round(duration_ns * SAMPLE_RATE_HZ / SECOND_NS)
