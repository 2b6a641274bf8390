"""Voices: text to speech for the speakers on the radio, and for the assistant."""

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.voices.engine import TtsEngine, VoiceSpec

__all__ = ["SAMPLE_RATE_HZ", "Audio", "TtsEngine", "VoiceSpec"]
