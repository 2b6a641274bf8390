"""CMU Flite: its voices were made from the CMU ARCTIC recordings, and kal from diphones."""

from __future__ import annotations

from airhilt.engines import Command
from airhilt.voices.engines.flite import Flite
from synthesisers.synthesiser import Synthesiser, Voice

SYNTHESISER = Synthesiser(
    "flite",
    "BSD-like (CMU), program and voices",
    (
        Voice("slt", "festvox", "slt", 180.0),
        Voice("rms", "festvox", "rms", 160.0),
        Voice("kal16", "festvox", "kal", 205.0),
        Voice("awb", "festvox", "awb", 180.0, is_held_out=True),
    ),
    create=Flite,
    requires=(Command("flite", debian="flite"),),
)
