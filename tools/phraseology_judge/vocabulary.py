"""The kinds of items, in words of ICAO and the FAA, with what their values are."""

from __future__ import annotations

KINDS = {
    line.split(" | ")[0].strip(): line.split(" | ")[1].strip()
    for line in """
altitude | a level in "ft" or "FL"; manner: climb, descend, maintain, stop, at_or_below, ...
altitude_passing | a level passed, left or reached, in "ft" or "FL"
block_altitude | levels low and high, in "ft" or "FL"
vertical_rate | a rate in "ft/min"; manner: or_greater, or_less
crossing_restriction | fix, relation (at, at_or_above, at_or_below), altitude, speed_kt
climb_via | the name of a departure; None for "climb via sid"
descend_via | the name of an arrival; None for "descend via star"
expedite | no value; manner: climb or descend
immediately | no value: the call says "immediately"
heading | a heading in "deg"; manner: left or right where a turn was said
turn_by | a number of degrees to turn; manner: left or right
present_heading | no value
runway_heading | no value
direct | a fix
own_navigation | no value: vectors end
vectors | no value
hold | a fix; manner: the side of the turns
orbit | no value; manner: left or right
deviation | degrees or "NM", where said; manner: left or right
intercept | course and runway
departure | the name of a standard departure
clearance_limit | an airport
airspace | a class; manner: enter or remain_outside
speed | an indicated speed in "kt"; manner: reduce, increase, maintain, or_greater, or_less
named_speed | a speed without a number, such as "minimum clean"
resume_speed | "normal" or "published"
no_speed_restrictions | no value
mach | a mach number
approach | type (ILS, LOC, LOC BC, VOR, NDB, RNAV, RNP, GPS, VISUAL), runway, variant, or None
circle | a runway to circle to
cancel_approach | no value
missed_approach | no value
go_around | no value
takeoff | a runway, or None where it was not said
cancel_takeoff | no value: the take-off has not begun
cancel_landing | no value: a clearance to land is taken back
rejected_takeoff | no value: the pilot stops
stop | no value: the take-off roll has begun
landing | a runway, or None where it was not said
option | a runway, or None
touch_and_go | a runway, or None
stop_and_go | a runway
low_approach | a runway
line_up_and_wait | a runway, or None
continue_approach | a runway, or None
circuit | a runway, or None; manner: the leg or side
sequence | the number in the landing sequence
follow | no value: another aircraft is to be followed
hold_short | a runway or taxiway
hold_position | no value
cross_runway | a runway
taxi | to (a runway or stand) and via (taxiways)
continue_taxi | no value
backtrack | a runway
vacate_runway | a taxiway; manner: left or right
give_way | no value
pushback | no value
startup | no value
hold_for_release | no value
time_limit | a time in "UTC"; manner: clearance_void, departure, further_clearance
frequency | "kHz", or a unit without number; manner: contact, monitor, change
remain_on_frequency | no value
frequency_change_approved | no value
radar_contact | no value
radar_contact_lost | no value
radar_service_terminated | no value
squawk | four digits
ident | no value
transponder | a mode: standby, altitude, charlie, stop, reset, confirm
altimeter | a setting in "inHg" or "hPa"
wind | direction_deg, speed_kt, gust_kt, or "calm"
atis | a letter
weather | what the pilot says
runway_state | runway and state
traffic | oclock, distance_nm, altitude and unit, or a position
clear_of_traffic | no value
wildlife | a runway, or None; animals or birds on it or near it, whoever tells of them
wildlife_gone | a runway, or None
traffic_alert | no value
low_altitude_alert | no value
visual_separation | no value
wake | no value
position | fix and distance_nm, or words
report | the words of what is to be reported
state | what is to be stated at once
established | a runway
runway_vacated | a runway, or None
ready_for_departure | a runway, or None
traffic_in_sight | no value
traffic_not_in_sight | no value
field_in_sight | no value
tcas_ra | no value
clear_of_conflict | no value
unable | what the pilot or controller cannot do, or None
mayday | the trouble
pan_pan | the trouble
emergency | the trouble, or None
minimum_fuel | no value
service | "cancel ifr" or "flight following"
disregard | no value
say_again | no value
standby | no value
readback_correct | no value
roger | no value
wilco | no value
affirm | no value
negative | no value
""".strip().splitlines()
}
"""Meaning of the value of each kind."""
BY_HAND = frozenset({"cancel_landing", "wildlife", "wildlife_gone"})
"""Kinds that only calls written by hand have: seeds give the calls that they always gave."""
