"""RHVoice: statistical parametric voices with rules of their own, by its library."""

from __future__ import annotations

import ctypes
from ctypes import CFUNCTYPE, POINTER, c_char_p, c_double, c_int, c_short, c_uint, c_void_p
from pathlib import Path

import numpy as np
from scipy.signal import resample_poly

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.errors import SpeechError
from airhilt.voices.engine import VoiceSpec
from synthesisers.synthesiser import InstalledFile, Synthesiser, Voice

LIBRARY = "libRHVoice.so.5"
DATA = Path("/usr/share/RHVoice")
_SetSampleRate = CFUNCTYPE(c_int, c_int, c_void_p)
_PlaySpeech = CFUNCTYPE(c_int, POINTER(c_short), c_uint, c_void_p)
_DO_NOT_CLIP_RATE = 1
"""`RHVoice_synth_flag_dont_clip_rate` (RHVoice_common.h)."""
_OTHER_CALLBACKS = (
    "process_mark word_starts word_ends sentence_starts sentence_ends play_audio done"
).split()


class _InitParameters(ctypes.Structure):
    """`RHVoice_init_params` (RHVoice.h), with its `RHVoice_callbacks`."""

    _fields_ = [
        ("data_path", c_char_p),
        ("config_path", c_char_p),
        ("resource_paths", c_void_p),
        ("set_sample_rate", _SetSampleRate),
        ("play_speech", _PlaySpeech),
        *((name, c_void_p) for name in _OTHER_CALLBACKS),
        ("options", c_uint),
    ]


class _SynthParameters(ctypes.Structure):
    """`RHVoice_synth_params` (RHVoice.h)."""

    _fields_ = [
        ("voice_profile", c_char_p),
        ("absolute_rate", c_double),
        ("absolute_pitch", c_double),
        ("absolute_volume", c_double),
        ("relative_rate", c_double),
        ("relative_pitch", c_double),
        ("relative_volume", c_double),
        ("punctuation_mode", c_int),
        ("punctuation_list", c_char_p),
        ("capitals_mode", c_int),
        ("flags", c_int),
    ]


class RhVoice:
    """Speaks with RHVoice's library. Not for use from several threads at once."""

    def __init__(self) -> None:
        self._rate_hz = 0
        self._blocks: list[bytes] = []
        self._set_sample_rate = _SetSampleRate(self._take_sample_rate)
        self._play_speech = _PlaySpeech(self._take_speech)
        library = ctypes.CDLL(LIBRARY)
        for function in ("RHVoice_new_tts_engine", "RHVoice_new_message"):
            getattr(library, function).restype = c_void_p
        self._parameters = _InitParameters(
            data_path=str(DATA).encode(),
            config_path=b"/etc/RHVoice",
            set_sample_rate=self._set_sample_rate,
            play_speech=self._play_speech,
        )
        self._library = library
        self._engine = library.RHVoice_new_tts_engine(ctypes.byref(self._parameters))
        if not self._engine:
            raise SpeechError(f"synthesiser rhvoice: {LIBRARY} finds no voices in {DATA}")

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        """Return the text as speech."""
        self._blocks.clear()
        encoded = text.encode()
        parameters = _SynthParameters(
            voice_profile=voice.name.encode(),
            relative_rate=voice.rate,
            relative_pitch=voice.pitch,
            relative_volume=1.0,
            flags=_DO_NOT_CLIP_RATE,
        )
        message = self._library.RHVoice_new_message(
            c_void_p(self._engine), encoded, len(encoded), 0, ctypes.byref(parameters), None
        )
        if not message:
            raise SpeechError(f"synthesiser rhvoice: there is no voice {voice.name!r}")
        try:
            self._library.RHVoice_speak(c_void_p(message))
        finally:
            self._library.RHVoice_delete_message(c_void_p(message))
        samples = np.frombuffer(b"".join(self._blocks), np.int16).astype(np.float32) / 32768.0
        return np.asarray(resample_poly(samples, SAMPLE_RATE_HZ, self._rate_hz), np.float32)

    def _take_sample_rate(self, rate_hz: int, _data: int | None) -> int:
        self._rate_hz = rate_hz
        return 1

    def _take_speech(self, samples: ctypes._Pointer[c_short], count: int, _data: int | None) -> int:
        self._blocks.append(ctypes.string_at(samples, 2 * count))
        return 1


SYNTHESISER = Synthesiser(
    "rhvoice",
    "GPL-3.0-or-later; voices LGPL-2.1-or-later, those for tests CC BY-NC-ND 4.0",
    (
        Voice("alan", "rhvoice", "awb", 170.0),
        Voice("bdl", "rhvoice", "bdl", 175.0),
        Voice("clb", "rhvoice", "clb", 155.0),
        Voice("slt", "rhvoice", "slt", 175.0),
        Voice("evgeniy-eng", "rhvoice", "evgeniy", 125.0, is_test_only=True),
        Voice("lyubov", "rhvoice", "lyubov", 125.0, is_test_only=True),
    ),
    create=RhVoice,
    requires=(
        InstalledFile(
            DATA / "voices" / "slt", "librhvoice5 rhvoice-english  # of the component non-free"
        ),
    ),
)
