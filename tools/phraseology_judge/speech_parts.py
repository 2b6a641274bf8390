"""Parts of calls that several phrases share."""

from __future__ import annotations

from .model import Item, information
from .scene import Scene


def wind(s: Scene) -> tuple[str, Item]:
    """Return the words and the item of a wind (FAA JO 7110.65 2-6-6; ICAO Doc 4444 12.3.1.8)."""
    if s.chance(0.15):
        return "wind calm", information("wind", "calm")
    direction_deg, speed_kt = s.rng.randint(1, 36) * 10, s.rng.randint(3, 28)
    spoken = s.say.digits(f"{direction_deg:03}")
    knots = s.say.count(speed_kt)
    if s.is_faa:
        text = f"wind {spoken} at {knots}"
    else:
        text = f"{s.pick('surface wind', 'wind')} {spoken} degrees {knots} knots"
    value = {"direction_deg": direction_deg, "speed_kt": speed_kt}
    if s.chance(0.2):
        gust_kt = speed_kt + s.rng.randint(8, 15)
        value["gust_kt"] = gust_kt
        words = s.say.count(gust_kt)
        text += f" gusts {words}" if s.is_faa else f" gusting {words} knots"
    return text, information("wind", value)


def altimeter(s: Scene) -> tuple[str, int | float, str]:
    """Return the words, the value and the unit of an altimeter setting (2-7-2; 12.3.1.11)."""
    if s.is_faa:
        hundredths = s.rng.randint(2920, 3060)
        words = s.say.digits(f"{hundredths}")
        return (
            f"{s.city} altimeter {words}" if s.chance(0.4) else f"altimeter {words}",
            hundredths / 100,
            "inHg",
        )
    hpa = s.rng.randint(978, 1040)
    return f"q n h {s.say.digits(f'{hpa}')}".replace("q n h", s.pick("qnh", "q n h")), hpa, "hPa"
