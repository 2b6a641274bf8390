"""Calls of a tower: FAA JO 7110.65 3-8 to 3-10; ICAO Doc 4444 12.3.4.8 to 12.3.4.20, 12.2.7."""

from __future__ import annotations

from . import names
from .model import Exchange, Item, exchange, information
from .scene import Scene
from .speech_parts import wind

AIRCRAFT_AHEAD = (
    "landing airbus|landing boeing on short final|departing seven thirty seven|"
    "d c nine on short final|departing cessna|landing dash eight|airbus on a two mile final"
).split("|")


def takeoff(s: Scene) -> Exchange:
    """Return a clearance for take-off, sometimes with wind and heading."""
    runway, ident = s.runway()
    item = Item("takeoff", ident)
    where = ""
    if s.chance(0.15):
        letter = s.rng.choice(names.TAXIWAYS)
        where = f" at {s.taxiway(letter)}"
    elif s.chance(0.08):
        where = " full length"
    if s.is_faa:
        text = f"{runway}{where} cleared for {s.pick('takeoff', 'takeoff', 'take off')}"
        text = s.pick(text, text, f"cleared for takeoff {runway}{where}")
    else:
        text = s.pick(f"{runway} cleared for take off", f"cleared for take off {runway}")
    if s.chance(0.12):
        text = text.replace("cleared for take", "cleared for immediate take")
    items = [item]
    if s.chance(0.35):
        words, found = wind(s)
        text = f"{words} {text}" if s.chance(0.6) else f"{text} {words}"
        items.append(found)
    if s.chance(0.3):
        heading_deg = s.heading_deg()
        manner = s.pick("left", "right", None)
        fly = f"turn {manner}" if manner else "fly"
        text = f"{fly} heading {s.say.heading(heading_deg)} {text}"
        items.append(Item("heading", heading_deg, "deg", "conditional", manner, "when airborne"))
        answer = f"cleared for takeoff {runway}"
    else:
        answer = s.pick(f"cleared for takeoff {runway}", f"cleared for takeoff {runway[7:]}")
    short = s.pick("cleared for takeoff", "cleared to go")
    return exchange(
        s.source("3-9-10", "12.3.4.11"),
        text,
        tuple(items),
        (answer, item),
        (short, Item("takeoff")),
    )


def landing(s: Scene) -> Exchange:
    """Return a clearance to land, sometimes with wind or the number in the sequence."""
    runway, ident = s.runway()
    item = Item("landing", ident)
    text = s.pick(f"{runway} cleared to land", f"cleared to land {runway}")
    items = [item]
    if s.chance(0.4):
        words, found = wind(s)
        text = f"{words} {text}" if s.chance(0.6) else f"{text} {words}"
        items.append(found)
    elif s.chance(0.25):
        number = s.rng.randint(2, 4)
        ahead = s.rng.choice(names.TRAFFIC_TYPES)
        text = f"number {s.say.count(number)} following {ahead} {text}"
        items += [information("sequence", number)]
    elif s.chance(0.15):
        text += " traffic will hold in position"
        items += [information("traffic", {"position": "on the runway"})]
    return exchange(
        s.source("3-10-5", "12.3.4.16"),
        text,
        tuple(items),
        (f"cleared to land {runway}", item),
        (f"cleared to land {runway[7:]}", item),
        ("cleared to land", Item("landing")),
        (f"{runway} cleared to land", item),
    )


def option(s: Scene) -> Exchange:
    """Return a clearance for the option, a touch-and-go, a low approach or a stop-and-go."""
    runway, ident = s.runway()
    kind, words = s.deal(
        "option",
        ("option", "cleared for the option"),
        ("touch_and_go", "cleared touch and go"),
        ("low_approach", "cleared low approach"),
        ("stop_and_go", "cleared stop and go"),
    )
    text = s.pick(f"{runway} {words}", f"{words} {runway}")
    return exchange(s.source("3-8-2", "12.3.4.16"), text, Item(kind, ident), text)


def line_up(s: Scene) -> Exchange:
    """Return the order to line up, at once."""
    runway, ident = s.runway()
    item = Item("line_up_and_wait", ident)
    text = s.pick(f"{runway} line up and wait", f"line up and wait {runway}")
    items: tuple[Item, ...] = (item,)
    if s.chance(0.3):
        miles = s.rng.randint(3, 8)
        text += f" traffic on a {s.say.count(miles)} mile final"
        items += (information("traffic", {"position": "final", "distance_nm": miles}),)
    return exchange(
        s.source("3-9-4", "12.3.4.10"),
        text,
        items,
        (f"line up and wait {runway}", item),
        (f"lining up and waiting {runway}", item),
        ("line up and wait", Item("line_up_and_wait")),
    )


def line_up_behind(s: Scene) -> Exchange:
    """Return a line-up that waits for another aircraft: condition, order, condition (12.2.7)."""
    runway, ident = s.runway()
    ahead = s.rng.choice(AIRCRAFT_AHEAD)
    begins = f"behind the {ahead}"
    ready = s.pick("", " line up and wait")
    order = f"line up and wait {runway}" if ready else f"line up {runway}"
    kind = "cross_runway" if s.chance(0.25) else "line_up_and_wait"
    if kind == "cross_runway":
        order = f"cross {runway}"
    text = f"behind {s.pick('the ', '')}{ahead} {order} behind"
    item = Item(kind, ident, None, "conditional", begins=begins)
    return exchange("ICAO Doc 4444 12.2.7", text, item, text, f"{order} behind the {ahead}")


def hold_short(s: Scene) -> Exchange:
    """Return the order to hold short of a runway or to hold where it is."""
    runway, ident = s.runway()
    text, item = s.deal(
        "hold_short",
        (f"hold short of {runway}", Item("hold_short", ident)),
        (f"hold short {runway}", Item("hold_short", ident)),
        (f"{runway} hold short", Item("hold_short", ident)),
        ("hold position", Item("hold_position")),
        (f"hold short of {runway} traffic on final", Item("hold_short", ident)),
    )
    back = text.replace("hold ", "holding ", 1).replace(" traffic on final", "")
    return exchange(
        s.source("3-7-2", "12.3.4.8"), text, item, back, text.replace(" traffic on final", "")
    )


def go_around(s: Scene) -> Exchange:
    """Return the order to go around, sometimes with what follows."""
    items: tuple[Item, ...] = (Item("go_around"),)
    text = s.pick(
        "go around", "go around i say again go around", "go around aircraft on the runway"
    )
    if s.chance(0.5):
        heading_deg, value_ft = s.heading_deg(), s.low_ft()
        words, value, unit = s.say.vertical(value_ft)
        manner = s.pick("left", "right")
        to = "and maintain" if s.is_faa else "to"
        text = f"go around turn {manner} heading {s.say.heading(heading_deg)} climb {to} {words}"
        items += (
            Item("heading", heading_deg, "deg", "now", manner),
            Item("altitude", value, unit, "now", "climb"),
        )
    elif s.chance(0.3):
        text = s.pick("go around make left traffic", "go around fly runway heading")
        items += (
            (Item("circuit", None, None, "now", "left traffic"),)
            if "traffic" in text
            else (Item("runway_heading"),)
        )
    return exchange(
        s.source("3-8-1", "12.3.4.18"), text, items, ("going around", Item("go_around")), text
    )


def cancel_takeoff(s: Scene) -> Exchange:
    """Return the end of a take-off clearance, before or during the roll."""
    kind, text, back = s.deal(
        "cancel_takeoff",
        ("cancel_takeoff", "cancel takeoff clearance", "cancel takeoff clearance"),
        ("cancel_takeoff", "cancel takeoff clearance vehicle on the runway", "takeoff cancelled"),
        (
            "cancel_takeoff",
            "hold position cancel take off i say again cancel take off",
            "holding",
        ),
        ("stop", "stop immediately {} stop immediately", "stopping"),
        ("stop", "stop immediately", "stopping"),
    )
    text = text.format(s.callsign())
    items: tuple[Item, ...] = (Item(kind),)
    if "hold position" in text:
        items += (Item("hold_position"),)
    answer = Item("hold_position") if back == "holding" else Item(kind)
    return exchange(s.source("3-9-11", "12.3.4.11"), text, items, (back, answer))


def vacate(s: Scene) -> Exchange:
    """Return where to leave the runway."""
    taxiway = s.rng.choice(names.TAXIWAYS)
    words = s.taxiway(taxiway)
    manner = s.pick("left", "right")
    text = s.pick(
        f"turn {manner} at {words}" if s.is_faa else f"vacate {manner} via {words}",
        f"exit {manner} {words}" if s.is_faa else f"take first {manner} {words}",
    )
    item = Item("vacate_runway", taxiway, None, "now", manner)
    return exchange(s.source("3-10-9", "12.3.4.20"), text, item, text)


def circuit(s: Scene) -> Exchange:
    """Return an order in the traffic circuit."""
    runway, ident = s.runway()
    side = s.pick("left", "right")
    text, manner = s.deal(
        "circuit",
        (f"enter {side} downwind {runway}", f"{side} downwind"),
        (f"join {side} hand downwind {runway}", f"{side} downwind"),
        (f"make {side} traffic {runway}", f"{side} traffic"),
        ("extend downwind tower will call your base", "extend downwind"),
        ("make short approach", "short approach"),
        (f"make straight in {runway}", "straight in"),
        (f"enter {side} base {runway}", f"{side} base"),
    )
    value = ident if runway in text else None
    return exchange(
        s.source("3-10-1", "12.3.4.13"), text, Item("circuit", value, None, "now", manner), text
    )


def sequence(s: Scene) -> Exchange:
    """Return the number in the sequence and whom to follow; no clearance to land."""
    number = s.rng.randint(2, 5)
    ahead = s.pick(s.rng.choice(names.TRAFFIC_TYPES), s.other_callsign())
    where = s.pick("on final", "turning base", "on a short final", "abeam the tower")
    text = f"number {s.say.count(number)} follow {ahead} {where}"
    items = (information("sequence", number), Item("follow"))
    return exchange(s.source("3-8-1", "12.3.4.14"), text, items, text)


def expected_clearance(s: Scene) -> Exchange:
    """Return words about a landing or take-off that clear for neither."""
    runway, ident = s.runway()
    going_on = Item("continue_approach", ident)
    text, items = s.deal(
        "expected_clearance",
        (
            f"continue {runway} expect late landing clearance",
            (going_on, Item("landing", ident, None, "expected")),
        ),
        (f"{runway} continue traffic departing", (going_on,)),
        (f"{runway} continue approach", (going_on,)),
        ("continue approach", (Item("continue_approach"),)),
        (
            "be ready for immediate departure",
            (Item("takeoff", status="expected", manner="immediate"),),
        ),
        (
            f"expect departure {runway} in two minutes",
            (Item("takeoff", ident, None, "expected", begins="in two minutes"),),
        ),
        ("report ready for departure", (Item("report", "ready for departure"),)),
        ("are you ready for immediate departure", (Item("state", "ready for departure"),)),
    )
    return exchange(s.source("3-9-1", "12.3.4.10"), text, items, text)


def departure_restriction(s: Scene) -> Exchange:
    """Return what to do after the take-off, without a clearance for it."""
    text, item = s.deal(
        "departure_restriction",
        (
            "fly runway heading after departure",
            Item("runway_heading", status="conditional", begins="after departure"),
        ),
        (
            "after departure make right traffic",
            Item("circuit", None, None, "conditional", "right traffic", "after departure"),
        ),
    )
    return exchange(s.source("3-9-3", "12.3.4.12"), text, item, text)


def cross(s: Scene) -> Exchange:
    """Return the order to cross a runway."""
    runway, ident = s.runway()
    where = ""
    if s.chance(0.4):
        where = f" at {s.taxiway(s.rng.choice(names.TAXIWAYS))}"
    hurry = s.pick("", "", "", " without delay")
    text = f"cross {runway}{where}{hurry}"
    item = Item("cross_runway", ident)
    return exchange(
        s.source("3-7-2", "12.3.4.9"), text, item, text, text.replace("cross", "crossing", 1)
    )
