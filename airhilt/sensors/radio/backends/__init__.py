"""Radio backends: how the calls of a run sound, or that they have no sound."""

from airhilt.sensors.radio.backends.base import FallbackRadio, RadioBackend, SoundRequest, TextRadio

__all__ = ["FallbackRadio", "RadioBackend", "SoundRequest", "TextRadio"]
