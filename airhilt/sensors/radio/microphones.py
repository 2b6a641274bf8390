"""The microphones of people at seats: pressed, fed and released by messages, and cut in time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from airhilt.audio.pcm import from_pcm
from airhilt.messages import MicrophoneAudio
from airhilt.sensors.radio.open_microphone import OpenMicrophone
from airhilt.sim import Director, Priority
from airhilt.units import SECOND_NS, seconds_to_ns

LONGEST_CALL_S = 60.0
"""Time after which a call is cut, in s: an assumption, twice the longest call of a script."""
SILENT_S = 3.0
"""Time without audio after which a microphone is released, in s: its browser is gone."""


@dataclass(eq=False)
class _Held:
    """A microphone whose button is held."""

    microphone: OpenMicrophone
    pressed_ns: int
    heard_ns: int
    """Time of the last audio."""


class Microphones:
    """Lets people speak.

    Parameters
    ----------
    press
        Opens the microphone of a speaker on a frequency.
    tell
        Tells the person at a seat something in words.
    """

    def __init__(
        self,
        director: Director,
        press: Callable[[str, int], OpenMicrophone],
        tell: Callable[[str, str], None],
    ) -> None:
        self._director = director
        self._press = press
        self._tell = tell
        self._held: dict[str, _Held] = {}
        """Microphones whose buttons are held, by speaker."""

    def take(self, speaker: str, frequency_khz: int, message: MicrophoneAudio) -> None:
        """Press, feed or release the microphone of a speaker.

        Audio for which no button is held is left out: its call has been cut.
        """
        match message.phase:
            case "pressed":
                self.release(speaker)
                self._open(speaker, frequency_khz)
            case "samples" if (held := self._held.get(speaker)) is not None:
                held.heard_ns = self._director.now_ns
                held.microphone.feed(from_pcm(message.pcm))
            case "released":
                self.release(speaker)

    def release(self, speaker: str) -> None:
        """Release the button of a speaker, if it is held."""
        held = self._held.pop(speaker, None)
        if held is not None:
            held.microphone.release()

    def _open(self, speaker: str, frequency_khz: int) -> None:
        now_ns = self._director.now_ns
        held = _Held(self._press(speaker, frequency_khz), now_ns, now_ns)
        self._held[speaker] = held
        self._watch(speaker, held)

    def _watch(self, speaker: str, held: _Held) -> None:
        self._director.at(
            self._director.now_ns + SECOND_NS, partial(self._look, speaker, held), Priority.SCRIPT
        )

    def _look(self, speaker: str, held: _Held) -> None:
        """Cut a call that is too long, or whose audio does not come any more."""
        if self._held.get(speaker) is not held:
            return
        now_ns = self._director.now_ns
        if now_ns - held.pressed_ns >= seconds_to_ns(LONGEST_CALL_S):
            self._cut(speaker, f"Your call was cut after {LONGEST_CALL_S:g} s.")
        elif now_ns - held.heard_ns >= seconds_to_ns(SILENT_S):
            self._cut(speaker, f"Your call was cut: no sound came for {SILENT_S:g} s.")
        else:
            self._watch(speaker, held)

    def _cut(self, speaker: str, text: str) -> None:
        self.release(speaker)
        self._tell(speaker, text)
