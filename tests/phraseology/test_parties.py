"""Who speaks to whom is what a receiver can know, and no more."""

from __future__ import annotations

import pytest

from airhilt.messages import ASSISTANT, Transcript
from airhilt.phraseology.parties import with_parties

TOWER, GROUND = "Washington Tower", "Washington Ground"
CALLSIGNS = ("AAL123", "N172SP", "N552SP")


@pytest.mark.parametrize(
    ("text", "keyed_by", "parties"),
    [
        pytest.param(
            "American 123, cleared to land.", TOWER, (TOWER, "AAL123", False), id="the controller"
        ),
        pytest.param(
            "Cleared to land, American 123.", None, ("AAL123", TOWER, False), id="a readback"
        ),
        pytest.param(
            "American 123, cleared to land.", None, ("AAL123", TOWER, False),
            id="a callsign first, over the air, is that of its speaker",
        ),
        pytest.param("Cleared to land.", None, (None, None, None), id="nobody is named"),
        pytest.param("Roger.", TOWER, (TOWER, None, False), id="a unit that names nobody"),
        pytest.param(
            "November two sierra papa, ready.", None, (None, None, None), id="it may be either"
        ),
        pytest.param("American 123, taxi.", GROUND, (GROUND, "AAL123", True), id="another unit"),
        pytest.param(
            "American 123, go around.", ASSISTANT, (ASSISTANT, "AAL123", False), id="its own voice"
        ),
        pytest.param("", None, (None, None, None), id="nothing was recognised"),
    ],
)  # fmt: skip
def test_speaker_addressee_and_overheard_are_those_of_the_receiver(
    text: str, keyed_by: str | None, parties: tuple[str | None, str | None, bool | None]
) -> None:
    heard = Transcript(
        id="a", frequency_khz=119_100, t_tx_ns=0, t_end_ns=1, text=text, confidence=1.0, engine="x"
    )
    found = with_parties(heard, CALLSIGNS, TOWER, keyed_by)
    assert (found.speaker, found.addressee, found.overheard) == parties
