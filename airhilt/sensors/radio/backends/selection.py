"""The radio backend and the channel that a scenario and the command line name."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from airhilt.host.files import sha256
from airhilt.scenario.models import Radio
from airhilt.scenario.radio_profiles import PROFILES, is_learned
from airhilt.sensors.radio.backends.base import RadioBackend, TextRadio

if TYPE_CHECKING:
    from airhilt.sensors.radio.channel import VhfChannel

DEFAULT_PROFILE = "vhf"


def select_backend(radio: Radio, seed: int, tts: str | None) -> RadioBackend:
    """Return the radio backend of a run; a radio without sound if there are no voices.

    A SpeechError says that the voices or the channel cannot be loaded.
    """
    if tts is None:
        return TextRadio(radio.words_per_minute)
    # Imported here, so that a run without speech starts without the libraries behind it.
    from airhilt.sensors.radio.backends.audio import AudioRadio
    from airhilt.voices.engines import tts_engine

    channel = select_channel(radio.profile or DEFAULT_PROFILE)
    return AudioRadio(tts_engine(tts), channel, seed, radio)


def select_channel(profile: str) -> VhfChannel:
    """Return the channel of a named profile, or of a file with a learned one."""
    if is_learned(profile):
        from airhilt.sensors.radio.learned_channel import LearnedChannel

        return LearnedChannel(Path(profile))
    from airhilt.sensors.radio.channel import VhfChannel

    return VhfChannel(PROFILES[profile])


def channel_files(radio: Radio) -> dict[str, str]:
    """Return the SHA-256 of the file with a learned channel, by its path; empty without one."""
    profile = radio.profile or DEFAULT_PROFILE
    return {profile: sha256(Path(profile))} if is_learned(profile) else {}
