"""Utterances, and the transmissions that carry them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.units import SECOND_NS

BackgroundNoise = Literal["cockpit", "tower", "none"]
"""Noise around the microphone."""


@dataclass(frozen=True, slots=True)
class Utterance:
    """Words that a speaker wants to say on a frequency."""

    id: str
    """Stable: the same in each run of a scenario in which it is said."""
    frequency_khz: int
    speaker: str
    addressed: str | None
    text: str
    """Empty if nothing is said, or nobody knows what."""
    in_reply_to: str | None = None
    line: str | None = None
    """Id of the line of the script that it says; None if it is not in the script."""
    listens_first: bool = True
    """False: it is said even if the frequency is busy."""
    speech: Audio | None = field(default=None, compare=False)
    """Its sound, if another voice than the speaker's own has said it already."""
    is_from_microphone: bool = False
    """True if a person speaks it, so that its words are not known."""


@dataclass(slots=True, eq=False)
class OnAir:
    """One transmission."""

    utterance: Utterance
    t_tx_ns: int
    end_ns: int | None
    """Planned or real end; None while a person holds the button."""
    speech: Audio | None
    """Speech as far as it is known; None without sound, and for a stuck microphone."""
    is_carrier: bool = False
    """True if it is only a carrier, as a stuck microphone gives."""
    is_open_ended: bool = False
    """True if its sound becomes known only while it lasts."""
    overlapping: list[OnAir] = field(default_factory=list)
    """Transmissions of others on the frequency at the same time, whoever hears them."""
    waiting: list[Callable[[], None]] = field(default_factory=list)
    """Attempts to speak that are made when it has ended."""

    @property
    def t_end_ns(self) -> int:
        """End of a transmission that has ended, or whose end was planned."""
        if self.end_ns is None:
            raise ValueError(f"{self.utterance.id}: still on the air, and its end is not known")
        return self.end_ns

    def feed(self, samples: Audio) -> None:
        """Add what its microphone has picked up since its button was pressed, or last time."""
        assert self.speech is not None
        self.speech = np.concatenate([self.speech, samples])

    def has_ended(self, now_ns: int) -> bool:
        """Return whether it is over."""
        return self.end_ns is not None and self.end_ns <= now_ns

    def known_until_ns(self, now_ns: int) -> int:
        """Return the time up to which its sound is known."""
        if not self.is_open_ended or self.has_ended(now_ns):
            return self.t_end_ns
        if self.speech is None:
            return now_ns
        return self.t_tx_ns + len(self.speech) * SECOND_NS // SAMPLE_RATE_HZ
