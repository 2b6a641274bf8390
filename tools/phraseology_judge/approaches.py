"""Approach clearances: FAA JO 7110.65 4-8-1, 5-9-4, 7-4-3; ICAO Doc 4444 12.3.3.2, 12.4.2."""

from __future__ import annotations

from .model import Exchange, Item, Phrase, exchange
from .scene import Scene

CLEARANCE = ("4-8-1", "12.3.3.2")
TYPES = {
    "ils": "ILS",
    "i l s": "ILS",
    "rnav": "RNAV",
    "r nav": "RNAV",
    "gps": "GPS",
    "rnp": "RNP",
    "localizer": "LOC",
    "localiser": "LOC",
    "v o r": "VOR",
    "vor": "VOR",
    "ndb": "NDB",
    "localizer back course": "LOC BC",
}
"""Types of instrument approach by the words."""


def named(s: Scene) -> tuple[str, dict[str, str]]:
    """Return the words and the value of an instrument approach to the runway in use."""
    spoken = s.pick(*TYPES)
    variant = ""
    letter = s.pick("Y", "Z", "X")
    if TYPES[spoken] in ("RNAV", "ILS") and s.chance(0.25):
        variant = f" {s.say.letter(letter)}"
    runway, ident = s.runway()
    value = {"type": TYPES[spoken], "runway": ident}
    if variant:
        value["variant"] = letter
    return f"{spoken}{variant} {runway}", value


def cleared(s: Scene) -> Exchange:
    """Return a clearance for an instrument approach."""
    words, value = named(s)
    straight = s.pick("", "", "", "straight in ")
    end = " approach" if s.is_faa or s.chance(0.7) else ""
    text = f"cleared {straight}{words}{end}"
    item = Item("approach", value, None, "now", "straight_in" if straight else None)
    bare = Item("approach", value)
    return exchange(
        s.source(*CLEARANCE),
        text,
        item,
        text,
        (f"cleared {words}", bare),
        (f"cleared the {words}", bare),
    )


def cleared_without_name(s: Scene) -> Exchange:
    """Return a clearance that leaves out the type, the runway or both."""
    text, value = s.pick(
        ("cleared approach", None),
        ("cleared ils approach", {"type": "ILS"}),
        ("cleared straight in v o r approach", {"type": "VOR"}),
        ("cleared rnav approach", {"type": "RNAV"}),
    )
    return exchange(s.source(*CLEARANCE), text, Item("approach", value), text)


def visual(s: Scene) -> Exchange:
    """Return a clearance for a visual approach."""
    runway, ident = s.runway()
    value = {"type": "VISUAL", "runway": ident}
    text = s.pick(f"cleared visual approach {runway}", f"cleared for the visual {runway}")
    items: tuple[Item, ...] = (Item("approach", value),)
    if s.chance(0.25):
        other = s.other_callsign()
        text = f"follow {other} {text}"
        items += (Item("follow"),)
    return exchange(
        s.source("7-4-3", "12.3.3.2"), text, items, text, (f"cleared visual {runway}", items[0])
    )


def vectored(s: Scene) -> Exchange:
    """Return position, turn, level until established and clearance in one call (5-9-4)."""
    words, value = named(s)
    fix, heading_deg, altitude_ft = s.fix(), s.heading_deg(), s.rng.randint(3, 10) * 500
    manner = s.pick("left", "right")
    until = s.pick("until established", f"until {fix}", "until established on the localizer")
    miles = s.rng.randint(3, 12)
    place = f"{s.say.count(miles)} miles from {fix} " if s.chance(0.6) else ""
    heading, level = s.say.heading(heading_deg), s.say.altitude(altitude_ft)
    text = (
        f"{place}turn {manner} heading {heading} maintain {level}"
        f"{s.pick(' or above', '')} {until} cleared {words}{s.pick(' approach', '')}"
    )
    level_manner = "or_above" if "or above" in text else "maintain"
    items = [
        Item("heading", heading_deg, "deg", "now", manner),
        Item("altitude", altitude_ft, "ft", "now", level_manner, ends=until),
        Item("approach", value),
    ]
    if place:
        items.insert(0, Item("position", {"fix": fix, "distance_nm": miles}, None, "information"))
    short = f"{manner} heading {heading} maintain {level} {until} cleared {words}"
    answer = Phrase(
        short,
        (
            Item("heading", heading_deg, "deg", "readback", manner),
            Item("altitude", altitude_ft, "ft", "readback", "maintain", ends=until),
            Item("approach", value, None, "readback"),
        ),
        s.source("5-9-4", "12.4.2.1"),
    )
    found = exchange(s.source("5-9-4", "12.4.2.1"), text, tuple(items))
    return Exchange(found.instruction, (answer,))


def intercept(s: Scene) -> Exchange:
    """Return a heading to a final approach course, without a clearance for the approach."""
    runway, ident = s.runway()
    heading_deg = s.heading_deg()
    manner = s.pick("left", "right")
    what = s.pick("localizer", "final approach course")
    text = f"turn {manner} heading {s.say.heading(heading_deg)} intercept {runway} {what}"
    items = (
        Item("heading", heading_deg, "deg", "now", manner),
        Item("intercept", {"course": what, "runway": ident}),
    )
    return exchange(s.source("5-9-1", "12.4.2.2"), text, items, text)


def at_fix(s: Scene) -> Exchange:
    """Return a clearance for an approach from a fix that is to be crossed at a level."""
    words, value = named(s)
    fix, altitude_ft = s.fix(), s.rng.randint(3, 12) * 500
    above = s.pick("at or above", "at")
    text = f"cross {fix} {above} {s.say.altitude(altitude_ft)} cleared {words} approach"
    relation = above.replace(" ", "_")
    items = (
        Item(
            "crossing_restriction",
            {"fix": fix, "relation": relation, "altitude": altitude_ft},
            "ft",
        ),
        Item("approach", value),
    )
    return exchange(s.source(*CLEARANCE), text, items, text)


def circling(s: Scene) -> Exchange:
    """Return an approach to one runway that ends on another."""
    words, value = named(s)
    other = s.another_runway()
    text = f"cleared {words} approach circle to runway {s.say.runway(other)}"
    return exchange(
        s.source("4-8-6", "12.3.3.2"), text, (Item("approach", value), Item("circle", other)), text
    )


def expected(s: Scene) -> Exchange:
    """Return an approach to be expected, which is no clearance."""
    if s.chance(0.4):
        runway, ident = s.runway()
        value = {"type": "VISUAL", "runway": ident}
        words = f"visual approach {runway}"
    else:
        words, value = named(s)
    vectors = s.pick("vectors ", "", "")
    text = f"expect {vectors}{words}" + s.pick(" approach" if "visual" not in words else "", "")
    item = Item("approach", value, None, "expected")
    return exchange(s.source("4-7-10", "12.3.3.2"), text, item, text, f"we'll expect the {words}")


def cancel_approach(s: Scene) -> Exchange:
    """Return the end of an approach clearance, with what to do instead."""
    altitude_ft, heading_deg = s.low_ft(), s.heading_deg()
    manner = s.pick("left", "right")
    words, value, unit = s.say.vertical(altitude_ft)
    text = (
        f"cancel approach clearance climb and maintain {words} "
        f"turn {manner} heading {s.say.heading(heading_deg)}"
    )
    items = (
        Item("cancel_approach"),
        Item("altitude", value, unit, "now", "climb"),
        Item("heading", heading_deg, "deg", "now", manner),
    )
    return exchange(s.source("4-8-1", "12.3.3.2"), text, items, text)


def missed_approach_instructions(s: Scene) -> Exchange:
    """Return what to do in the case of a missed approach, which has not happened."""
    altitude_ft, heading_deg = s.low_ft(), s.heading_deg()
    words, value, unit = s.say.vertical(altitude_ft)
    begins = "in the event of missed approach"
    text = f"{begins} fly heading {s.say.heading(heading_deg)} climb and maintain {words}"
    items = (
        Item("heading", heading_deg, "deg", "conditional", begins=begins),
        Item("altitude", value, unit, "conditional", "climb", begins),
    )
    return exchange(s.source("4-8-9", "12.3.4.18"), text, items, text)
