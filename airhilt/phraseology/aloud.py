"""Written texts, such as advisories, in words for a voice."""

from __future__ import annotations

import re

from airhilt.phraseology.numbers import Style, speak_thousands
from airhilt.phraseology.say import speak_altitude, speak_callsign, speak_runway

ADDRESS = re.compile(r"\b(?=[a-f]*[0-9])[0-9a-f]{6}\b")
"""An icao24 in a text, which stands for a callsign that is not known."""
UNKNOWN = "unknown callsign"
"""Words for somebody who sends no callsign; an icao24 follows them in writing alone."""
_CALLSIGN = re.compile(r"\b(?:N[1-9][0-9]{0,4}[A-Z]{0,2}|[A-Z]{2,}[0-9]+[A-Z]{0,2})\b")
_RUNWAY = re.compile(r"\brunway ([0-9]{2}[LRC]?)\b")
_RATE = re.compile(r"\b([0-9]+) ft/min\b")
_ALTITUDE = re.compile(r"\b([0-9]+) ft\b")
_SECONDS = re.compile(r"\b([0-9]+) s\b")
_UNKNOWN = re.compile(rf"(?:({UNKNOWN}) )?{ADDRESS.pattern}", re.IGNORECASE)


def read_aloud(text: str, recipient: str, style: Style, *, says_callsign: bool = True) -> str:
    """Return a written text as it is spoken to its recipient.

    Callsigns, runways, levels and units become words; an icao24 becomes `UNKNOWN`. Other numbers
    stay as they are, because any voice reads them. The callsign of the recipient comes first,
    unless it is left out.
    """
    if text.startswith(f"{recipient} "):
        told = text.removeprefix(recipient).lstrip()
        text = f"{recipient}, {told}" if says_callsign else told
    text = _UNKNOWN.sub(lambda found: found[1] or UNKNOWN, text)
    text = _RUNWAY.sub(lambda found: speak_runway(found[1], style), text)
    text = _RATE.sub(lambda found: f"{_hundreds(found[1], style)} feet per minute", text)
    text = _ALTITUDE.sub(lambda found: speak_altitude(float(found[1]), style), text)
    text = _SECONDS.sub(r"\1 seconds", text)
    text = _CALLSIGN.sub(lambda found: speak_callsign(found[0], style), text)
    return text.replace(";", ",")


def _hundreds(feet: str, style: Style) -> str:
    return speak_thousands(round(int(feet) / 100) * 100, style)
