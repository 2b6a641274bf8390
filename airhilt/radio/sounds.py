"""The sound of a run by what a scenario and the command line name."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from airhilt.errors import SpeechError
from airhilt.library import nearest
from airhilt.radio.speech import Sound, Text
from airhilt.scenario.models import Radio

if TYPE_CHECKING:
    from airhilt.radio.channel import Channel

USUAL_PROFILE = "vhf"


def sound_of(radio: Radio, seed: int, tts: str | None) -> Sound:
    """Return the sound of a run; without voices, text.

    Raises
    ------
    SpeechError
        There is no profile or are no voices of that name, or they cannot be loaded.
    """
    if tts is None:
        return Text(radio.words_per_minute)
    # Not at the top: a run without speech starts without the libraries behind it.
    from airhilt.radio.sound import Spoken
    from airhilt.radio.voices.engines import tts_engine

    return Spoken(tts_engine(tts), channel_of(radio.profile or USUAL_PROFILE), seed)


def channel_of(profile: str) -> Channel:
    """Return the channel of a named profile, or of a file with a learned one.

    Raises
    ------
    SpeechError
        There is none of that name, or the file cannot be loaded.
    """
    if profile.endswith(".onnx"):
        from airhilt.radio.learned_channel import LearnedChannel

        return LearnedChannel(Path(profile))
    from airhilt.radio.channel import PROFILES, VhfChannel

    if profile not in PROFILES:
        raise SpeechError(f"no radio profile {profile!r}{nearest(profile, list(PROFILES))}")
    return VhfChannel(PROFILES[profile])
