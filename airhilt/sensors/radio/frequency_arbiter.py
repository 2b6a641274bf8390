"""The frequencies: who talks when, and who talks over whom.

Whoever wants to speak listens first, and waits until the frequency is free. Nobody hears at once
that another has just begun, though: two that begin at the same time block each other, both talk to
the end, and neither notices (a transmitter does not receive).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.sensors.radio.on_air import OnAir, Utterance
from airhilt.sim import Director, Priority
from airhilt.units import seconds_to_ns

GAP_S = 0.4
"""Pause in s before a call that had to wait for the frequency."""
REACTION_S = 0.25
"""Time in s in which nobody notices that somebody else has begun to talk. An estimate: a simple
reaction to a sound takes 0.14 to 0.2 s, and a transmitter and a squelch take tens of
milliseconds."""

Speak = Callable[[str, str], tuple[Audio | None, float]]
"""Returns the speech of a speaker's text, None without sound, and its duration in s."""


class FrequencyArbiter:
    """All frequencies of a run.

    ``audible`` returns whether its second argument, a listener, is in reach of the first, a
    speaker. ``began`` and ``ended`` are called with each transmission.
    """

    def __init__(
        self,
        director: Director,
        speak: Speak,
        audible: Callable[[str, str], bool],
        *,
        began: Callable[[OnAir], object],
        ended: Callable[[OnAir], object],
    ) -> None:
        self._director = director
        self._speak = speak
        self._audible = audible
        self._began = began
        self._ended = ended
        self._on_air: dict[int, list[OnAir]] = {}

    def transmit_carrier(self, utterance: Utterance, for_s: float) -> None:
        """Transmit a carrier without words for a time in s, as a stuck microphone does.

        Nobody waits for its end: there is nothing to hear but a carrier.
        """
        now_ns = self._director.now_ns
        end_ns = now_ns + seconds_to_ns(for_s)
        self._transmit(OnAir(utterance, now_ns, end_ns, None, is_carrier=True, is_open_ended=True))

    def press(self, utterance: Utterance) -> OnAir:
        """Transmit from now on what is fed to a microphone, until its button is released.

        Whoever presses the button of a transmitter is on the air at once, over all others.
        """
        silence = np.zeros(0, np.float32)
        on_air = OnAir(utterance, self._director.now_ns, None, silence, is_open_ended=True)
        self._transmit(on_air)
        return on_air

    def release(self, on_air: OnAir) -> None:
        """End a transmission that was pressed; if more was fed than time has passed, after that.

        What has not been fed by then is silence.
        """
        said_until_ns = on_air.known_until_ns(self._director.now_ns)
        if said_until_ns <= self._director.now_ns:
            self._end(on_air)
        else:
            on_air.end_ns = said_until_ns
            self._director.at(said_until_ns, partial(self._end, on_air), Priority.SCRIPT)

    def close(self) -> list[OnAir]:
        """Cut off what is on the air, and return it; nothing is told of from now on."""
        now_ns = self._director.now_ns
        cut = [
            on_air
            for together in self._on_air.values()
            for on_air in together
            if on_air.t_tx_ns < now_ns
        ]
        for on_air in cut:
            on_air.end_ns = now_ns
        self._on_air.clear()
        self._began = self._ended = lambda _on_air: None
        return cut

    def say(
        self,
        utterance: Utterance,
        is_wanted: Callable[[], bool] = lambda: True,
        *,
        has_waited: bool = False,
    ) -> None:
        """Say something as soon as its speaker finds the frequency free, if it is wanted then."""
        if not is_wanted():
            return
        heard = self._heard_by(utterance, has_waited)
        if heard:
            again = partial(self.say, utterance, is_wanted, has_waited=True)
            self._after_all(heard, again)
            return
        if utterance.speech is None:
            speech, duration_s = self._speak(utterance.speaker, utterance.text)
        else:
            speech, duration_s = utterance.speech, len(utterance.speech) / SAMPLE_RATE_HZ
        now_ns = self._director.now_ns
        self._transmit(OnAir(utterance, now_ns, now_ns + seconds_to_ns(duration_s), speech))

    def _after_all(self, heard: list[OnAir], action: Callable[[], None]) -> None:
        """Call an action once some transmissions have ended and a pause has passed.

        If the end of one is not known, that is the one to wait for: its end is the next chance.
        """
        end_ns = 0
        for other in heard:
            if other.end_ns is None:
                other.waiting.append(action)
                return
            end_ns = max(end_ns, other.end_ns)
        self._director.at(end_ns + seconds_to_ns(GAP_S), action, Priority.SCRIPT)

    def _heard_by(self, utterance: Utterance, has_waited: bool) -> list[OnAir]:
        """Return the transmissions that a speaker would interrupt, and so waits for.

        A speaker's own are always among them. Whoever has waited pays attention until the end.
        """
        unnoticed_ns = self._director.now_ns - seconds_to_ns(REACTION_S)
        return [
            other
            for other in self._on_air.get(utterance.frequency_khz, ())
            if not other.is_carrier
            and not other.has_ended(self._director.now_ns)
            and (
                other.utterance.speaker == utterance.speaker
                or (
                    utterance.listens_first
                    and (has_waited or other.t_tx_ns <= unnoticed_ns)
                    and self._audible(other.utterance.speaker, utterance.speaker)
                )
            )
        ]

    def _transmit(self, on_air: OnAir) -> None:
        together = self._on_air.setdefault(on_air.utterance.frequency_khz, [])
        for other in together:
            if (
                not other.has_ended(self._director.now_ns)
                and other.utterance.speaker != on_air.utterance.speaker
            ):
                other.overlapping.append(on_air)
                on_air.overlapping.append(other)
        together.append(on_air)
        if on_air.end_ns is not None:
            self._director.at(on_air.end_ns, partial(self._end, on_air), Priority.SCRIPT)
        self._began(on_air)

    def _end(self, on_air: OnAir) -> None:
        together = self._on_air.get(on_air.utterance.frequency_khz, [])
        if on_air not in together:
            return  # The end of the run has cut it off.
        together.remove(on_air)
        on_air.end_ns = self._director.now_ns
        self._ended(on_air)
        for action in on_air.waiting:
            self._director.at(on_air.end_ns + seconds_to_ns(GAP_S), action, Priority.SCRIPT)
