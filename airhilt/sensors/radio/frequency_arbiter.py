"""The frequencies: who talks when, and who talks over whom.

Somebody who wants to speak listens first, and waits until the frequency is free. Nobody hears at
once that another has just begun, though: two that begin at the same time block each other, both
talk to the end, and neither notices (a transmitter does not receive).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

from airhilt.sim import Director, Priority
from airhilt.units import seconds_to_ns
from airhilt.voices.engine import Audio

GAP_S = 0.4
"""Pause before a call that had to wait for the frequency."""
REACTION_S = 0.25
"""For so long nobody notices that somebody else has begun to talk. An estimate: a simple reaction
to a sound takes 0.14 to 0.2 s, and a transmitter and a squelch take tens of milliseconds."""

Speak = Callable[[str, str], tuple[Audio | None, float]]
"""From a speaker and a text to the speech, None without sound, and how long it takes in seconds."""


@dataclass(frozen=True, slots=True)
class Utterance:
    """What somebody wants to say on a frequency."""

    id: str
    """Stable: the same in each run of a scenario in which it is said."""
    frequency_khz: int
    speaker: str
    addressed: str | None
    text: str
    in_reply_to: str | None = None
    listens_first: bool = True
    """False: it is said even if the frequency is busy."""


@dataclass(slots=True, eq=False)
class OnAir:
    """One transmission."""

    utterance: Utterance
    t_tx_ns: int
    t_end_ns: int
    speech: Audio | None
    """None without sound, and of a stuck microphone."""
    overlapping: list[OnAir] = field(default_factory=list)
    """Those of others on the frequency at the same time, whoever hears them."""

    @property
    def is_carrier(self) -> bool:
        """Whether it is only a carrier: a button that is stuck."""
        return not self.utterance.text


class FrequencyArbiter:
    """All frequencies of a run.

    Parameters
    ----------
    audible
        Tells whether its second argument, a listener, is in reach of the first, a speaker.
    ended
        Called with each transmission when it ends.
    """

    def __init__(
        self,
        director: Director,
        speak: Speak,
        audible: Callable[[str, str], bool],
        ended: Callable[[OnAir], None],
    ) -> None:
        self._director = director
        self._speak = speak
        self._audible = audible
        self._ended = ended
        self._on_air: dict[int, list[OnAir]] = {}

    def say(self, utterance: Utterance) -> None:
        """Say something as soon as its speaker finds the frequency free."""
        self._begin(utterance, has_waited=False)

    def press(self, utterance: Utterance, for_s: float) -> None:
        """Hold the button of a transmitter for a time, saying nothing.

        Nobody waits for that to end: there is nothing to hear but a carrier.
        """
        self._transmit(utterance, None, for_s)

    def close(self) -> list[OnAir]:
        """Cut off what is on the air, and return it."""
        now_ns = self._director.now_ns
        cut = [
            on_air
            for together in self._on_air.values()
            for on_air in together
            if on_air.t_tx_ns < now_ns
        ]
        for on_air in cut:
            on_air.t_end_ns = now_ns
        self._on_air.clear()
        return cut

    def _begin(self, utterance: Utterance, *, has_waited: bool) -> None:
        heard = self._heard_by(utterance, has_waited)
        if heard:
            again_ns = max(other.t_end_ns for other in heard) + seconds_to_ns(GAP_S)
            begin = partial(self._begin, utterance, has_waited=True)
            self._director.at(again_ns, begin, Priority.SCRIPT)
        else:
            self._transmit(utterance, *self._speak(utterance.speaker, utterance.text))

    def _heard_by(self, utterance: Utterance, has_waited: bool) -> list[OnAir]:
        """Return whom a speaker would interrupt, himself at least, so that he waits.

        Who has waited pays attention until the end.
        """
        unnoticed_ns = self._director.now_ns - seconds_to_ns(REACTION_S)
        return [
            other
            for other in self._on_air.get(utterance.frequency_khz, ())
            if not other.is_carrier
            and other.t_end_ns > self._director.now_ns
            and (
                other.utterance.speaker == utterance.speaker
                or (
                    utterance.listens_first
                    and (has_waited or other.t_tx_ns <= unnoticed_ns)
                    and self._audible(other.utterance.speaker, utterance.speaker)
                )
            )
        ]

    def _transmit(self, utterance: Utterance, speech: Audio | None, duration_s: float) -> None:
        now_ns = self._director.now_ns
        on_air = OnAir(utterance, now_ns, now_ns + seconds_to_ns(duration_s), speech)
        together = self._on_air.setdefault(utterance.frequency_khz, [])
        for other in together:
            if other.t_end_ns > now_ns and other.utterance.speaker != utterance.speaker:
                other.overlapping.append(on_air)
                on_air.overlapping.append(other)
        together.append(on_air)
        self._director.at(on_air.t_end_ns, partial(self._end, on_air), Priority.SCRIPT)

    def _end(self, on_air: OnAir) -> None:
        self._on_air[on_air.utterance.frequency_khz].remove(on_air)
        self._ended(on_air)
