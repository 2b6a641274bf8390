"""Radio profiles that a scenario or an option can name.

They are apart from the radio channel, so that a scenario is read without signal processing.
"""

from __future__ import annotations

from dataclasses import dataclass

from pydantic_core import PydanticCustomError


@dataclass(frozen=True)
class ChannelProfile:
    """Properties of a radio channel. Values in dB are relative to active speech."""

    name: str
    low_hz: float
    high_hz: float
    order: int = 6
    """Order of the Butterworth band-pass."""
    cockpit_db: float = -28.0
    tower_db: float = -40.0
    microphone_drive: float = 1.5
    """Gain of the speech before the limiter of the transmitter (tanh)."""
    fade_db: float = 0.0
    """Depth of slow fading."""
    fade_hz: float = 0.3
    gain_control: float = 0.6
    """Automatic gain control: 0 none; 1 makes all levels equal."""
    squelch_tail_s: float = 0.12
    wet: float = 1.0
    """Part of the channel in the sound; the rest is the voice as it was spoken."""


PROFILES: dict[str, ChannelProfile] = {
    profile.name: profile
    for profile in (
        ChannelProfile("vhf", 300.0, 3_400.0),
        ChannelProfile("vhf_833", 300.0, 2_500.0),
        ChannelProfile("fading", 300.0, 3_400.0, fade_db=8.0),
        ChannelProfile("noisy_cockpit", 300.0, 3_400.0, cockpit_db=-15.0, microphone_drive=2.5),
        ChannelProfile("monitor", 300.0, 3_400.0, wet=0.7),
        ChannelProfile(
            "line",
            50.0,
            7_500.0,
            order=2,
            cockpit_db=-60.0,
            tower_db=-60.0,
            microphone_drive=0.1,
            gain_control=0.0,
            squelch_tail_s=0.0,
        ),
    )
}
"""Radio profiles by name: 25 kHz VHF, 8.33 kHz VHF, VHF at the edge of coverage, a loud cockpit,
VHF mixed with the voice in the speaker's room, and a wired line."""


def is_learned(profile: str) -> bool:
    """Return whether a profile is the file of a learned channel."""
    return profile.endswith(".onnx")


def checked(profile: str) -> str:
    """Return the name of a profile, or the file of a learned channel, unchanged.

    Raises
    ------
    ValueError
        It is neither; the message names all profiles.
    """
    if profile in PROFILES or is_learned(profile):
        return profile
    names = ", ".join(PROFILES)
    text = f"no radio profile {profile!r}; expected {names}, or a learned channel, FILE.onnx"
    raise PydanticCustomError("radio_profile", "{text}", {"text": text})
