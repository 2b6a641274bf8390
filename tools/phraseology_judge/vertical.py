"""Levels: climbs, descents, crossing restrictions.

FAA JO 7110.65 4-5-7 ("Altitude information") and ICAO Doc 4444 12.3.1.2 ("Level changes, reports
and rates").
"""

from __future__ import annotations

from .model import Exchange, Item, exchange
from .scene import Scene


def climb_or_descend(s: Scene) -> Exchange:
    """Return a climb or a descent at once."""
    value_ft = s.altitude_ft()
    words, value, unit = s.say.vertical(value_ft)
    manner = s.pick("climb", "descend")
    item = Item("altitude", value, unit, "now", manner)
    if s.is_faa:
        text = s.pick(f"{manner} and maintain {words}", f"{manner} maintain {words}")
    else:
        altitude = "altitude " if unit == "ft" and s.chance(0.5) else ""
        text = s.pick(f"{manner} to {altitude}{words}", f"{manner} {altitude}{words}")
    going = {"climb": "climbing", "descend": "descending"}[manner]
    short = {"climb": "up to", "descend": "down to"}[manner]
    bare = Item("altitude", value, unit)
    return exchange(
        s.source("4-5-7", "12.3.1.2"),
        text,
        item,
        text,
        f"{going} {words}",
        f"{going} to {words}",
        f"{short} {words}",
        (words, bare),
    )


def maintain(s: Scene) -> Exchange:
    """Return a level to keep."""
    words, value, unit = s.say.vertical(s.altitude_ft())
    ends = s.pick(None, None, f"until advised by {s.city} approach", "until further advised")
    text = f"maintain {words}" + (f" {ends}" if ends else "")
    item = Item("altitude", value, unit, "now", "maintain", ends=ends)
    bare = Item("altitude", value, unit, "now", "maintain")
    return exchange(s.source("4-5-7", "12.3.2.4"), text, item, text, (f"maintaining {words}", bare))


def level_of_immediacy(s: Scene) -> Exchange:
    """Return a level change at once, in haste or with a rate."""
    words, value, unit = s.say.vertical(s.altitude_ft())
    manner = s.pick("climb", "descend")
    level = Item("altitude", value, unit, "now", manner)
    both = "and maintain " if s.is_faa else "to "
    past = s.say.vertical(s.altitude_ft())[0]
    text, more = s.pick(
        (f"expedite {manner} {both}{words}", Item("expedite", manner=manner)),
        (f"{manner} {both}{words} immediately", Item("immediately")),
        (f"{manner} immediately {both}{words}", Item("immediately")),
        (f"{manner} {both}{words} expedite through {past}", Item("expedite", manner=manner)),
        (f"{manner} {both}{words} expedite", Item("expedite", manner=manner)),
    )
    return exchange(s.source("4-5-7", "12.3.1.2"), text, (level, more), text)


def level_later(s: Scene) -> Exchange:
    """Return a level change that waits for an event."""
    words, value, unit = s.say.vertical(s.altitude_ft())
    manner = s.pick("climb", "descend")
    both = "and maintain" if s.is_faa else "to"
    fix = s.fix()
    begins = s.pick(
        "when ready",
        "at pilot's discretion" if s.is_faa else "when ready",
        f"after passing {fix}",
        "after departure",
        "when able",
        f"at {fix}",
        f"{s.say.count(s.rng.randint(3, 30))} miles before {fix}",
    )
    item = Item("altitude", value, unit, "conditional", manner, begins)
    order = f"{manner} {both} {words}"
    first, last = f"{begins} {order}", f"{order} {begins}"
    text = s.pick(first, last) if "ready" in begins else first
    return exchange(s.source("4-5-7", "12.3.1.2"), text, item, text)


def expected_level(s: Scene) -> Exchange:
    """Return a level to be expected later, which is no clearance."""
    words, value, unit = s.say.vertical(s.altitude_ft())
    minutes = s.say.count(s.pick(5, 10))
    when = s.pick("ten minutes after departure", f"in {minutes} minutes", f"at {s.fix()}", "")
    verb = s.pick("climb to ", "descent to ", "")
    manner = {"climb to ": "climb", "descent to ": "descend"}.get(verb)
    item = Item("altitude", value, unit, "expected", manner, when or None)
    bare = Item("altitude", value, unit, "expected", begins=when or None)
    text = f"expect {verb}{words} {when}".strip()
    short = (f"we'll expect {words}", bare)
    return exchange(s.source("4-3-2", "12.3.1.2"), text, item, text, short)


def crossing(s: Scene) -> Exchange:
    """Return a fix to cross at, above or below a level, with a speed sometimes."""
    fix, altitude_ft = s.fix(), s.altitude_ft()
    words, value, unit = s.say.vertical(altitude_ft)
    said, relation = s.pick(
        ("at", "at"),
        ("at or above", "at_or_above"),
        ("at or below", "at_or_below"),
        ("at and maintain", "at"),
    )
    level: dict[str, str | int] = {"fix": fix, "relation": relation, "altitude": value}
    text = f"cross {fix} {said} {words}"
    if s.chance(0.3):
        speed_kt = s.speed_kt()
        level["speed_kt"] = speed_kt
        text += f" at {s.say.speed(speed_kt)}" + s.pick("", " knots")
    items = [Item("crossing_restriction", level, unit)]
    if said == "at and maintain":
        items.append(Item("altitude", value, unit, "conditional", "maintain", f"at {fix}"))
    return exchange(
        s.source("4-5-7", "12.3.2.6"),
        text,
        tuple(items),
        text,
        text.replace("cross", "crossing", 1),
    )


def via_procedure(s: Scene) -> Exchange:
    """Return a climb or descent along the restrictions of a procedure."""
    procedure = s.procedure()
    manner = s.pick("climb", "descend")
    kind = f"{manner}_via"
    what = {"climb": "departure", "descend": "arrival"}[manner]
    text = f"{manner} via the {procedure} {what}"
    items: tuple[Item, ...] = (Item(kind, procedure),)
    if s.chance(0.5):
        words, value, unit = s.say.vertical(s.altitude_ft())
        text += f" except maintain {words}"
        items += (Item("altitude", value, unit, "now", "maintain"),)
    elif not s.is_faa:
        words, value, unit = s.say.vertical(s.altitude_ft())
        short = {"climb": "sid", "descend": "star"}[manner]
        text = f"{manner} via {short} to {words}"
        items = (Item(kind), Item("altitude", value, unit, "now", manner))
    return exchange(s.source("4-5-7", "12.3.1.2"), text, items, text)


def stop_climb(s: Scene) -> Exchange:
    """Return the end of a level change before its clearance."""
    words, value, unit = s.say.vertical(s.altitude_ft())
    manner = s.pick("climb", "descend")
    noun = {"climb": "climb", "descend": "descent"}[manner]
    text, how = s.pick(
        (f"stop {noun} at {words}", "stop"),
        (f"amend altitude maintain {words}", "maintain"),
    )
    item = Item("altitude", value, unit, "now", how)
    return exchange(s.source("4-5-7", "12.3.1.2"), text, item, text)


def block(s: Scene) -> Exchange:
    """Return a block of levels."""
    low_ft = s.rng.randint(6, 30) * 1000
    first, low, unit = s.say.vertical(low_ft)
    second, high, _ = s.say.vertical(low_ft + 2000)
    if (unit == "FL") != ("flight" in second):
        second = f"flight level {s.say.level((low_ft + 2000) // 100)}"
    text = (
        f"maintain block {first} through {second}"
        if s.is_faa
        else (f"climb to and maintain block {first} to {second}")
    )
    item = Item("block_altitude", {"low": low, "high": high}, unit, "now", "maintain")
    return exchange(s.source("4-5-7", "12.3.1.2"), text, item, text)
