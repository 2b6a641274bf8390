"""espeak-ng, the formant synthesiser that comes with AIRHILT: every accent with every timbre."""

from __future__ import annotations

import ctypes

from airhilt.audio.pcm import Audio
from airhilt.voices.engine import VoiceSpec
from airhilt.voices.engines.espeak import ACCENTS, Espeak
from synthesisers.synthesiser import Synthesiser, Voice

HELD_OUT_TIMBRES = ("f3 m2 m4 Mike linda Gene adam ed steph2 victor anika john").split()
"""Timbres that no training of the model that ships has."""
TIMBRES = (
    "m1 m3 m5 m6 m7 m8 f1 f2 f4 f5 Alex Alicia Andrea Andy Annie Denis Diogo Gene2 Henrique "
    "Hugo Jacky Lee Marco Mario Michael Nguyen Reed announcer antonio aunty belinda benjamin "
    "boris caleb david edward edward2 grandma grandpa gustave ian iven iven2 iven3 klatt klatt2 "
    "klatt3 klatt4 marcelo max michel miguel mike2 norbert pablo paul pedro quincy rob robert "
    "sandro shelby steph steph3 travis zac"
).split()
WORDS_PER_MINUTE = 195.0


class SeededEspeak(Espeak):
    """Speaks with espeak-ng, the same every time also in timbres with noise of the C library.

    They are Reed and caleb, which no run of AIRHILT uses.
    """

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        """Return the text as speech."""
        ctypes.CDLL(None).srand(1)
        return super().synthesise(text, voice)


def _voices() -> tuple[Voice, ...]:
    return tuple(
        Voice(
            f"{accent}+{timbre}",
            "espeak",
            f"espeak {timbre}",
            WORDS_PER_MINUTE,
            is_held_out=timbre in HELD_OUT_TIMBRES,
        )
        for timbre in (*TIMBRES, *HELD_OUT_TIMBRES)
        for accent in ACCENTS
    )


SYNTHESISER = Synthesiser(
    "espeak", "GPL-3.0-or-later", _voices(), create=SeededEspeak, pitches=(0.5, 1.5)
)
