"""Radio backends: how the calls of a run sound, or that they have no sound."""

from airhilt.sensors.radio.backends.base import RadioBackend
from airhilt.sensors.radio.backends.fallback import FallbackRadio
from airhilt.sensors.radio.backends.text import TextRadio

__all__ = ["FallbackRadio", "RadioBackend", "TextRadio"]
