"""The microphones of people at seats: pressed, fed and released by messages, and cut in time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from airhilt.audio.pcm import SAMPLE_RATE_HZ, from_pcm
from airhilt.messages import FROM_MICROPHONE, key_chunk
from airhilt.seats import Seats
from airhilt.sensors.radio.frequency_arbiter import FrequencyArbiter
from airhilt.sensors.radio.on_air import OnAir, Utterance
from airhilt.sim import Director
from airhilt.units import SECOND_NS, seconds_to_ns

LONGEST_CALL_S = 60.0
"""Time after which a call is cut, in s: an assumption, twice the longest call of a script."""
AHEAD_S = 2.0
"""Sound that may come before its time, in s: what a network has kept back comes at once."""
SILENT_S = 3.0
"""Time without audio after which a microphone is released, in s: its browser is gone."""


@dataclass(eq=False)
class _Held:
    """A microphone whose button is held."""

    on_air: OnAir
    heard_ns: int
    """Time of the last audio."""


class Microphones:
    """Lets people speak."""

    def __init__(self, director: Director, arbiter: FrequencyArbiter, seats: Seats) -> None:
        self._director = director
        self._arbiter = arbiter
        self._seats = seats
        self._times_pressed = 0
        self._held: dict[str, _Held] = {}
        """Microphones whose buttons are held, by speaker."""

    def press(self, speaker: str, frequency_khz: int) -> None:
        """Press the button of a speaker; a call that is on the air ends."""
        self.release(speaker)
        self._times_pressed += 1
        name = f"{FROM_MICROPHONE}{key_chunk(speaker)}.{self._times_pressed}"
        utterance = Utterance(name, frequency_khz, speaker, None, "", is_from_microphone=True)
        held = _Held(self._arbiter.press(utterance), self._director.now_ns)
        self._held[speaker] = held
        self._look_later(speaker, held)

    def feed(self, speaker: str, pcm: bytes) -> None:
        """Add what a speaker says; it is left out if no button is held."""
        held = self._held.get(speaker)
        if held is None:
            return
        held.heard_ns = now_ns = self._director.now_ns
        sound = from_pcm(pcm)
        until_ns = held.on_air.known_until_ns(now_ns) + len(sound) * SECOND_NS // SAMPLE_RATE_HZ
        if until_ns > now_ns + seconds_to_ns(AHEAD_S):
            self._cut(speaker, "Your call was cut: more sound came than anybody can speak.")
        else:
            held.on_air.feed(sound)

    def release(self, speaker: str) -> None:
        """Release the button of a speaker, if it is held."""
        held = self._held.pop(speaker, None)
        if held is not None:
            self._arbiter.release(held.on_air)

    def _look_later(self, speaker: str, held: _Held) -> None:
        self._director.after(1.0, partial(self._look, speaker, held))

    def _look(self, speaker: str, held: _Held) -> None:
        """Cut a call that is too long, or whose audio does not come any more."""
        if self._held.get(speaker) is not held:
            return
        now_ns = self._director.now_ns
        if now_ns - held.on_air.t_tx_ns >= seconds_to_ns(LONGEST_CALL_S):
            self._cut(speaker, f"Your call was cut after {LONGEST_CALL_S:g} s.")
        elif now_ns - held.heard_ns >= seconds_to_ns(SILENT_S):
            self._cut(speaker, f"Your call was cut: no sound came for {SILENT_S:g} s.")
        else:
            self._look_later(speaker, held)

    def _cut(self, speaker: str, text: str) -> None:
        self.release(speaker)
        self._seats.cut(speaker, text)
