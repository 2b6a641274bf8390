"""Calls on the ground and clearances of delivery.

FAA JO 7110.65 3-7-2 ("Taxi and ground movement operations"), 4-3-2; ICAO Doc 4444 12.3.4.3 to
12.3.4.9.
"""

from __future__ import annotations

from . import names
from .model import Exchange, Item, exchange
from .scene import Scene
from .speech_parts import altimeter

TAXI = ("3-7-2", "12.3.4.7")


def taxi(s: Scene) -> Exchange:
    """Return a taxi clearance to a runway, with holds and crossings on the way."""
    runway, ident = s.runway()
    words, route = s.route()
    if s.is_faa:
        text = s.pick(f"{runway} taxi via {words}", f"taxi to {runway} via {words}")
    else:
        text = f"taxi to holding point {runway} via {words}"
    items = [Item("taxi", {"to": f"runway {ident}", "via": route})]
    other = s.another_runway()
    said = s.say.runway(other)
    if s.chance(0.3):
        text += f" hold short of runway {said}"
        items.append(Item("hold_short", other))
    elif s.chance(0.3):
        text += f" cross runway {said}"
        items.append(Item("cross_runway", other))
    elif s.chance(0.15):
        taxiway = s.rng.choice(names.TAXIWAYS)
        text += f" hold short of {s.taxiway(taxiway)}"
        items.append(Item("hold_short", taxiway))
    hold = items[1:] and items[1].kind == "hold_short"
    back = f"{runway} via {words}" + (
        f" holding short of runway {said}" if hold and items[1].value == other else ""
    )
    if hold and items[1].value != other:
        back = text
    elif items[1:] and not hold:
        back += f" cross runway {said}"
    return exchange(s.source(*TAXI), text, tuple(items), text, back)


def taxi_to_parking(s: Scene) -> Exchange:
    """Return a taxi clearance to a stand."""
    words, route = s.route()
    number = f"{s.rng.randint(1, 60)}"
    where = s.pick("gate", "stand", "the ramp", "parking")
    place = f"{where} {s.say.maybe_group(number)}" if where in ("gate", "stand") else where
    text = f"taxi to {place} via {words}"
    to = f"{where} {number}" if place != where else where
    return exchange(s.source(*TAXI), text, Item("taxi", {"to": to, "via": route}), text)


def give_way(s: Scene) -> Exchange:
    """Return an order about another aircraft on the ground, which may be named."""
    other = s.pick(s.other_callsign(), f"the {s.rng.choice(names.TRAFFIC_TYPES)}")
    where = s.pick("from your right", "from your left", "passing left to right", "ahead")
    kind, verb = s.deal(
        "give_way", ("give_way", "give way to"), ("follow", "follow"), ("give_way", "pass behind")
    )
    text = f"{verb} {other} {where}"
    return exchange(s.source(*TAXI), text, Item(kind), text)


def taxi_later(s: Scene) -> Exchange:
    """Return a taxi order that waits for another aircraft."""
    words, route = s.route()
    other = s.rng.choice(names.TRAFFIC_TYPES)
    begins = f"after the {other} passes"
    text = f"{begins} continue taxi via {words}"
    item = Item("taxi", {"via": route}, None, "conditional", begins=begins)
    return exchange(s.source(*TAXI), text, item, text)


def pushback(s: Scene) -> Exchange:
    """Return leave for start-up or pushback."""
    way = s.pick("", " tail north", " facing east", " onto taxiway " + s.taxiway("B4"))
    kind, text = s.deal(
        "pushback",
        ("pushback", f"pushback approved{way}"),
        ("pushback", f"push approved{way}"),
        ("startup", "start up approved"),
        ("pushback", f"start up and pushback approved{way}"),
    )
    items: tuple[Item, ...] = (Item(kind),)
    if "start up and" in text:
        items = (Item("startup"), Item("pushback"))
    return exchange(s.source("3-7-1", "12.3.4.4"), text, items, text)


def backtrack(s: Scene) -> Exchange:
    """Return the order to taxi back on the runway."""
    runway, ident = s.runway()
    text = s.pick(f"backtrack {runway}", f"back taxi {runway}")
    return exchange(s.source(*TAXI), text, Item("backtrack", ident), text)


def continue_taxi(s: Scene) -> Exchange:
    """Return an order without a route."""
    kind, text = s.deal(
        "continue_taxi",
        ("hold_position", "hold position"),
        ("continue_taxi", "continue taxi"),
        ("continue_taxi", "continue"),
        ("expedite", "expedite taxi"),
        ("hold_position", "stop hold position"),
    )
    back = {"hold_position": "holding position"}.get(kind, text)
    return exchange(s.source(*TAXI), text, Item(kind), back)


def route_clearance(s: Scene) -> Exchange:
    """Return an IFR clearance with its limit, departure, level, frequency and code (4-3-2)."""
    limit, procedure = s.airport(), s.procedure()
    words, value, unit = s.say.vertical(s.low_ft())
    high, expected, high_unit = s.say.vertical(s.rng.randint(24, 39) * 1000)
    khz = s.khz()
    squawk = "".join(f"{s.rng.randint(0, 7)}" for _ in range(4))
    climb = s.pick(f"maintain {words}", f"climb and maintain {words}")
    if not s.is_faa:
        climb = f"climb to {words}"
    text = (
        f"cleared to {limit} airport {procedure} departure then as filed {climb} "
        f"expect {high} ten minutes after departure "
        f"departure frequency {s.say.frequency(khz)} squawk {s.say.code(squawk)}"
    )
    begins = "ten minutes after departure"
    manner = "climb" if "climb" in climb else "maintain"
    items = (
        Item("clearance_limit", limit),
        Item("departure", procedure),
        Item("altitude", value, unit, "conditional", manner, "after departure"),
        Item("altitude", expected, high_unit, "expected", begins=begins),
        Item("frequency", khz, "kHz", "conditional", begins="after departure"),
        Item("squawk", squawk),
    )
    return exchange(s.source("4-3-2", "12.3.2.1"), text, items, text.replace("airport ", ""))


def amended_route(s: Scene) -> Exchange:
    """Return a change of route."""
    first, second = s.fix(), s.fix()
    text = f"change route to read after {first} direct {second} rest of route unchanged"
    item = Item("direct", second, None, "conditional", begins=f"after {first}")
    return exchange(s.source("4-2-5", "12.3.2.1"), text, item, text)


def release(s: Scene) -> Exchange:
    """Return a hold for release or the time at which a clearance ends."""
    time = f"{s.rng.randint(0, 23):02}{s.rng.randint(0, 59):02}"
    said = s.say.digits(time)
    text, item = s.deal(
        "release",
        (
            f"hold for release expect {s.say.count(s.pick(10, 15, 20))} minute departure delay",
            Item("hold_for_release"),
        ),
        (
            f"released for departure clearance void if not off by {said}",
            Item("time_limit", time, "UTC", manner="clearance_void"),
        ),
        (f"e d c t {said}", Item("time_limit", time, "UTC", "expected", "departure")),
    )
    return exchange(s.source("4-3-4", "12.3.3.1"), text, item, text)


def setting(s: Scene) -> Exchange:
    """Return an altimeter setting."""
    words, value, unit = altimeter(s)
    item = Item("altimeter", value, unit, "information")
    short = words.removeprefix(f"{s.city} ")
    return exchange(s.source("2-7-2", "12.3.1.11"), words, item, short)
