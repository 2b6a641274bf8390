"""Calls to VFR flights, and rates: FAA JO 7110.65 7-6, 7-8, 7-9; ICAO Doc 4444 12.3.1.2."""

from __future__ import annotations

from .model import Exchange, Item, exchange
from .scene import Scene


def level_limit(s: Scene) -> Exchange:
    """Return a level not to pass."""
    altitude_ft = s.rng.randint(3, 11) * 500
    words = s.say.altitude(altitude_ft)
    above, manner = s.pick(("at or below", "at_or_below"), ("at or above", "at_or_above"))
    opening = s.pick("maintain v f r ", "maintain ", "remain ")
    text = f"{opening}{above} {words}"
    item = Item("altitude", altitude_ft, "ft", "now", manner)
    return exchange(s.source("7-9-7", "12.3.1.2"), text, item, text)


def airspace(s: Scene) -> Exchange:
    """Return leave to enter airspace, or its refusal."""
    letter = s.pick("B", "C", "D")
    said = s.say.letter(letter)
    text, manner = s.pick(
        (f"cleared into the class {said} airspace", "enter"),
        (f"remain outside class {said} airspace", "remain_outside"),
        (f"cleared through class {said} airspace", "enter"),
        (f"{said} transition approved", "enter"),
    )
    item = Item("airspace", letter, None, "now", manner)
    return exchange(s.source("7-9-2", "12.3.2.1"), text, item, text)


def rate(s: Scene) -> Exchange:
    """Return a level change with a rate of climb or descent."""
    words, value, unit = s.say.vertical(s.altitude_ft())
    manner = s.pick("climb", "descend")
    rate_fpm = s.pick(1000, 1500, 2000, 2500)
    bound = s.pick("", " or greater", " or less")
    both = "and maintain" if s.is_faa else "to"
    spoken = s.say.altitude(rate_fpm)
    text = f"{manner} {both} {words} at {spoken} feet per minute{bound}"
    items = (
        Item("altitude", value, unit, "now", manner),
        Item("vertical_rate", rate_fpm, "ft/min", "now", bound.strip().replace(" ", "_") or None),
    )
    return exchange(s.source("4-5-7", "12.3.1.2"), text, items, text)


def land_and_hold_short(s: Scene) -> Exchange:
    """Return a clearance to land that ends before another runway (3-10-4)."""
    runway, ident = s.runway()
    other = s.another_runway()
    said = s.say.runway(other)
    text = f"{runway} cleared to land hold short of runway {said} for crossing traffic"
    items = (Item("landing", ident), Item("hold_short", other))
    back = f"cleared to land {runway} hold short {said}"
    return exchange("FAA JO 7110.65 3-10-4", text, items, back)
