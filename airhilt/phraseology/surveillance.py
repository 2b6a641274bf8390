"""Forms of frequencies, transponders and reports.

FAA Order JO 7110.65, 2-1-17, 5-2, 5-3, 7-2; ICAO Doc 4444, 12.3.1.4, 12.4.3.
"""

from __future__ import annotations

import re

from airhilt.phraseology.call import Action, Instruction
from airhilt.phraseology.forms import (
    BARE_VALUE,
    DEPARTED,
    LONG_NAME,
    NO_VALUE,
    UNIT,
    UNITS,
    Form,
    Listed,
    Read,
    Segment,
    alone,
    nothing,
)
from airhilt.phraseology.slots import (
    DIGITS_GO_ON,
    FIX,
    FIX_ENDS,
    FREQUENCY,
    GROUND_MHZ,
    LETTER,
    LEVEL_WORDS,
    SHORT_FREQUENCY,
    SHORTENED,
    frequency_khz,
)

VFR_CODE = "1200"
"""Code of flights under visual rules in the United States (FAA Order JO 7110.65, 5-2-7)."""
_STATION = rf"(?: (?:[a-z]+ ){{0,3}}?(?:{UNIT})(?!\S))"


def squawk(segment: Segment, action: Action) -> Read | None:
    """Read a transponder code."""
    parts = segment.found.groupdict()
    code = parts.get("code") or VFR_CODE
    if parts.get("thousands"):
        code = f"{parts['thousands']}000"
    return Read(Instruction(action, squawk=code), segment.start, segment.found.end())


def contact(segment: Segment, action: Action) -> Read | None:
    """Read a change of frequency: its station, its frequency, or both."""
    station = segment.found["station"] or segment.found.groupdict().get("unit")
    station = station.strip() if station else None
    after = segment.after
    full, joined = FREQUENCY.search(after), _ON_JOINED.match(after)
    without_hundred = (
        _SHORT_JOINED.match(after) if station or _BY_NUMBER.match(segment.found[0]) else None
    )
    short = SHORT_FREQUENCY.search(after) if station and "ground" in station else None
    if short and any(sign.isdigit() for sign in after[: short.start()]):
        short = None
    khz, confidence, found = None, NO_VALUE, None
    if full:
        is_cut = DIGITS_GO_ON.match(after, full.end())
        confidence = NO_VALUE if is_cut else 1.0
        khz, found = frequency_khz(full[1], full[2]), full
    elif short:
        khz, confidence, found = frequency_khz(GROUND_MHZ, short[1]), BARE_VALUE, short
    elif joined:
        khz, confidence, found = frequency_khz(joined[1], joined[2]), BARE_VALUE, joined
    elif without_hundred:
        mhz, fraction = without_hundred.groups()
        sure = BARE_VALUE if station else SHORTENED
        khz, confidence, found = frequency_khz(f"1{mhz}", fraction), sure, without_hundred
    if station is None and khz is None:
        return None
    is_known = action == "contact" and _IS_KNOWN.match(segment.text, segment.found.end())
    read = Instruction(
        action,
        position=station,
        frequency_khz=khz,
        confidence=confidence if khz else BARE_VALUE if is_known else NO_VALUE,
    )
    end = found.end() if found else 0
    return Read(read, segment.start, segment.found.end() + end)


_NO_FREQUENCY = r"(?!\S)(?! (?:left|right|centre|knots|miles?|degrees|thousand|feet|oclock))"
_IS_KNOWN = re.compile(r" ?(?:\||$|#|(?:when|once|on the|now|good|then|and)(?!\S))")
"""Words behind a unit whose frequency the pilot knows (FAA Order JO 7110.65, 2-1-17)."""
_BY_NUMBER = re.compile(r"(?:contact|monitor)(?:ing)?$")
_SHORT_JOINED = re.compile(
    rf" (?:on |at |frequency )*(1[89]|2[0-9]|3[0-6])(?: decimal )?([0-9]{{1,3}}){_NO_FREQUENCY}"
)
"""A frequency without its first digit, which is always 1: "tower eighteen three"."""
_ON_JOINED = re.compile(r" (?:on |at |now |frequency |#+ )*(1[1-3][0-9])([0-9]{1,3})(?!\S)")


_DELIVERED = re.compile(r"(?<!\S)(?:squawk [0-7]{4}|as filed|class [a-z]+ airspace)(?!\S)")
"""Words of a clearance before departure."""
_TOLD = re.compile(r"(?<!\S)(?:frequency|is|be)(?!\S)")
_DEPARTURE_TOLD = re.compile(
    r"(?<!contact )(?<!monitor )departure (?:frequency|is|will be)(?: is| will be)?$"
)
"""A frequency that is told for the flight after departure (FAA Order JO 7110.65, 4-3-2 e)."""


def frequency(segment: Segment, action: Action) -> Read | None:
    """Read a frequency that is given or read back, alone or after its station."""
    khz = frequency_khz(segment.found[1], segment.found[2])
    if khz is None:
        return None
    station = re.search(
        rf"(?<!\S)(?:(?!airspace )[a-z]+ )?(?:{UNIT})(?: on| frequency| is| will be)*$",
        segment.before,
    )
    name = re.sub(r"(?: (?:on|frequency|is|will|be))+$", "", station[0]) if station else None
    is_cut = DIGITS_GO_ON.match(segment.text, segment.found.end())
    confidence = NO_VALUE if is_cut else BARE_VALUE
    is_told = bool(
        station and _DEPARTURE_TOLD.search(segment.before) and _DELIVERED.search(segment.text)
    )
    read = Instruction(
        action, position=name, condition=DEPARTED if is_told else None, frequency_khz=khz,
        confidence=confidence,
    )  # fmt: skip
    return Read(read, segment.begin + station.start() if station else segment.start,
                segment.found.end())  # fmt: skip


def station_frequency(segment: Segment, action: Action) -> Read | None:
    """Read a station with its frequency, whose decimal point was not said."""
    found = segment.found
    if found["fraction"]:
        mhz, fraction = GROUND_MHZ, found["fraction"]
    elif found["short"]:
        mhz, fraction = f"1{found['short'][:2]}", found["short"][2:]
    else:
        mhz, fraction = found["mhz"], found["khz"]
    khz = frequency_khz(mhz, fraction)
    if khz is None:
        return None
    confidence = BARE_VALUE if found["fraction"] or found["unit"] == "frequency" else SHORTENED
    unit = None if found["unit"] == "frequency" else found["unit"]
    is_told = (
        unit == "departure"
        and _TOLD.search(found["told"]) is not None
        and _DELIVERED.search(segment.text) is not None
    )
    read = Instruction(
        action, position=unit, condition=DEPARTED if is_told else None, frequency_khz=khz,
        confidence=confidence,
    )  # fmt: skip
    return Read(read, segment.start, found.end())


def hold_on(segment: Segment, action: Action) -> Read | None:
    """Read "hold on", which asks to wait for a call, in words of no phraseology."""
    read = Instruction(action, confidence=LONG_NAME)
    return Read(read, segment.start, segment.found.end())


def report(segment: Segment, action: Action) -> Read | None:
    """Read what is to be reported, in words."""
    event = segment.found["event"]
    other = segment.found.groupdict().get("other")
    if event is None and other is None:  # The event stands before it.
        return Read(Instruction(action), segment.start, segment.found.end())
    what = (event or other or "").strip()
    if _SEEN.fullmatch(what):
        is_field = _FIELD.search(segment.before_all) is not None
        what = "field in sight" if is_field else "traffic in sight"
    is_whole = _EVENT_ENDS.match(segment.text, segment.found.end()) is not None
    is_whole = is_whole and _SHORT_LEVEL.search(what) is None
    is_named = event is not None and is_whole and not event.startswith("when")
    read = Instruction(action, position=what, confidence=1.0 if is_named else LONG_NAME)
    return Read(read, segment.start, segment.found.end())


_SHORT_LEVEL = re.compile(r"level [0-9]{1,2}$")
_SEEN = re.compile(r"(?:it|him|them|that|that one|that traffic) in sight")
_EVENT_ENDS = re.compile(rf"$| (?:\||#|runway|for|{FIX_ENDS})")
_FIELD = re.compile(r"(?<!\S)(?:field|airport|aerodrome|airfield)(?!\S)")
_NAMED_RUNWAY = r"(?: runway [0-9]{1,2}(?: (?:left|right|centre|l|r|c))?(?! cleared))?"
_LEG = r"(?:short |long |left |right )?(?:final|downwind|base|crosswind|upwind)"
_EVENT = (
    rf"(?:(?:fully )?established(?: on the (?:localizer|localiser|glide path|ils|i l s"
    r"|downwind|final|missed approach|approach))?"
    rf"{_NAMED_RUNWAY}|(?:the )?(?:field|airport|aerodrome|runway|traffic|it|him|them|that traffic)"
    r" in sight"
    rf"|in sight|(?:before )?turning (?:left |right )?(?:base|final|downwind|crosswind)"
    rf"|(?:passing|leaving|reaching|through|level|over|crossing|at) "
    rf"(?:the )?(?:{LEVEL_WORDS}|{FIX})|[0-9]{{1,2}} miles? (?:final|out)(?! extend)"
    r"|(?:runway )?vacated|clear(?: of (?:the )?(?:runway|traffic|weather|conflict)(?! [0-9]))?"
    r"|lined up"
    r"|ready(?: (?:to|for) (?:the )?[a-z]+)?|complete|abeam (?:the )?[a-z]+"
    r"|(?:leaving|entering) the [a-z]+"
    r"|(?:new )?(?:heading|speed|altitude|level|position)"
    rf"|(?:on |midfield )?{_LEG}|on (?:the )?(?:missed approach|stand|frequency)"
    r"|procedure turn inbound|airborne)(?!\S)"
)
_OTHER = (
    rf"(?:(?!(?:(?:the|your|an?) )?{FIX_ENDS}(?!\S)|\|)[a-z]+"
    rf"(?: (?!{FIX_ENDS}(?!\S))[a-z]+){{0,2}})"
)

FORMS: Listed = (
    ("squawk squawking", "squawk", r"squawk(?:ing)?(?: number)? (?P<code>[0-7]{4})", squawk),
    ("squawk squawking", "squawk", r"squawk(?:ing)? (?P<thousands>[0-7]) thousand", squawk),
    ("squawk squawking", "squawk", r"squawk(?:ing)? (?:v f r|vfr)", squawk),
    ("squawk squawking", "ident", r"squawk(?:ing)? ident", alone),
    ("squawk code", "squawk", r"(?<!your )(?:squawk|code) is (?P<code>[0-7]{4})", squawk),
    ("squawk", "squawk", r"squawk(?: (?:standby|stand by|altitude|charlie|low|normal|mayday))?",
     nothing),
    ("ident", "ident", r"ident", alone),
    ("stop", "squawk", r"stop squawk", nothing),
    ("advise call let tell", "report",
     rf"(?:advise|call|let|tell)(?: me| us)?(?: know)?(?: (?:when|once)(?: you are| you have)?|"
     rf"(?= ready| [a-z ]+ in sight)) (?P<event>{_EVENT})", report),
    ("contact contacting call try", "contact",
     r"(?:contact(?:ing)?|call|try)"
     rf"(?P<station>(?: (?!(?:{FIX_ENDS}|me|my|frequency)(?!\S))[a-z]+){{1,2}}|)"
     r"(?= (?:on |now )?1[1-3][0-9](?: decimal|[0-9]))", contact),
    ("give giving", "contact", rf"giv(?:e|ing)(?P<station>{_STATION}) a call(?: on)?", contact),
    ("contact contacting call try", "contact",
     rf"(?:contact(?:ing)?|call|try)(?! me(?!\S))(?P<station>{_STATION})?", contact),
    ("go going", "contact", rf"go(?:ing)?(?: over)? to(?: the)?(?P<station>{_STATION})", contact),
    ("over switch switching change changing", "contact",
     rf"(?:over(?! the(?!\S))|switch(?:ing)?|chang(?:e|ing)(?! in))"
     r"(?: over)?(?: to)?(?: my| frequency)*"
     rf"(?P<station>{_STATION})?", contact),
    ("monitor monitoring", "monitor", rf"monitor(?:ing)?(?P<station>{_STATION})?", contact),
    (" ".join((*UNITS, "frequency")), "contact",
     rf"(?P<unit>{UNIT}|frequency)(?P<told>(?: frequency| on| is| will be)*) "
     r"(?:(?P<mhz>1[1-3][0-9])(?P<khz>[0-9]{1,3})(?!\S)"
     r"|(?<=ground )decimal (?P<fraction>[0-9]{1,3})"
     rf"|(?P<short>(?:1[89]|2[0-9]|3[0-6])[0-9]{{1,3}}){_NO_FREQUENCY})",
     station_frequency),
    ("stand standby", "monitor",
     rf"stand ?by(?: (?:for|on)(?P<station>{_STATION})|(?P<unit> (?:{UNIT})(?!\S)))", contact),
    ("hold", "stand_by", rf"hold on(?! (?:the|to|taxiway|stand|gate|{LETTER})(?!\S))", hold_on),
    ("stand standby", "stand_by",
     r"stand ?by(?! (?:this|on)(?!\S)| for (?!(?:your |a )?(?:clearance|push|start)))",
     alone),
    ("maintain maintaining", "visual_separation",
     r"maintain(?:ing)? (?:(?:visual|your own|own) separation"
     r"|visual(?= \||$| cleared| from))", alone),
    ("visual", "visual_separation", r"visual separation(?=.* approved)", alone),
    ("report", "report",
     r"(?<!wildlife )(?<!ride )(?:(?<!position )|(?<=hold position ))"
     r"(?<!(?<!\S)a )(?<!pilot )(?<!bird )(?<!weather )"
     rf"report (?:(?:when|once|after) (?:you are |you )?|your |the (?=heading|speed|level))?"
     rf"(?:(?P<event>{_EVENT})|(?P<other>{_OTHER}))", report),
    ("report advise call let tell", "report",
     r"(?:report|advise(?: me)?|call(?: me)?|let me know|tell me)(?P<event>(?!))?"
     r"(?= \||$)", report),
    ("advise", "report",
     rf"advise (?P<event>when (?:able|you can)(?:(?: take| for)?"
     rf" (?:direct(?: to)? {FIX}|higher|lower))?)", report),
)  # fmt: skip
"""Forms of frequencies, transponders and reports."""
FREQUENCY_FORM = Form("contact", FREQUENCY, frequency)
"""Form of a frequency without an action."""
