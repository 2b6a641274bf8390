"""Calls that pilots make unasked: first calls, reports, requests, emergencies.

FAA AIM 4-2-3 ("Contact procedures"), 5-3-1, 5-3-3, 6-3-1; ICAO Doc 4444 12.3 (phrases marked with
an asterisk), Doc 9432 chapters 4 to 9.
"""

from __future__ import annotations

from . import names
from .approaches import named
from .model import Item, Phrase, report, request
from .scene import Scene


def _source(s: Scene, aim: str, icao: str) -> str:
    return f"FAA AIM {aim}" if s.is_faa else f"ICAO {icao}"


def check_in(s: Scene) -> Phrase:
    """Return a first call in flight: the level passed, the level cleared, the ATIS sometimes."""
    first_ft, second_ft = s.altitude_ft(), s.altitude_ft()
    if first_ft == second_ft:
        second_ft += 1000
    manner, going = ("climb", "climbing") if second_ft > first_ft else ("descend", "descending")
    now_words, now, now_unit = s.say.vertical(first_ft)
    words, value, unit = s.say.vertical(second_ft)
    passing = report("altitude_passing", now, now_unit)
    going_to = report("altitude", value, unit, manner=manner)
    heading_deg, speed_kt, procedure = s.heading_deg(), s.speed_kt(), s.procedure()
    heading = f"heading {s.say.heading(heading_deg)}"
    text, items = s.deal(
        "check_in",
        (f"with you level {words}", (report("altitude", value, unit, manner="level"),)),
        (f"{words}", (report("altitude", value, unit),)),
        (f"passing {now_words} {going} {words}", (passing, going_to)),
        (f"with you {now_words} {going} to {words}", (passing, going_to)),
        (f"leaving {now_words} for {words}", (passing, report("altitude", value, unit))),
        (f"{now_words} for {words}", (passing, report("altitude", value, unit))),
        (
            f"maintaining {words} {heading}",
            (
                report("altitude", value, unit, manner="maintain"),
                report("heading", heading_deg, "deg"),
            ),
        ),
        (
            f"with you at {words} assigned {heading}",
            (
                report("altitude", value, unit),
                report("heading", heading_deg, "deg"),
            ),
        ),
        (
            f"{words} assigned speed {s.say.speed(speed_kt)}",
            (
                report("altitude", value, unit),
                report("speed", speed_kt, "kt"),
            ),
        ),
        (f"descending via the {procedure} arrival", (report("descend_via", procedure),)),
    )
    items = tuple(items)
    if s.chance(0.35):
        letter = s.rng.choice("ABCDEFGHIKLMNOPQRSTUVWYZ")
        text += f" {s.pick('with ', '')}information {s.say.letter(letter)}"
        items += (report("atis", letter),)
    return Phrase(text, items, _source(s, "5-3-1", "Doc 4444 12.3.1.9"))


def level_report(s: Scene) -> Phrase:
    """Return a level reached, left or passed."""
    words, value, unit = s.say.vertical(s.altitude_ft())
    text, kind = s.deal(
        "level_report",
        (f"leaving {words}", "altitude_passing"),
        (f"passing {words}", "altitude_passing"),
        (f"reaching {words}", "altitude_passing"),
        (f"level {words}", "altitude"),
        (f"maintaining {words}", "altitude"),
    )
    return Phrase(text, (report(kind, value, unit),), _source(s, "5-3-3", "Doc 4444 12.3.1.2"))


def position_report(s: Scene) -> Phrase:
    """Return a place on the route, final or aerodrome."""
    runway, ident = s.runway()
    miles, fix = s.rng.randint(2, 12), s.fix()
    text, item = s.deal(
        "position_report",
        (f"{s.say.count(miles)} mile final {runway}", report("position", "final")),
        (f"left downwind {runway}", report("position", "left downwind")),
        (f"right base {runway}", report("position", "right base")),
        (f"established on the localizer {runway}", report("established", ident)),
        (f"established ils {runway}", report("established", ident)),
        (f"fully established {runway}", report("established", ident)),
        (f"over {fix}", report("position", fix)),
        ("outer marker", report("position", "outer marker")),
        (f"clear of {runway}", report("runway_vacated", ident)),
        (f"{runway} vacated", report("runway_vacated", ident)),
        ("runway vacated", report("runway_vacated")),
        (f"holding short of {runway}", report("hold_short", ident)),
        (f"holding at {fix}", report("hold", fix)),
        ("airborne", report("position", "airborne")),
    )
    return Phrase(text, (item,), _source(s, "4-2-3", "Doc 4444 12.3.4.14"))


def sight(s: Scene) -> Phrase:
    """Return something seen or not seen."""
    text, kind = s.deal(
        "sight",
        ("traffic in sight", "traffic_in_sight"),
        ("we have the traffic in sight", "traffic_in_sight"),
        ("negative contact looking", "traffic_not_in_sight"),
        ("field in sight", "field_in_sight"),
        ("airport in sight", "field_in_sight"),
        ("runway in sight", "field_in_sight"),
        ("we have him on t cas", "traffic_not_in_sight"),
    )
    return Phrase(text, (report(kind),), _source(s, "5-5-10", "Doc 4444 12.3.1.7"))


def ready(s: Scene) -> Phrase:
    """Return readiness to depart, which clears for nothing."""
    runway, ident = s.runway()
    holding = (report("ready_for_departure", ident), report("hold_short", ident))
    text, items = s.deal(
        "ready",
        (f"ready for departure {runway}", holding[:1]),
        (f"holding short {runway} ready for takeoff", holding),
        (f"ready to go {runway}", holding[:1]),
        ("fully ready", (report("ready_for_departure"),)),
        ("ready for departure", (report("ready_for_departure"),)),
    )
    return Phrase(text, items, _source(s, "4-3-14", "Doc 4444 12.3.4.10"))


def level_request(s: Scene) -> Phrase:
    """Return a wish for a level."""
    words, value, unit = s.say.vertical(s.altitude_ft())
    manner = s.pick("climb", "descend", None)
    verb = f"{ {'climb': 'climb', 'descend': 'descent'}[manner] } to " if manner else ""
    text = s.pick(f"request {verb}{words}", f"requesting {verb}{words}", f"we'd like {verb}{words}")
    item = request("altitude", value, unit, manner=manner)
    return Phrase(text, (item,), _source(s, "4-2-3", "Doc 4444 12.3.1.2"))


def lateral_request(s: Scene) -> Phrase:
    """Return a wish for a direct, a heading or a deviation."""
    fix, heading_deg = s.fix(), s.heading_deg()
    side = s.pick("left", "right")
    degrees = s.pick(10, 15, 20, 30)
    text, item = s.deal(
        "lateral_request",
        (f"request direct {fix}", request("direct", fix)),
        (f"any chance of direct {fix}", request("direct", fix)),
        (f"request heading {s.say.heading(heading_deg)}", request("heading", heading_deg, "deg")),
        (
            f"request {s.say.count(degrees)} degrees {side} for weather",
            request("deviation", degrees, "deg", manner=side),
        ),
        (
            f"request deviation {s.say.count(degrees)} miles {side} of track due weather",
            request("deviation", degrees, "NM", manner=side),
        ),
        ("request vectors", request("vectors")),
    )
    return Phrase(text, (item,), _source(s, "7-1-12", "Doc 4444 12.4.1.3"))


def approach_request(s: Scene) -> Phrase:
    """Return a wish for an approach, a circuit or a clearance of the runway."""
    words, value = named(s)
    runway, ident = s.runway()
    text, item = s.deal(
        "approach_request",
        (f"request {words}", request("approach", value)),
        (f"request the {words} approach", request("approach", value)),
        (
            f"request visual approach {runway}",
            request("approach", {"type": "VISUAL", "runway": ident}),
        ),
        (f"inbound for landing {runway}", request("landing", ident)),
        ("request touch and go", request("touch_and_go")),
        ("request the option", request("option")),
        (f"confirm cleared to land {runway}", request("landing", ident)),
        (f"are we cleared for takeoff {runway}", request("takeoff", ident)),
        ("confirm line up", request("line_up_and_wait")),
        (f"request straight in {runway}", request("circuit", ident, manner="straight in")),
    )
    return Phrase(text, (item,), _source(s, "4-3-2", "Doc 4444 12.3.4.15"))


def ground_request(s: Scene) -> Phrase:
    """Return a wish on the ground."""
    stand = s.say.maybe_group(f"{s.rng.randint(1, 60)}")
    runway, ident = s.runway()
    letter = s.rng.choice("ABCDEFGHIKLMNOPQRSTUVWYZ")
    text, item = s.deal(
        "ground_request",
        (f"gate {stand} request pushback", request("pushback")),
        (f"stand {stand} ready to push", request("pushback")),
        (f"stand {stand} request start up", request("startup")),
        (f"at the ramp ready to taxi {runway}", request("taxi", {"to": f"runway {ident}"})),
        (f"request taxi {runway}", request("taxi", {"to": f"runway {ident}"})),
        (f"request cross {runway}", request("cross_runway", ident)),
        (f"request i f r clearance to {s.airport()}", request("clearance_limit")),
        (f"request backtrack {runway}", request("backtrack", ident)),
    )
    items: tuple[Item, ...] = (item,)
    if s.chance(0.3):
        text += f" with {s.say.letter(letter)}"
        items += (report("atis", letter),)
    return Phrase(text, items, _source(s, "4-3-18", "Doc 4444 12.3.4.7"))


def other_request(s: Scene) -> Phrase:
    """Return a question or a wish about the service."""
    text, kind, *value = s.deal(
        "other_request",
        ("request frequency change", "frequency_change_approved"),
        ("wind check", "wind"),
        ("say again", "say_again"),
        ("say again the heading", "say_again"),
        ("say altimeter", "altimeter"),
        ("confirm squawk", "squawk"),
        ("what was the frequency again", "frequency"),
        ("request speed at our discretion", "no_speed_restrictions"),
        ("cancel i f r", "service", "cancel ifr"),
        ("request flight following", "service", "flight following"),
    )
    return Phrase(
        text, (request(kind, *value),), _source(s, "4-2-3", "Annex 10 volume II 5.2.1.5.8")
    )


def own_go_around(s: Scene) -> Phrase:
    """Return a go-around that the pilot decides."""
    text, kind = s.deal(
        "own_go_around",
        ("going around", "go_around"),
        ("we're going around", "go_around"),
        ("missed approach", "missed_approach"),
        ("on the missed", "missed_approach"),
        ("executing missed approach", "missed_approach"),
        ("rejecting takeoff", "rejected_takeoff"),
        ("stopping", "rejected_takeoff"),
    )
    return Phrase(text, (report(kind),), _source(s, "5-4-21", "Doc 4444 12.3.4.18"))


def resolution(s: Scene) -> Phrase:
    """Return a resolution advisory of TCAS or its end (Doc 4444 12.3.1.2 r to y)."""
    words, value, unit = s.say.vertical(s.altitude_ft())
    text, items = s.deal(
        "resolution",
        ("t cas r a", (report("tcas_ra"),)),
        ("tcas ra", (report("tcas_ra"),)),
        ("unable t cas r a", (report("unable"), report("tcas_ra"))),
        (
            f"clear of conflict returning to clearance now maintaining {words}",
            (report("clear_of_conflict"), report("altitude", value, unit, manner="maintain")),
        ),
        ("clear of conflict returning to clearance", (report("clear_of_conflict"),)),
    )
    return Phrase(text, tuple(items), "ICAO Doc 4444 12.3.1.2")


def distress(s: Scene) -> Phrase:
    """Return a call of distress or urgency, or a state of fuel."""
    trouble = s.pick(
        "engine failure",
        "engine fire",
        "smoke in the cockpit",
        "medical emergency",
        "low on fuel",
        "loss of pressurization",
        "landing gear problem",
        "bird strike",
    )
    words, value, unit = s.say.vertical(s.altitude_ft())
    call = s.callsign()
    heading_deg = s.heading_deg()
    heading = s.say.heading(heading_deg)
    down = report("altitude", value, unit, manner="descend")
    text, items = s.deal(
        "distress",
        (
            f"mayday mayday mayday {call} {trouble} descending {words}",
            (report("mayday", trouble), down),
        ),
        (f"mayday mayday mayday {call} {trouble}", (report("mayday", trouble),)),
        (f"pan pan pan pan pan pan {call} {trouble}", (report("pan_pan", trouble),)),
        (
            f"pan pan pan pan pan pan {call} {trouble} request heading {heading}",
            (report("pan_pan", trouble), request("heading", heading_deg, "deg")),
        ),
        (f"{call} declaring an emergency {trouble}", (report("emergency", trouble),)),
        (f"{call} we're declaring an emergency", (report("emergency"),)),
        (f"{call} minimum fuel", (report("minimum_fuel"),)),
        (f"be advised {call} is minimum fuel", (report("minimum_fuel"),)),
        ("mayday fuel " + call, (report("mayday", "fuel"),)),
    )
    return Phrase(text, tuple(items), _source(s, "6-3-1", "Doc 9432 9.2"))


def unable(s: Scene) -> Phrase:
    """Return what the pilot cannot do; the numbers in it are no clearance."""
    words = s.say.vertical(s.altitude_ft())[0]
    speed_kt = s.speed_kt()
    runway, _ = s.runway()
    text, what = s.deal(
        "unable",
        (f"unable {words}", "altitude"),
        ("unable", None),
        (f"unable {s.say.speed(speed_kt)} knots", "speed"),
        ("unable due weather", None),
        (f"unable {runway}", "runway"),
        ("unable r v s m due turbulence", "rvsm"),
        ("negative unable line up", "line_up_and_wait"),
    )
    return Phrase(text, (report("unable", what),), _source(s, "4-2-3", "Doc 4444 12.2.9"))


def weather(s: Scene) -> Phrase:
    """Return a report of weather."""
    words, _, _ = s.say.vertical(s.altitude_ft())
    kind = s.rng.choice(names.TRAFFIC_TYPES)
    text = s.pick(
        f"light chop at {words}",
        f"moderate turbulence passing {words}",
        f"braking action good {kind}",
        f"tops at {words}",
        f"light rime icing {words}",
    )
    return Phrase(text, (report("weather", text),), _source(s, "7-1-17", "Doc 4444 12.3.1.10"))


def acknowledgement(s: Scene) -> Phrase:
    """Return an answer without a readback."""
    text, kind = s.deal(
        "acknowledgement",
        ("roger", "roger"),
        ("wilco", "wilco"),
        ("copied", "roger"),
        ("affirmative", "affirm"),
        ("affirm", "affirm"),
        ("negative", "negative"),
        ("stand by", "standby"),
    )
    item = Item(kind, status="report")
    return Phrase(text, (item,), _source(s, "4-2-3", "Annex 10 volume II 5.2.1.5.8"))
