"""The embedded voices: espeak-ng, from the wheel ``espeakng-loader``.

The library keeps state from one utterance to the next, even after `espeak_Terminate`, so that the
same text would not give the same samples twice. Therefore each utterance loads the library anew,
seeds its random numbers, and unloads it.
"""

from __future__ import annotations

import ctypes
import hashlib
from _ctypes import dlclose
from importlib.metadata import version as installed_version

import numpy as np

from airhilt.audio.pcm import Audio
from airhilt.audio.resampling import resampled
from airhilt.engines import Engine
from airhilt.errors import SpeechError
from airhilt.voices.engine import VoiceSpec

ACCENTS = (
    "en-us",
    "en",
    "en-gb-x-rp",
    "en-gb-scotland",
    "en-us-nyc",
    "en-029",
    "gmw/en-GB-x-gbclan",
    "gmw/en-GB-x-gbcwmd",
)
"""English accents of espeak-ng in its wheel."""
VARIANTS = ("m1", "m3", "m7", "f2", "f4", "Alex", "Annie", "Andy", "Lee", "steph", "Michael", "max")
"""Timbres that are intelligible over a radio."""
NORMAL_WORDS_PER_MINUTE = 175
NORMAL_PITCH = 50
RATE_HZ = 22_050
"""Sample rate of espeak-ng."""
_RATE, _PITCH = 1, 3
"""`espeak_PARAMETER` (espeak-ng, speak_lib.h)."""
_SYNCHRONOUS, _UTF8 = 2, 1
"""`AUDIO_OUTPUT_SYNCHRONOUS` and `espeakCHARS_UTF8` (the same)."""
_Callback = ctypes.CFUNCTYPE(
    ctypes.c_int, ctypes.POINTER(ctypes.c_short), ctypes.c_int, ctypes.c_void_p
)


class Espeak:
    """Speaks with espeak-ng. Not for use from several threads at once."""

    name = "espeak"

    def __init__(self) -> None:
        try:
            import espeakng_loader
        except ImportError:
            raise SpeechError(
                "voice espeak: the package espeakng-loader is missing; install it with "
                "`pip install espeakng-loader`, or run with --no-speech"
            ) from None
        self._library = str(espeakng_loader.get_library_path())
        self._data = str(espeakng_loader.get_data_path()).encode()
        self.version = installed_version("espeakng-loader")

    def voice_of(self, speaker: str) -> VoiceSpec:
        """Return the voice of a speaker: accent, timbre, rate and pitch drawn from the name."""
        digest = hashlib.sha256(speaker.encode()).digest()
        accent = ACCENTS[digest[0] % len(ACCENTS)]
        variant = VARIANTS[digest[1] % len(VARIANTS)]
        rate = 0.95 + 0.25 * digest[2] / 255.0
        pitch = 0.8 + 0.4 * digest[3] / 255.0
        return VoiceSpec(f"{accent}+{variant}", round(rate, 3), round(pitch, 3))

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        """Return the text as speech, from the library loaded anew."""
        library = ctypes.CDLL(self._library)
        try:
            return self._speak(library, text, voice)
        finally:
            dlclose(library._handle)

    def _speak(self, library: ctypes.CDLL, text: str, voice: VoiceSpec) -> Audio:
        if library.espeak_Initialize(_SYNCHRONOUS, 0, self._data, 0) <= 0:
            raise SpeechError(
                f"voice espeak: the library {self._library} does not start; reinstall it with "
                "`pip install --force-reinstall espeakng-loader`"
            )
        blocks: list[bytes] = []

        def take(samples: ctypes._Pointer[ctypes.c_short], count: int, _events: int | None) -> int:
            if count > 0:
                blocks.append(ctypes.string_at(samples, 2 * count))
            return 0

        callback = _Callback(take)
        try:
            library.espeak_ng_SetRandSeed(ctypes.c_long(1))
            library.espeak_SetSynthCallback(callback)
            if library.espeak_SetVoiceByName(voice.name.encode()) != 0:
                raise SpeechError(
                    f"voice espeak: there is no voice {voice.name!r}; expected an accent and a "
                    "timbre such as 'en-us+m3'"
                )
            library.espeak_SetParameter(_RATE, round(NORMAL_WORDS_PER_MINUTE * voice.rate), 0)
            pitch = min(max(round(NORMAL_PITCH * voice.pitch), 0), 99)
            library.espeak_SetParameter(_PITCH, pitch, 0)
            encoded = text.encode()
            library.espeak_Synth(
                encoded,
                ctypes.c_size_t(len(encoded) + 1),
                ctypes.c_uint(0),
                ctypes.c_int(0),
                ctypes.c_uint(0),
                ctypes.c_uint(_UTF8),
                None,
                None,
            )
            library.espeak_Synchronize()
        finally:
            library.espeak_Terminate()
        pcm = np.frombuffer(b"".join(blocks), np.int16).astype(np.float32) / 32768.0
        return resampled(pcm, RATE_HZ)


ENGINE = Engine(
    name="espeak",
    summary="espeak-ng; comes with AIRHILT",
    create=lambda _: Espeak(),
)
