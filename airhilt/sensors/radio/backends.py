"""The sound of a run by what a scenario and the command line name."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from airhilt.record.folder import sha256
from airhilt.scenario.models import Radio
from airhilt.scenario.radio_profiles import PROFILES, is_learned
from airhilt.sensors.radio.backend import RadioBackend, TextRadio

if TYPE_CHECKING:
    from airhilt.sensors.radio.channel import Channel

USUAL_PROFILE = "vhf"


def backend_of(radio: Radio, seed: int, tts: str | None) -> RadioBackend:
    """Return the sound of a run; without voices, text.

    Raises
    ------
    airhilt.errors.SpeechError
        There are no voices of that name, or they or the channel cannot be loaded.
    """
    if tts is None:
        return TextRadio(radio.words_per_minute)
    # Not at the top: a run without speech starts without the libraries behind it.
    from airhilt.sensors.radio.audio_radio import AudioRadio
    from airhilt.voices.engines import tts_engine

    return AudioRadio(tts_engine(tts), channel_of(radio.profile or USUAL_PROFILE), seed)


def channel_of(profile: str) -> Channel:
    """Return the channel of a named profile, or of a file with a learned one.

    Raises
    ------
    airhilt.errors.SpeechError
        The file cannot be loaded.
    """
    if is_learned(profile):
        from airhilt.sensors.radio.learned_channel import LearnedChannel

        return LearnedChannel(Path(profile))
    from airhilt.sensors.radio.channel import VhfChannel

    return VhfChannel(PROFILES[profile])


def models_of(radio: Radio) -> dict[str, str]:
    """Return the SHA-256 of the file that the channel was learned into, by its path."""
    profile = radio.profile or USUAL_PROFILE
    return {profile: sha256(Path(profile))} if is_learned(profile) else {}
