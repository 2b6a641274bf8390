"""Festival's British voice, whose lexicon is for research, teaching and individuals only."""

from __future__ import annotations

from airhilt.engines import Command
from synthesisers.festival import Festival, voice_files
from synthesisers.synthesiser import Synthesiser, Voice

SYNTHESISER = Synthesiser(
    "festival_british",
    "BSD-like (Edinburgh); lexicon of Oxford University Press, not for commercial use",
    (Voice("rab_diphone", "festvox", "rab", 185.0, is_test_only=True),),
    create=Festival,
    requires=(
        Command("festival", debian="festival"),
        voice_files("english/rab_diphone", "festvox-rablpc16k  # of the component contrib"),
    ),
)
