"""Headings, directs, routes and holds.

FAA JO 7110.65 5-6-2 ("Methods"), 4-4-1 ("Route use"), 4-6-1 ("Clearance to holding fix"); ICAO Doc
4444 12.4.1.3 ("Vectoring instructions"), 12.3.2.3, 12.3.3.3.
"""

from __future__ import annotations

from .model import Exchange, Item, exchange
from .scene import Scene

VECTORS = ("5-6-2", "12.4.1.3")


def turn(s: Scene) -> Exchange:
    """Return a turn to a heading, or a heading alone."""
    heading_deg = s.heading_deg()
    words = s.say.heading(heading_deg)
    degrees = " degrees" if heading_deg % 10 == 0 and not s.is_faa and s.chance(0.4) else ""
    manner = s.pick("left", "right", None)
    if manner is None:
        text = f"fly heading {words}{degrees}"
    else:
        text = f"turn {manner} heading {words}{degrees}"
    item = Item("heading", heading_deg, "deg", "now", manner)
    bare = Item("heading", heading_deg, "deg")
    side = f"{manner} " if manner else ""
    return exchange(
        s.source(*VECTORS),
        text,
        item,
        text,
        f"{side}heading {words}",
        f"{side}{words}" if manner else f"heading {words}",
        ("heading " + words, bare),
        (f"{words} on the heading", bare),
    )


def turn_by(s: Scene) -> Exchange:
    """Return a turn by a number of degrees, whose heading the call does not say."""
    degrees = s.pick(10, 15, 20, 30, 40)
    manner = s.pick("left", "right")
    text = f"turn {s.say.maybe_group(f'{degrees}', 0.6)} degrees {manner}"
    item = Item("turn_by", degrees, "deg", "now", manner)
    return exchange(s.source(*VECTORS), text, item, text, text.removeprefix("turn "))


def present_heading(s: Scene) -> Exchange:
    """Return the order to stay on the heading."""
    text = s.pick("fly present heading", "continue present heading", "maintain present heading")
    return exchange(s.source(*VECTORS), text, Item("present_heading"), text, "present heading")


def heading_later(s: Scene) -> Exchange:
    """Return a heading that waits for an event."""
    fix, heading_deg = s.fix(), s.heading_deg()
    words = s.say.heading(heading_deg)
    manner = s.pick("left", "right")
    text, manner_said, begins = s.pick(
        (f"depart {fix} heading {words}", None, f"at {fix}"),
        (f"after departure turn {manner} heading {words}", manner, "after departure"),
        (f"when airborne turn {manner} heading {words}", manner, "when airborne"),
        (f"after {fix} fly heading {words}", None, f"after {fix}"),
        (f"leave {fix} heading {words}", None, f"at {fix}"),
        (f"upon departure fly heading {words}", None, "upon departure"),
    )
    item = Item("heading", heading_deg, "deg", "conditional", manner_said, begins)
    return exchange(s.source(*VECTORS), text, item, text)


def heading_until(s: Scene) -> Exchange:
    """Return a heading now, and the direct that follows it."""
    fix, heading_deg = s.fix(), s.heading_deg()
    ends = f"when able proceed direct {fix}"
    text = f"fly heading {s.say.heading(heading_deg)} when able proceed direct {fix}"
    first = Item("heading", heading_deg, "deg", ends=ends)
    second = Item("direct", fix, None, "conditional", begins="when able")
    return exchange(s.source(*VECTORS), text, (first, second), text)


def immediate_turn(s: Scene) -> Exchange:
    """Return a turn to avoid traffic, at once."""
    heading_deg = s.heading_deg()
    manner = s.pick("left", "right")
    words = s.say.heading(heading_deg)
    text = s.deal(
        "immediate_turn",
        f"turn {manner} immediately heading {words}",
        f"avoiding action turn {manner} immediately heading {words}",
        f"traffic alert advise you turn {manner} heading {words} immediately",
    )
    items: tuple[Item, ...] = (
        Item("heading", heading_deg, "deg", "now", manner),
        Item("immediately"),
    )
    if "alert" in text:
        items += (Item("traffic_alert", status="information"),)
    return exchange(s.source("2-1-6", "12.4.1.8"), text, items, text)


def stop_turn(s: Scene) -> Exchange:
    """Return a turn that ends on a heading."""
    heading_deg = s.heading_deg()
    text = f"stop turn heading {s.say.heading(heading_deg)}"
    return exchange(s.source(*VECTORS), text, Item("heading", heading_deg, "deg"), text)


def direct(s: Scene) -> Exchange:
    """Return a direct route to a fix at once."""
    fix = s.fix()
    manner = s.pick("left", "right", None, None, None)
    text = s.pick(
        "proceed direct", "cleared direct", "cleared direct to", "direct", "proceed direct to"
    )
    text = f"turn {manner} {text} {fix}" if manner else f"{text} {fix}"
    item = Item("direct", fix, None, "now", manner)
    return exchange(
        s.source("4-4-1", "12.3.2.3"),
        text,
        item,
        text,
        (f"direct {fix}", Item("direct", fix)),
        (f"direct to {fix}", Item("direct", fix)),
    )


def direct_later(s: Scene) -> Exchange:
    """Return a direct that waits for an event."""
    fix = s.fix()
    begins = s.pick("when able", "when clear of weather", f"after {s.fix()}", "when receiving")
    text = f"{begins} proceed direct {fix}"
    item = Item("direct", fix, None, "conditional", begins=begins)
    return exchange(s.source("4-4-1", "12.3.2.3"), text, item, text)


def own_navigation(s: Scene) -> Exchange:
    """Return the end of vectors."""
    fix = s.fix()
    text = f"resume own navigation direct {fix}" if s.chance(0.6) else "resume own navigation"
    items: tuple[Item, ...] = (Item("own_navigation"),)
    if "direct" in text:
        items += (Item("direct", fix),)
    return exchange(s.source("5-6-2", "12.4.1.4"), text, items, text, text.replace("resume ", ""))


def hold(s: Scene) -> Exchange:
    """Return a hold at a fix, sometimes with its side and the time to expect further clearance."""
    fix = s.fix()
    course = s.pick("north", "south", "east", "west", "northeast", "southwest")
    manner = s.pick(None, "left", "right")
    turns = f" {manner} turns" if manner else ""
    radial = s.say.digits(f"{s.rng.randint(1, 360):03}")
    text = s.pick(
        f"hold {course} of {fix} as published",
        f"hold at {fix} as published",
        f"cleared to {fix} hold {course}{turns}",
        f"hold {course} of {fix} on the {radial} radial{turns}",
    )
    said = manner if manner and f"{manner} turns" in text else None
    items: tuple[Item, ...] = (Item("hold", fix, None, "now", said),)
    if s.chance(0.4):
        time = f"{s.rng.randint(0, 23):02}{s.rng.randint(0, 59):02}"
        text += f" expect further clearance {s.say.digits(time)}"
        items += (Item("time_limit", time, "UTC", "expected", "further_clearance"),)
    return exchange(s.source("4-6-1", "12.3.3.3"), text, items, text)


def expected_direct(s: Scene) -> Exchange:
    """Return a direct or hold to be expected, which is no clearance."""
    fix = s.fix()
    if s.chance(0.4):
        text, item = f"expect holding at {fix}", Item("hold", fix, None, "expected")
    else:
        begins = f"after {s.fix()}"
        text = f"expect direct {fix} {begins}"
        item = Item("direct", fix, None, "expected", begins=begins)
    return exchange(s.source("4-6-1", "12.3.3.3"), text, item, text)


def deviation(s: Scene) -> Exchange:
    """Return leave to deviate round weather."""
    side = s.pick("left", "right", None)
    what = f"deviation {side} of course approved" if side else "deviation approved"
    fix = s.fix()
    text = f"{what} when able proceed direct {fix}"
    items = (
        Item("deviation", None, None, "now", side),
        Item("direct", fix, None, "conditional", begins="when able"),
    )
    return exchange(s.source("2-6-4", "12.3.2.3"), text, items, text)


def orbit(s: Scene) -> Exchange:
    """Return a circle for spacing."""
    manner = s.pick("left", "right")
    what = "three sixty" if s.is_faa else "orbit"
    text = f"make a {manner} {what}" if s.is_faa else f"orbit {manner}"
    return exchange(
        s.source("3-8-1", "12.3.4.17"), text, Item("orbit", None, None, "now", manner), text
    )
