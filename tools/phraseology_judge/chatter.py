"""Calls that ask for nothing, or that name a clearance without giving it."""

from __future__ import annotations

from dataclasses import replace

from .lateral import turn
from .model import Exchange, Item, Phrase, information
from .scene import Scene
from .vertical import climb_or_descend

SMALL_TALK = (
    "good morning|thanks for your help have a good one|so long|how's the ride|smooth so far|"
    "you're welcome|happy holidays|sorry about that|go ahead|i'll get back to you|"
    "it'll be a few minutes|we'll let you know|no problem|auf wiedersehen|bonne journee|"
    "radio check|read you five by five|blocked|you were stepped on|are you on frequency|"
    "how do you hear|welcome back|nice landing|hold that thought|i'll have your clearance shortly|"
    "left the pen on the right seat|we are heading home|direct question who cleared the table|"
    "the line up at the coffee bar is long|taxi driver is late|expect nothing and be happy"
).split("|")
"""Words without an instruction; the last ones have the words of instructions in them."""


def small_talk(s: Scene) -> Phrase:
    """Return words without an item."""
    return Phrase(s.rng.choice(SMALL_TALK), (), "none: small talk")


def broadcast(s: Scene) -> Phrase:
    """Return a broadcast to all aircraft (FAA JO 7110.65 2-9-2, 2-6-2)."""
    letter = s.rng.choice("ABCDEFGHIKLMNOPQRSTUVWYZ")
    runway, ident = s.runway()
    said = s.say.letter(letter)
    text, items = s.deal(
        "broadcast",
        (
            f"attention all aircraft information {said} is now current",
            (information("atis", letter),),
        ),
        (
            f"all stations {s.city} landing {runway} from now on",
            (information("runway_state", {"runway": ident, "state": "in use"}),),
        ),
        ("attention all aircraft hazardous weather information available", ()),
        (
            f"break break all aircraft {runway} is closed",
            (information("runway_state", {"runway": ident, "state": "closed"}),),
        ),
    )
    return Phrase(text, items, "FAA JO 7110.65 2-9-2")


def hearsay(s: Scene) -> Phrase:
    """Return talk of a clearance that is not given with it."""
    words, value, unit = s.say.vertical(s.altitude_ft())
    runway, _ = s.runway()
    heading = s.say.heading(s.heading_deg())
    text = s.pick(
        f"i'll have higher for you in about {s.say.count(10)} miles",
        f"unable {words} due traffic",
        f"the aircraft ahead was assigned heading {heading}",
        f"i have your request for {runway} on file",
        "takeoff clearance will come from the tower",
        f"company ahead of you landed {runway} and reported good braking",
        f"you can plan on {words} with the next sector",
    )
    if text.startswith("unable"):
        return Phrase(text, (information("unable", "altitude"),), "FAA JO 7110.65 2-4-9")
    if text.startswith("you can plan"):
        return Phrase(text, (Item("altitude", value, unit, "expected"),), "FAA JO 7110.65 2-4-9")
    return Phrase(text, (), "none: talk of a clearance")


def withdrawn(s: Scene) -> Exchange:
    """Return an instruction that the same call takes back (Annex 10 volume II 5.2.1.5.8)."""
    found = (turn if s.chance(0.5) else climb_or_descend)(s).instruction
    items = tuple(replace(item, status="withdrawn") for item in found.items)
    text = f"{found.text} {s.pick('disregard', 'disregard that')}"
    source = "ICAO Annex 10 volume II 5.2.1.5.8"
    disregard = Item("disregard")
    return Exchange(
        Phrase(text, (*items, disregard), source),
        (Phrase("roger disregard", (disregard.read_back(),), source),),
    )
