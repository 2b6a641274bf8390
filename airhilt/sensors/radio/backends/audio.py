"""A radio with sound: voices in, the audio of a receiver out."""

from __future__ import annotations

import numpy as np

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio, to_pcm
from airhilt.messages import Transcript
from airhilt.scenario.models import Radio
from airhilt.sensors.radio.backends.base import SoundRequest
from airhilt.sensors.radio.channel import WHISTLES_HZ, Other, VhfChannel
from airhilt.sensors.radio.on_air import OnAir
from airhilt.sensors.radio.reception import Receptions
from airhilt.sim.streams import stream
from airhilt.units import SECOND_NS
from airhilt.voices.engine import TtsEngine

CONTEXT = 2 * SAMPLE_RATE_HZ
"""Samples before those that are given out, from which the level of speech is taken in a
transmission whose end is not known beforehand."""


class AudioRadio:
    """Calls are spoken with everybody's own voice, and go through a channel.

    A call that was synthesised goes through the channel as a whole, because its levels are those
    of the whole call. A transmission whose end nobody knows, such as that of a person, goes
    through it piece by piece, each with the `CONTEXT` before it.
    """

    has_sound = True

    def __init__(self, voices: TtsEngine, channel: VhfChannel, seed: int, radio: Radio) -> None:
        self._voices = voices
        self._channel = channel
        self._seed = seed
        self._receptions = Receptions(radio)

    def speak(self, speaker: str, text: str) -> tuple[Audio, float]:
        """Return a text in the voice of a speaker, and its duration in s."""
        speech = self._voices.synthesise(text, self._voices.voice_of(speaker))
        return speech, len(speech) / SAMPLE_RATE_HZ

    def receive(self, request: SoundRequest) -> bytes:
        """Return what a receiver gives out from a sample on, as PCM.

        Each receiver has noise of its own.
        """
        on_air, mixed_with, background, begin, now_ns, listener = request
        speech = _speech_of(on_air, on_air.known_until_ns(now_ns))
        is_over = not on_air.is_open_ended or on_air.has_ended(now_ns)
        if begin >= len(speech) and not is_over:
            return b""
        speech = speech if len(speech) else np.zeros(1, np.float32)
        at = "" if listener is None else f"@{listener}"
        first, draws = 0, f"channel{at}/{on_air.utterance.id}"
        if on_air.is_open_ended:
            context = 0 if on_air.is_carrier else CONTEXT  # A carrier has no level of speech.
            first, draws = max(begin - context, 0), f"{draws}/{begin}"
        piece, first_ns = speech[first:], on_air.t_tx_ns + first * SECOND_NS // SAMPLE_RATE_HZ
        others = [
            self._other(on_air, first, other, now_ns)
            for other in mixed_with
            if not other.has_ended(first_ns)
        ]
        reception = self._receptions.of(on_air.utterance, listener)
        heard = self._channel.transmit(
            piece,
            reception.snr_db,
            stream(self._seed, draws),
            [other for other in others if len(other.speech)],
            background,
            reception.wet,
        )
        if not is_over:
            heard = heard[: len(piece)]  # The squelch tail is still to come.
        return to_pcm(heard[begin - first :])

    def transcript(self, on_air: OnAir, mixed_with: tuple[OnAir, ...]) -> Transcript | None:  # noqa: ARG002
        """Return None: a recogniser is to find the words."""
        return None

    def _other(self, on_air: OnAir, first: int, other: OnAir, now_ns: int) -> Other:
        """Return another transmission as it lies over one, from its sample ``first`` on.

        The difference of their carriers belongs to the pair: the whistle is the same in both.
        """
        pair = "/".join(sorted((on_air.utterance.id, other.utterance.id)))
        whistle_hz = stream(self._seed, f"whistle/{pair}").uniform(*WHISTLES_HZ)
        begin = _samples(other.t_tx_ns - on_air.t_tx_ns) - first
        end_ns = other.end_ns
        if end_ns is None:  # Its carrier goes on.
            end_ns = max(on_air.known_until_ns(now_ns), other.known_until_ns(now_ns))
        return Other(_speech_of(other, end_ns), begin, whistle_hz)


def _speech_of(on_air: OnAir, until_ns: int) -> Audio:
    """Return what is said in a transmission up to a time; silence where nothing is known."""
    count = _samples(until_ns - on_air.t_tx_ns)
    said = on_air.speech
    if said is not None and len(said) >= count:
        return said[:count]
    padded = np.zeros(count, np.float32)
    if said is not None:
        padded[: len(said)] = said
    return padded


def _samples(duration_ns: int) -> int:
    return round(duration_ns * SAMPLE_RATE_HZ / SECOND_NS)
