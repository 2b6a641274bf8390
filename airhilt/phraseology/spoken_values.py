"""The words of values: runways, levels, headings, frequencies, wind, pressure.

FAA: Order JO 7110.65, 2-4-17. ICAO: Annex 10 volume II, 5.2.1.
"""

from __future__ import annotations

from airhilt.phraseology import alphabet
from airhilt.phraseology.call import Wind
from airhilt.phraseology.numbers import Style, speak_digits, speak_thousands
from airhilt.phraseology.slots import HPA_PER_INHG, TRANSITION_FT

_SIDES = {"L": "left", "R": "right", "C": "center"}


def speak_runway(runway: str, style: Style) -> str:
    """Return a runway; the FAA leaves out its zero, as the signs do (2-4-17 k)."""
    number, side = runway[:2], _SIDES.get(runway[2:], "")
    digits = number.lstrip("0") if style == "faa" else number
    return join("runway", speak_digits(digits, style), side)


def speak_taxiway(taxiway: str, style: Style) -> str:
    """Return a taxiway or an intersection, such as B5."""
    return spell(taxiway, style)


def speak_altitude(feet: float, style: Style, transition_ft: float = TRANSITION_FT) -> str:
    """Return an altitude, or a flight level from the transition altitude on."""
    if feet >= transition_ft:
        level = f"{round(feet / 100.0):03d}"
        return f"flight level {speak_digits(level, style)}"
    spoken = speak_thousands(round(feet / 100.0) * 100, style)
    return spoken if feet >= 1000.0 else f"{spoken} feet"


def speak_heading(heading_deg: float, style: Style) -> str:
    """Return the three digits of a heading; north is 360."""
    return speak_digits(f"{round(heading_deg) % 360 or 360:03d}", style)


def speak_speed(speed_kt: float, style: Style) -> str:
    """Return a speed."""
    return f"{speak_digits(str(round(speed_kt)), style)} knots"


def speak_frequency(frequency_khz: int, style: Style) -> str:
    """Return a frequency.

    ICAO says six digits, or four if the last two are zero (Annex 10 volume II, 5.2.1.7.3.4.3); the
    FAA at most two after the point (7110.65, 2-4-17 i), so only channels of 25 kHz.
    """
    mhz, khz = divmod(frequency_khz, 1000)
    fraction = f"{khz:03d}"
    if style == "icao":
        fraction = fraction[0] if fraction.endswith("00") else fraction
        return f"{speak_digits(str(mhz), style)} decimal {speak_digits(fraction, style)}"
    if khz % 25 == 0:
        fraction = fraction[:2].rstrip("0") or "0"
    return f"{speak_digits(str(mhz), style)} point {speak_digits(fraction, style)}"


def speak_wind(wind: Wind, style: Style) -> str:
    """Return a wind."""
    if wind.direction_deg is None and not wind.speed_kt:
        return "wind calm"
    speed = speak_digits(str(round(wind.speed_kt)), style)
    direction = (
        "variable" if wind.direction_deg is None else speak_heading(wind.direction_deg, style)
    )
    gust = speak_digits(str(round(wind.gust_kt)), style) if wind.gust_kt else ""
    if style == "faa":
        return join(f"wind {direction} at {speed}", f"gusts {gust}" if gust else "")
    degrees = "" if wind.direction_deg is None else " degrees"
    return join(f"wind {direction}{degrees} {speed} knots", f"gusting {gust}" if gust else "")


def speak_pressure(hpa: float, style: Style) -> str:
    """Return an altimeter setting: inches of mercury for the FAA, hectopascals for ICAO."""
    if style == "faa":
        return f"altimeter {speak_digits(f'{round(hpa / HPA_PER_INHG * 100.0):04d}', style)}"
    return f"Q N H {speak_digits(str(round(hpa)), style)}"


def speak_mach(mach: float, style: Style) -> str:
    """Return a Mach number (7110.65, 2-4-17 f)."""
    point = "decimal" if style == "icao" else "point"
    return f"mach {point} {speak_digits(f'{round(mach * 100.0):02d}', style)}"


def spell(signs: str, style: Style) -> str:
    """Return signs in the spelling alphabet."""
    return " ".join(
        speak_digits(each, style) if each.isdigit() else each for each in alphabet.spell(signs)
    )


def join(*parts: str) -> str:
    """Return the parts that have words, as one text."""
    return " ".join(part for part in parts if part)
