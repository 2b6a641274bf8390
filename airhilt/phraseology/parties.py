"""Speaker and addressee of a call, as far as a receiver can know."""

from __future__ import annotations

from collections.abc import Iterable

from airhilt.messages import ASSISTANT, Transcript
from airhilt.phraseology.parse import parse_call


def with_parties(
    transcript: Transcript, callsigns: Iterable[str], controller: str, keyed_by: str | None
) -> Transcript:
    """Return a transcript with its speaker, its addressee, and whether the controller overheard it.

    A unit at the receiver's site is known by its keyed transmitter, and the callsign in its words
    is that of whom it calls. A transmission that comes over the air is of the callsign that its
    words name, and is taken to be for the controller: crews and drivers report to the unit.

    Parameters
    ----------
    callsigns
        Callsigns on the frequency.
    controller
        Name of the unit that the assistant sits with.
    keyed_by
        Unit at the receiver's site whose transmitter was keyed, None if it came over the air.
    """
    named = parse_call(transcript.text, callsigns).callsign if transcript.text else None
    speaker, addressee = named, None if named is None else controller
    overheard = None if named is None else False
    if keyed_by is not None:
        speaker, addressee = keyed_by, named
        overheard = keyed_by not in (controller, ASSISTANT)
    return transcript.model_copy(
        update={"speaker": speaker, "addressee": addressee, "overheard": overheard}
    )
