"""Each instruction has the words that the FAA and ICAO give it."""

from __future__ import annotations

from typing import get_args

import pytest

from airhilt.phraseology import Action, Instruction
from airhilt.phraseology.spoken_actions import phrase_of

I = Instruction  # noqa: E741

SPOKEN: list[tuple[Instruction, str, str]] = [
    # The runway is said before a clearance (FAA Order JO 7110.65, 3-9-9 and 3-10-5).
    (I("cleared_to_land", "01"), "runway one, cleared to land", "runway zero one, cleared to land"),
    (I("cleared_to_land"), "cleared to land", "cleared to land"),
    (
        I("cleared_for_takeoff", "19L", "B5"),
        "runway one niner left at bravo five, cleared for takeoff",
        "runway one niner left at bravo fife, cleared for takeoff",
    ),
    (
        I("cleared_for_takeoff", "19", immediate=True),
        "runway one niner, cleared for immediate takeoff",
        "runway one niner, cleared for immediate takeoff",
    ),
    (I("line_up", "01"), "runway one, line up and wait", "runway zero one, line up and wait"),
    (
        I("line_up", "01", condition="behind the landing 737"),
        "behind the landing seven three seven, runway one, line up and wait",
        "behind the landing seven tree seven, runway zero one, line up and wait",
    ),
    (I("touch_and_go"), "cleared touch and go", "cleared touch and go"),
    (I("stop_and_go"), "cleared stop and go", "cleared stop and go"),
    (I("low_approach"), "cleared low approach", "cleared low approach"),
    (I("cleared_option"), "cleared for the option", "cleared for the option"),
    # On the ground (3-7-2).
    (
        I("hold_short", "01", "E"),
        "hold short of runway one at echo",
        "hold short of runway zero one at echo",
    ),
    (I("hold_short", hold_short="B5"), "hold short of bravo five", "hold short of bravo fife"),
    (I("hold_short"), "hold short", "hold short"),
    (I("hold_position"), "hold position", "hold position"),
    (
        I("cross", "15", "M", immediate=True),
        "cross runway one five at mike without delay",
        "cross runway one fife at mike without delay",
    ),
    (I("proceed", "15"), "proceed onto runway one five", "proceed onto runway one fife"),
    (I("backtrack", "15"), "backtrack runway one five", "backtrack runway one fife"),
    (I("vacate"), "exit", "vacate"),
    (I("vacate", immediate=True), "expedite exiting", "expedite vacating"),
    (
        I("vacate", "15", "E", turn="left"),
        "exit runway one five to the left at echo",
        "vacate runway one fife to the left at echo",
    ),
    (I("vacate", turn="right"), "exit right", "vacate right"),
    (
        I("taxi", "19", via=("A", "B5")),
        "taxi to runway one niner via alfa, bravo five",
        "taxi to runway one niner via alfa, bravo fife",
    ),
    (I("taxi", position="gate 12"), "taxi to gate one two", "taxi to gate one two"),
    (I("taxi", via=("A",)), "taxi via alfa", "taxi via alfa"),
    (I("stop"), "stop", "stop immediately"),
    (I("push_back"), "push back approved", "push back approved"),
    (I("start_up"), "start up approved", "start up approved"),
    (I("follow", position="company 737"), "follow company seven three seven",
     "follow company seven tree seven"),
    (I("give_way", position="airbus"), "give way to airbus", "give way to airbus"),
    # What ends a clearance (3-9-10 and 3-9-11; ICAO Doc 4444, 12.3.4.11).
    (
        I("cancel_takeoff"),
        "cancel takeoff clearance",
        "cancel takeoff, I say again, cancel takeoff",
    ),
    (I("cancel_landing"), "cancel landing clearance", "cancel landing clearance"),
    (I("cancel_approach"), "cancel approach clearance", "cancel approach clearance"),
    (I("go_around"), "go around", "go around"),
    # Approaches (4-8-1).
    (
        I("cleared_approach", "19", approach="ils"),
        "cleared i l s runway one niner approach",
        "cleared i l s approach runway one niner",
    ),
    (
        I("cleared_approach", "01", approach="rnav", variant="Z"),
        "cleared r nav zulu runway one approach",
        "cleared r nav zulu approach runway zero one",
    ),
    (I("cleared_approach", "01", approach="visual"), "cleared visual approach runway one",
     "cleared visual approach runway zero one"),
    (I("cleared_approach", approach="visual"), "cleared visual approach",
     "cleared visual approach"),
    (I("continue_approach"), "continue approach", "continue approach"),
    (I("missed_approach"), "execute missed approach", "execute missed approach"),
    (I("circle", "04"), "circle to runway four", "circle to runway zero fower"),
    # Levels (4-5-7; ICAO Doc 4444, 12.3.1.2).
    (
        I("altitude", sense="climb", altitude_ft=33_000.0),
        "climb and maintain flight level three three zero",
        "climb to flight level tree tree zero",
    ),
    (
        I("altitude", sense="descend", altitude_ft=4_500.0),
        "descend and maintain four thousand five hundred",
        "descend to fower thousand fife hundred",
    ),
    (
        I("altitude", sense="climb", altitude_ft=9_000.0, immediate=True),
        "expedite climb and maintain niner thousand",
        "expedite climb to niner thousand",
    ),
    (
        I("altitude", sense="descend", altitude_ft=9_000.0, immediate=True, bound="or_less"),
        "expedite descent and maintain at or below niner thousand",
        "expedite descent to at or below niner thousand",
    ),
    (
        I("altitude", altitude_ft=9_000.0, immediate=True),
        "maintain niner thousand immediately",
        "maintain niner thousand immediately",
    ),
    (
        I("altitude", sense="maintain", altitude_ft=9_000.0, bound="or_more"),
        "maintain at or above niner thousand",
        "maintain at or above niner thousand",
    ),
    (I("altitude", sense="climb"), "climb", "climb"),
    (I("altitude", sense="descend"), "descend", "descend"),
    (I("vertical_rate", rate_fpm=1_500.0, bound="or_more"),
     "at one thousand five hundred feet per minute or greater",
     "at one thousand fife hundred feet per minute or greater"),
    (I("climb_via", position="gopher 1"), "climb via the gopher one departure",
     "climb via the gopher one departure"),
    (I("descend_via", position="hasty 2"), "descend via the hasty two arrival",
     "descend via the hasty two arrival"),
    (I("climb_via"), "climb via", "climb via"),
    # Headings (5-6-2).
    (I("heading", heading_deg=90.0, turn="right"), "turn right heading zero niner zero",
     "turn right heading zero niner zero"),
    (I("heading", heading_deg=90.0, turn="right", immediate=True),
     "turn right immediately heading zero niner zero",
     "turn right immediately heading zero niner zero"),
    (I("heading", heading_deg=30.0), "fly heading zero three zero", "fly heading zero tree zero"),
    (I("heading", heading_deg=30.0, immediate=True), "fly heading zero three zero immediately",
     "fly heading zero tree zero immediately"),
    (I("heading", position="present heading"), "maintain present heading",
     "maintain present heading"),
    (I("heading", position="runway heading"), "fly runway heading", "fly runway heading"),
    (I("heading"), "fly runway heading", "fly runway heading"),
    (I("heading", turn="left", position="B"), "turn left at bravo", "turn left at bravo"),
    (I("heading", turn="left", immediate=True), "turn left immediately", "turn left immediately"),
    (I("turn_by", turn="left", turn_deg=30.0), "turn three zero degrees left",
     "turn tree zero degrees left"),
    (I("direct", position="dixie"), "proceed direct dixie", "proceed direct dixie"),
    (I("direct", position="dixie", turn="left"), "turn left proceed direct dixie",
     "turn left proceed direct dixie"),
    (I("hold_at", position="dixie", turn="left"), "hold at dixie left turns",
     "hold at dixie left turns"),
    (I("hold_at", position="2 rivers"), "hold at two rivers", "hold at two rivers"),
    (I("own_navigation"), "resume own navigation", "resume own navigation"),
    (I("cross_fix", position="dixie", altitude_ft=9_000.0, speed_kt=250.0),
     "cross dixie at niner thousand at two five zero knots",
     "cross dixie at niner thousand at two fife zero knots"),
    (I("cross_fix", position="dixie", altitude_ft=9_000.0, bound="or_more"),
     "cross dixie at or above niner thousand", "cross dixie at or above niner thousand"),
    (I("cross_fix", position="dixie", speed_kt=210.0), "cross dixie at two one zero knots",
     "cross dixie at two one zero knots"),
    # Speeds (5-7-2).
    (I("speed", speed_kt=210.0), "maintain two one zero knots", "maintain two one zero knots"),
    (I("speed", speed_kt=170.0, bound="or_more", until="until 4 mile final"),
     "maintain one seven zero knots or greater until four mile final",
     "maintain one seven zero knots or greater until fower mile final"),
    (I("speed", speed_kt=170.0, bound="or_less"), "maintain one seven zero knots or less",
     "maintain one seven zero knots or less"),
    (I("speed", named="final approach"), "reduce to final approach speed",
     "reduce to final approach speed"),
    (I("speed"), "reduce to minimum speed", "reduce to minimum speed"),
    (I("mach", mach=0.78),
     "maintain mach point seven eight", "maintain mach decimal seven eight"),
    (I("resume_speed"), "resume normal speed", "resume normal speed"),
    (I("resume_speed", named="published"), "resume published speed", "resume published speed"),
    (I("no_speed_restrictions"), "no speed restrictions", "no speed restrictions"),
    # Transponders and stations (5-2-2 and 2-1-17).
    (I("squawk", squawk="4512"), "squawk four five one two", "squawk fower fife one two"),
    (I("ident"), "squawk ident", "squawk ident"),
    (I("contact", position="tower", frequency_khz=119_100),
     "contact tower one one niner point one", "contact tower one one niner decimal one"),
    (I("contact", position="tower"), "contact tower", "contact tower"),
    (I("monitor", frequency_khz=119_100), "monitor one one niner point one",
     "monitor one one niner decimal one"),
    (I("visual_separation"), "maintain visual separation", "maintain visual separation"),
    (I("stand_by"), "stand by", "stand by"),
    (I("report", position="final"), "report final", "report final"),
    (I("report"), "report", "report"),
    # The circuit (3-8-1 and 3-10-1; ICAO Doc 4444, 12.3.4.13 to 15), and another runway (4-8-7).
    (I("orbit", turn="left"), "make left three sixty", "orbit left"),
    (I("orbit"), "make a three sixty", "orbit"),
    (I("extend", position="downwind"), "extend downwind", "extend downwind"),
    (I("short_approach"), "make short approach", "make short approach"),
    (I("join", "24", "downwind", turn="left"), "enter left downwind runway two four",
     "join left downwind runway two fower"),
    (I("join", None, "base", turn="left", immediate=True), "turn left base", "turn left base"),
    (I("vacate", condition="or"), "or, exit", "or, vacate"),
    (I("altitude", altitude_ft=500.0, bound="or_more"),
     "at or above five hundred feet", "at or above fife hundred feet"),
    (I("join", "24", "straight in"), "make straight in runway two four",
     "join straight in runway two fower"),
    (I("side_step", "24R"), "side step to runway two four right",
     "side step to runway two fower right"),
    (I("return_to_field"), "return to the field", "return to the field"),
    (I("expedite"), "expedite", "expedite"),
    (I("say", position="altitude"), "say altitude", "say altitude"),
    (I("wildlife", "01", "B"), "wildlife on runway one at bravo",
     "wildlife on runway zero one at bravo"),
    (I("wildlife"), "wildlife reported", "wildlife reported"),
    (I("wildlife_gone"), "wildlife has left the runway", "wildlife has left the runway"),
    (I("wildlife_gone", "01"), "wildlife has left runway one", "wildlife has left runway zero one"),
]  # fmt: skip


def test_an_instruction_has_the_words_of_its_manual(subtests: pytest.Subtests) -> None:
    for told, faa, icao in SPOKEN:
        with subtests.test(faa):
            assert phrase_of(told, "faa", readback=False) == faa
            assert phrase_of(told, "icao", readback=False) == icao


def test_every_action_has_its_words() -> None:
    assert {told.action for told, _, _ in SPOKEN} == set(get_args(Action))


def test_a_crew_reads_a_clearance_back_before_its_runway(subtests: pytest.Subtests) -> None:
    table = [
        (I("cleared_to_land", "01"), "cleared to land runway one"),
        (I("cleared_for_takeoff", "19", "B", immediate=True),
         "cleared for immediate takeoff runway one niner at bravo"),
        (I("line_up", "01", condition="behind the cessna"),
         "behind the cessna, line up and wait runway one"),
        (I("go_around"), "going around"),
        (I("cancel_takeoff"), "cancel takeoff clearance"),
        (I("cross", "15"), "cross runway one five"),
    ]  # fmt: skip
    for told, words in table:
        with subtests.test(words):
            assert phrase_of(told, "faa", readback=True) == words
