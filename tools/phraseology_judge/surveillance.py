"""Transponder, radar service, frequencies, traffic and warnings.

FAA JO 7110.65 2-1-17, 2-1-20, 2-1-21, 5-2, 5-3; ICAO Doc 4444 12.3.1.4, 12.3.1.7, 12.4.1, 12.4.3.
"""

from __future__ import annotations

from . import names
from .model import Exchange, Item, Status, exchange, information, report
from .scene import Scene
from .speech_parts import wind

UNITS = "tower ground approach departure center control radar arrival director delivery".split()
DIRECTIONS = "northbound southbound eastbound westbound".split()


def contact(s: Scene) -> Exchange:
    """Return a change of frequency at once."""
    khz = s.khz()
    words = s.say.frequency(khz)
    manner = s.pick("contact", "contact", "contact", "monitor")
    city = s.pick(s.city + " ", "")
    unit = s.rng.choice(UNITS)
    on = s.pick("", "", "on ")
    text = s.pick(
        f"{manner} {city}{unit} {on}{words}",
        f"{manner} {city}{unit} {on}{words}",
        f"{manner} {unit} {words}",
        f"change to my frequency {words}",
    )
    manner = "change" if text.startswith("change") else manner
    item = Item("frequency", khz, "kHz", "now", manner)
    bare = Item("frequency", khz, "kHz")
    return exchange(
        s.source("2-1-17", "12.3.1.4"),
        text,
        item,
        (f"{unit} {words}" if unit in text else words, bare),
        (words, bare),
        (f"over to {unit} {words}" if unit in text else words, bare),
    )


def contact_without_number(s: Scene) -> Exchange:
    """Return a change to a unit whose frequency is known."""
    unit = s.pick("tower", "ground", "departure", "ground point niner", "tower crossing the marker")
    manner = s.pick("contact", "contact", "monitor")
    begins = None
    if "crossing" in unit:
        begins = "crossing the marker"
    unit_name = unit.split()[0]
    value = {"unit": unit_name}
    if "niner" in unit:
        value["fraction"] = "9"
    status: Status = "conditional" if begins else "now"
    item = Item("frequency", value, None, status, manner, begins)
    bare = Item("frequency", value, None, status, None, begins)
    return exchange(
        s.source("2-1-17", "12.3.1.4"),
        f"{manner} {unit}",
        item,
        (f"over to {unit}", bare),
        (unit, bare),
    )


def contact_later(s: Scene) -> Exchange:
    """Return a change of frequency that waits for an event."""
    khz = s.khz()
    begins = s.pick(
        "when airborne", f"passing {s.fix()}", "when vacated", f"at {s.fix()}", "after departure"
    )
    text = f"{begins} contact {s.city} {s.rng.choice(UNITS)} {s.say.frequency(khz)}"
    item = Item("frequency", khz, "kHz", "conditional", "contact", begins)
    return exchange(s.source("2-1-17", "12.3.1.4"), text, item, text)


def frequency_change(s: Scene) -> Exchange:
    """Return leave to change frequency, or the end of radar service."""
    text, items = s.deal(
        "frequency_change",
        ("frequency change approved", (Item("frequency_change_approved"),)),
        (
            "radar service terminated squawk v f r frequency change approved",
            (
                information("radar_service_terminated"),
                Item("squawk", "1200"),
                Item("frequency_change_approved"),
            ),
        ),
        ("remain this frequency", (Item("remain_on_frequency"),)),
        ("radar service terminated", (information("radar_service_terminated"),)),
        ("stand by this frequency for tower", (Item("remain_on_frequency"),)),
    )
    return exchange(s.source("2-1-17", "12.3.1.4"), text, items, text)


def squawk(s: Scene) -> Exchange:
    """Return a transponder code, with ident sometimes."""
    code = "".join(f"{s.rng.randint(0, 7)}" for _ in range(4))
    if s.chance(0.2):
        code = s.pick("1200", "7000", "2000", "1000")
    words = s.say.code(code)
    item = Item("squawk", code)
    text = f"squawk {words}"
    items: tuple[Item, ...] = (item,)
    if s.chance(0.3):
        text += s.pick(" and ident", " ident")
        items += (Item("ident"),)
    return exchange(s.source("5-2-1", "12.4.3.3"), text, items, text, (words, item))


def transponder(s: Scene) -> Exchange:
    """Return an order to the transponder without a code."""
    mode, text = s.deal(
        "transponder",
        ("ident", "ident"),
        ("ident", "squawk ident"),
        ("standby", "squawk standby"),
        ("altitude", "squawk altitude"),
        ("charlie", "squawk charlie"),
        ("reset", "reset transponder"),
        ("stop", "stop squawk"),
        ("confirm", "confirm squawk"),
    )
    item = Item("ident") if mode == "ident" else Item("transponder", mode)
    back = "ident" if mode == "ident" else text
    return exchange(s.source("5-3-3", "12.4.3.6"), text, item, back)


def radar_contact(s: Scene) -> Exchange:
    """Return an identification, with the place sometimes."""
    miles, fix = s.rng.randint(2, 40), s.fix()
    place = f" {s.say.count(miles)} miles {s.pick('north', 'south', 'east', 'west')} of {fix}"
    text = s.deal(
        "radar_contact",
        "radar contact",
        "identified",
        f"radar contact{place}",
        "radar contact lost",
    )
    kind = "radar_contact_lost" if "lost" in text else "radar_contact"
    items: tuple[Item, ...] = (information(kind),)
    if place in text:
        items += (information("position", {"fix": fix, "distance_nm": miles}),)
    return exchange(s.source("5-3-7", "12.4.1.1"), text, items)


def traffic(s: Scene) -> Exchange:
    """Return a traffic advisory, whose numbers are no instruction."""
    clock, miles = s.rng.randint(1, 12), s.rng.randint(1, 15)
    words, level, unit = s.say.vertical(s.altitude_ft())
    kind, bound = s.rng.choice(names.TRAFFIC_TYPES), s.rng.choice(DIRECTIONS)
    value: dict[str, str | int] = {"oclock": clock, "distance_nm": miles}
    text = f"traffic {s.say.count(clock)} o'clock {s.say.count(miles)} miles {bound}"
    tail = s.pick(
        f"{kind} {words}", kind, f"{words} {kind}", "altitude unknown", "indicated " + words
    )
    if words in tail:
        value |= {"altitude": level, "unit": unit}
    text += f" {tail}"
    more = s.pick(
        "",
        "",
        " converging",
        " climbing through",
        " report in sight",
        " maintain visual separation",
    )
    items: tuple[Item, ...] = (information("traffic", value),)
    if more == " climbing through" and "altitude" in value:
        more = " climbing"
    elif more == " climbing through":
        more = ""
    if more == " report in sight":
        items += (Item("report", "traffic in sight"),)
    if more == " maintain visual separation":
        items += (Item("visual_separation"),)
    answers = (
        ("looking for traffic", Item("traffic_not_in_sight", status="report")),
        ("traffic in sight", Item("traffic_in_sight", status="report")),
        ("negative contact", Item("traffic_not_in_sight", status="report")),
    )
    return exchange(s.source("2-1-21", "12.3.1.7"), text + more, items, *answers)


def traffic_gone(s: Scene) -> Exchange:
    """Return the end of a traffic advisory."""
    text = s.pick("clear of traffic", "traffic no factor", "traffic no longer observed")
    return exchange(s.source("2-1-21", "12.4.1.8"), text, information("clear_of_traffic"))


def visual_separation(s: Scene) -> Exchange:
    """Return the order to keep apart by sight."""
    text = s.pick(
        "maintain visual separation",
        "maintain visual separation from that traffic",
        "maintain own separation",
        "maintain own separation and v m c",
        f"visual separation from the {s.rng.choice(names.TRAFFIC_TYPES)} approved",
    )
    return exchange(s.source("7-2-1", "12.3.1.2"), text, Item("visual_separation"), text)


def wake(s: Scene) -> Exchange:
    """Return a caution of wake turbulence."""
    other = s.pick(s.rng.choice(names.TRAFFIC_TYPES), s.other_callsign())
    text = f"caution wake turbulence {s.pick('departing', 'landing', 'following')} {other}"
    return exchange(s.source("2-1-20", "12.3.4.19"), text, information("wake"))


def wind_check(s: Scene) -> Exchange:
    """Return the wind alone."""
    words, item = wind(s)
    return exchange(s.source("2-6-6", "12.3.1.8"), words, item)


def atis(s: Scene) -> Exchange:
    """Return the letter of the ATIS."""
    letter = s.rng.choice("ABCDEFGHIJKLMNOPQRSTUVWXYZ")
    said = s.say.letter(letter)
    text = s.pick(
        f"information {said} is current",
        f"advise you have information {said}",
        f"information {said} now current",
        f"{s.city} information {said} is current",
    )
    return exchange(
        s.source("2-9-2", "12.3.1.11"), text, information("atis", letter), f"we have {said}"
    )


def low_altitude(s: Scene) -> Exchange:
    """Return an alert of terrain (2-1-6)."""
    text = "low altitude alert check your altitude immediately"
    items = (information("low_altitude_alert"),)
    if s.chance(0.5):
        return exchange("FAA JO 7110.65 2-1-6", text, items)
    altitude_ft = s.low_ft()
    order = f"climb and maintain {s.say.altitude(altitude_ft)}"
    item = Item("altitude", altitude_ft, "ft", "now", "climb")
    return exchange("FAA JO 7110.65 2-1-6", f"{text} {order}", (*items, item), (order, item))


def report_when(s: Scene) -> Exchange:
    """Return the order to report an event, which does not order the event."""
    words = s.say.vertical(s.altitude_ft())[0]
    fix = s.fix()
    runway, _ = s.runway()
    what = s.pick(
        "established",
        "field in sight",
        "the airport in sight",
        f"passing {words}",
        f"leaving {words}",
        f"reaching {words}",
        f"{s.say.count(s.rng.randint(2, 8))} mile final",
        f"passing {fix}",
        "runway vacated",
        f"established on the localizer {runway}",
        "ready to copy",
        "left base",
        "procedure turn inbound",
    )
    text = f"report {what}"
    return exchange(
        s.source("4-5-7", "12.3.1.10"),
        text,
        Item("report", what),
        text,
        f"will report {what}",
        ("wilco", report("wilco")),
    )


def correction_of_readback(s: Scene) -> Exchange:
    """Return a correction of what a pilot read back (2-4-3; Annex 10 volume II 5.2.1.9.2.6)."""
    words, value, unit = s.say.vertical(s.altitude_ft())
    heading_deg = s.heading_deg()
    khz = s.khz()
    heading, frequency = s.say.heading(heading_deg), s.say.frequency(khz)
    text, item = s.deal(
        "correction_of_readback",
        (f"negative maintain {words}", Item("altitude", value, unit, "now", "maintain")),
        (f"negative i say again heading {heading}", Item("heading", heading_deg, "deg")),
        (f"negative frequency is {frequency}", Item("frequency", khz, "kHz")),
        (f"verify assigned altitude {words}", Item("altitude", value, unit, "information")),
    )
    return exchange(s.source("2-4-3", "12.2.9"), text, item, text.removeprefix("negative "))


def words_of_procedure(s: Scene) -> Exchange:
    """Return a word of Annex 10 volume II 5.2.1.5.8 that has no value."""
    kind, text = s.deal(
        "words_of_procedure",
        ("say_again", "say again"),
        ("say_again", "say again all after heading"),
        ("standby", "stand by"),
        ("standby", "standby"),
        ("readback_correct", "readback correct"),
        ("readback_correct", s.pick("that is correct", "readback is correct")),
        ("unable", "unable"),
        ("unable", "unable due traffic"),
        ("disregard", "disregard"),
        ("affirm", s.pick("affirm", "affirmative")),
        ("negative", "negative"),
    )
    status = "information" if kind in ("roger", "affirm", "readback_correct") else "now"
    item = information(kind) if status == "information" else Item(kind)
    return exchange(s.source("2-4-9", "12.2.9"), text, item)
