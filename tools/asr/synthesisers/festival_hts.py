"""Festival's statistical voice: Festival says which sounds, and hts_engine makes them."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import numpy as np
from scipy.io import wavfile
from scipy.signal import resample_poly

from airhilt.audio.pcm import FULL_SCALE, SAMPLE_RATE_HZ, Audio
from airhilt.engines import Command
from airhilt.voices.engine import VoiceSpec
from synthesisers.festival import VOICES, FestivalProcess, quoted, voice_files
from synthesisers.synthesiser import Synthesiser, Voice, run

_MODEL = "us/{voice}/hts/{voice}.htsvoice"
_LABELS = """
 (voice_{voice})
 (set! HTS_Synthesize (lambda (said) said))
 (set! hts_synth_pre_hooks (list (lambda (said) (hts_dump_feats said hts_feats_list "{path}"))))
 (utt.synth (Utterance Text {text}))
"""


class FestivalHts:
    """Speaks with `hts_engine`, because the one within Festival has one rate only."""

    def __init__(self) -> None:
        self._process = FestivalProcess()

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        """Return the text as speech."""
        with tempfile.TemporaryDirectory(prefix="airhilt-festival-") as folder:
            labels, spoken = Path(folder) / "speech.lab", Path(folder) / "speech.wav"
            self._process.ask(_LABELS.format(voice=voice.name, path=labels, text=quoted(text)))
            run(
                "festival_hts",
                [
                    *("hts_engine", "-m", VOICES / _MODEL.format(voice=voice.name)),
                    *("-r", f"{voice.rate:.4f}"),
                    *("-fm", f"{12.0 * math.log2(voice.pitch):.4f}"),
                    *("-ow", spoken, labels),
                ],
            )
            rate_hz, samples = wavfile.read(spoken)
        audio = resample_poly(samples.astype(np.float32) / FULL_SCALE, SAMPLE_RATE_HZ, rate_hz)
        return np.asarray(audio, np.float32)


SYNTHESISER = Synthesiser(
    "festival_hts",
    "BSD-like (Edinburgh, CMU, HTS working group), program and voice",
    (Voice("cmu_us_slt_arctic_hts", "festvox", "slt", 165.0),),
    create=FestivalHts,
    requires=(
        Command("festival", debian="festival"),
        Command("hts_engine", debian="htsengine"),
        voice_files("us/cmu_us_slt_arctic_hts", "festvox-us-slt-hts"),
    ),
)
