"""The microphone of a person, whose sound becomes known while the person speaks."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.sensors.radio.on_air import OnAir
from airhilt.sim import Director, Priority


class OpenMicrophone:
    """Microphone of somebody who holds the transmit button: its sound is known as it comes.

    Parameters
    ----------
    end
        Ends the transmission.
    """

    def __init__(self, director: Director, on_air: OnAir, end: Callable[[], None]) -> None:
        self._director = director
        self._on_air = on_air
        self._end = end
        self._buffer = np.zeros(SAMPLE_RATE_HZ, np.float32)
        self._count = 0
        self.is_open = True

    def feed(self, samples: Audio) -> None:
        """Add what the microphone has picked up since the button was pressed, or last time.

        Raises
        ------
        ValueError
            The button has been released.
        """
        if not self.is_open:
            raise ValueError(f"{self._on_air.utterance.id}: the button has been released")
        count = self._count + len(samples)
        if count > len(self._buffer):
            self._buffer = np.resize(self._buffer, 2 * count)
        self._buffer[self._count : count] = samples
        self._count = count
        self._on_air.speech = self._buffer[:count]

    def release(self) -> None:
        """End the transmission; if more was fed than time has passed, once that has been said.

        What has not been fed by then is silence.
        """
        if not self.is_open:
            return
        self.is_open = False
        said_until_ns = self._on_air.known_until_ns(self._director.now_ns)
        if said_until_ns <= self._director.now_ns:
            self._end()
        else:
            self._on_air.end_ns = said_until_ns
            self._director.at(said_until_ns, self._end, Priority.SCRIPT)
