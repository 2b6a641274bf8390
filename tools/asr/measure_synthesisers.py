"""Measures synthesisers: the rate of each voice, and the time that calls take.

    python tools/asr/measure_synthesisers.py
    python tools/asr/measure_synthesisers.py flite pico --calls 60

Rates are words a minute of calls of `asr_corpus` at the voice's own rate, without silence at the
ends: what `Voice.words_per_minute` should say. Seconds are of the wall clock, for 1,000 calls.
"""

from __future__ import annotations

import argparse
import random
import time
from collections.abc import Sequence

import numpy as np

from airhilt.audio.pcm import SAMPLE_RATE_HZ
from airhilt.voices.engine import VoiceSpec
from asr_corpus import Talk
from synthesisers import FAMILY
from synthesisers.synthesiser import Synthesiser, Voice

AUDIBLE = 0.01
"""Level from which on a sample is speech, relative to the loudest."""
VOICES = 12
"""Voices of a synthesiser that are measured, if it has more."""


def measure(made_by: Synthesiser, voice: Voice, texts: Sequence[str]) -> tuple[float, float, float]:
    """Return words a minute, seconds for 1,000 calls, and the real-time factor."""
    talker = made_by.create()
    talker.synthesise(texts[0], VoiceSpec(voice.name))
    speaking_s = audio_s = 0.0
    begun = time.perf_counter()
    for text in texts:
        samples = np.abs(talker.synthesise(f"{text}.", VoiceSpec(voice.name)))
        audible = np.flatnonzero(samples > AUDIBLE * samples.max())
        speaking_s += (audible[-1] - audible[0]) / SAMPLE_RATE_HZ
        audio_s += len(samples) / SAMPLE_RATE_HZ
    took_s = time.perf_counter() - begun
    words = sum(len(text.split()) for text in texts)
    return 60 * words / speaking_s, 1_000 * took_s / len(texts), took_s / audio_s


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("synthesisers", nargs="*", default=FAMILY.names())
    parser.add_argument("--calls", type=int, default=30)
    given = parser.parse_args()
    talk = Talk(random.Random(1))
    texts = [talk.call() for _ in range(given.calls)]
    print("| synthesiser | voice | words a minute | s for 1,000 calls | real-time factor |")
    print("|---|---|---|---|---|")
    for name in given.synthesisers:
        made_by: Synthesiser = FAMILY.load(name)
        if lacks := made_by.lacks():
            print(f"| {name} | missing: {lacks} | | | |")
            continue
        voices = made_by.voices
        chosen = voices if len(voices) <= VOICES else random.Random(1).sample(voices, VOICES)
        for voice in chosen:
            rate, seconds, factor = measure(made_by, voice, texts)
            print(f"| {name} | {voice.name} | {rate:.0f} | {seconds:.0f} | {factor:.4f} |")


if __name__ == "__main__":
    main()
