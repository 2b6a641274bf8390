"""Speeds: FAA JO 7110.65 5-7-2 and 5-7-4; ICAO Doc 4444 12.4.1.6 ("Speed control")."""

from __future__ import annotations

from .model import Exchange, Item, exchange
from .scene import Scene

METHODS = ("5-7-2", "12.4.1.6")


def speed(s: Scene) -> Exchange:
    """Return a speed to fly at once."""
    speed_kt = s.speed_kt()
    words = s.say.speed(speed_kt)
    knots = s.pick(" knots", " knots", "")
    text, manner = s.deal(
        "speed",
        (f"reduce speed to {words}{knots}", "reduce"),
        (f"reduce speed {words}{knots}", "reduce"),
        (f"increase speed to {words}{knots}", "increase"),
        (f"maintain {words} knots", "maintain"),
        (f"speed {words} knots", None),
        (f"maintain {words} knots or greater", "or_greater"),
        (f"do not exceed {words} knots", "or_less"),
        (f"maintain speed {words}{knots}", "maintain"),
        (f"slow to {words}{knots}", "reduce"),
    )
    item = Item("speed", speed_kt, "kt", "now", manner)
    bare = Item("speed", speed_kt, "kt")
    return exchange(
        s.source(*METHODS), text, item, text, (f"{words} knots", bare), (f"speed {words}", bare)
    )


def speed_until(s: Scene) -> Exchange:
    """Return a speed now, and the place where it ends."""
    speed_kt = s.speed_kt()
    ends = s.pick(
        f"until {s.fix()}",
        f"until {s.say.count(s.pick(4, 5, 6))} mile final",
        "until the marker",
        f"to {s.fix()}",
        "until advised",
        f"until {s.say.count(s.pick(4, 5))} d m e",
    )
    text = f"maintain {s.say.speed(speed_kt)} knots {ends}"
    item = Item("speed", speed_kt, "kt", "now", "maintain", ends=ends)
    bare = Item("speed", speed_kt, "kt", ends=ends)
    short = text.removeprefix("maintain ")
    return exchange(s.source(*METHODS), text, item, text, (short, bare))


def speed_later(s: Scene) -> Exchange:
    """Return a speed that waits for an event."""
    speed_kt = s.speed_kt()
    fix = s.fix()
    begins = s.pick(f"after {fix}", f"at {fix}", "when established")
    text = f"{begins} reduce speed to {s.say.speed(speed_kt)} knots"
    item = Item("speed", speed_kt, "kt", "conditional", "reduce", begins)
    return exchange(s.source(*METHODS), text, item, text)


def mach(s: Scene) -> Exchange:
    """Return a mach number."""
    hundredths = s.rng.randint(72, 86)
    point = "point " if s.is_faa or s.chance(0.3) else "decimal "
    text = f"maintain mach {point}{s.say.digits(f'{hundredths}')}" + s.pick("", " or greater")
    manner = "or_greater" if "greater" in text else "maintain"
    return exchange(
        s.source(*METHODS), text, Item("mach", hundredths / 100, None, "now", manner), text
    )


def normal_speed(s: Scene) -> Exchange:
    """Return the end of speed control."""
    item, text = s.deal(
        "normal_speed",
        (Item("resume_speed", "normal"), "resume normal speed"),
        (Item("resume_speed", "published"), "resume published speed"),
        (Item("no_speed_restrictions"), "no speed restrictions"),
        (Item("no_speed_restrictions"), "delete speed restrictions"),
        (Item("no_speed_restrictions"), "no a t c speed restrictions"),
    )
    return exchange(s.source("5-7-4", "12.4.1.6"), text, item, text)


def approach_speed(s: Scene) -> Exchange:
    """Return a speed without a number."""
    item, text = s.deal(
        "approach_speed",
        (Item("named_speed", "minimum approach"), "reduce to minimum approach speed"),
        (Item("named_speed", "minimum clean"), "reduce to minimum clean speed"),
        (Item("named_speed", "final approach"), "reduce to final approach speed"),
        (Item("named_speed", "maximum forward"), "maintain maximum forward speed"),
    )
    return exchange(s.source(*METHODS), text, item, text)


def then_descend(s: Scene) -> Exchange:
    """Return a speed now and a level after it, or the other way round."""
    speed_kt = s.speed_kt()
    words, value, unit = s.say.vertical(s.altitude_ft())
    fast = f"reduce speed to {s.say.speed(speed_kt)}"
    both = "and maintain" if s.is_faa else "to"
    down = f"descend {both} {words}"
    if s.chance(0.5):
        text = f"{fast} then {down}"
        items = (
            Item("speed", speed_kt, "kt", "now", "reduce"),
            Item("altitude", value, unit, "conditional", "descend", "after reducing speed"),
        )
    else:
        text = f"{down} then {fast}"
        items = (
            Item("altitude", value, unit, "now", "descend"),
            Item("speed", speed_kt, "kt", "conditional", "reduce", "after reaching the altitude"),
        )
    return exchange(s.source(*METHODS), text, items, text)


def say_speed(s: Scene) -> Exchange:
    """Return a question for a speed, heading or level."""
    what = s.pick("airspeed", "heading", "altitude", "mach number", "position", "assigned speed")
    verb = "say" if s.is_faa else s.pick("report", "confirm")
    return exchange(
        s.source("5-7-2", "12.4.1.6"), f"{verb} {what}", Item("state", what, None, "now")
    )
