"""The corpus: phrases put together to calls.

A deck of all phrases is dealt again and again, so that each kind of call comes about as often as
its weight says, whatever the seed.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Literal

from . import (
    approaches,
    chatter,
    ground,
    lateral,
    pilots,
    runways,
    speeds,
    surveillance,
    vertical,
    vfr,
)
from .model import Call, Exchange, Phrase
from .scene import Scene
from .spoken_numbers import run_together

Instruction = Callable[[Scene], Exchange]
Saying = Callable[[Scene], Phrase]
Make = Callable[[Scene], Call | None]
"""Makes a call; None where its numbers run together, so that nobody could tell them apart."""

AIR: dict[Instruction, int] = {
    vertical.climb_or_descend: 5,
    vertical.maintain: 2,
    vertical.level_of_immediacy: 1,
    vertical.level_later: 2,
    vertical.expected_level: 1,
    vertical.crossing: 3,
    vertical.via_procedure: 2,
    vertical.stop_climb: 1,
    vertical.block: 1,
    vfr.rate: 2,
    vfr.level_limit: 1,
    vfr.airspace: 2,
    lateral.turn: 5,
    lateral.turn_by: 1,
    lateral.present_heading: 1,
    lateral.heading_later: 2,
    lateral.heading_until: 1,
    lateral.immediate_turn: 2,
    lateral.stop_turn: 1,
    lateral.direct: 3,
    lateral.direct_later: 1,
    lateral.own_navigation: 1,
    lateral.hold: 2,
    lateral.expected_direct: 1,
    lateral.deviation: 1,
    lateral.orbit: 1,
    speeds.speed: 3,
    speeds.speed_until: 2,
    speeds.speed_later: 1,
    speeds.mach: 1,
    speeds.normal_speed: 2,
    speeds.approach_speed: 2,
    speeds.then_descend: 1,
    speeds.say_speed: 2,
    approaches.cleared: 4,
    approaches.cleared_without_name: 1,
    approaches.visual: 2,
    approaches.vectored: 3,
    approaches.intercept: 1,
    approaches.at_fix: 2,
    approaches.circling: 2,
    approaches.expected: 2,
    approaches.cancel_approach: 1,
    approaches.missed_approach_instructions: 1,
    surveillance.contact: 5,
    surveillance.contact_without_number: 2,
    surveillance.contact_later: 1,
    surveillance.frequency_change: 3,
    surveillance.squawk: 2,
    surveillance.transponder: 3,
    surveillance.radar_contact: 3,
    surveillance.traffic: 4,
    surveillance.traffic_gone: 1,
    surveillance.visual_separation: 1,
    surveillance.wake: 1,
    surveillance.wind_check: 1,
    surveillance.atis: 1,
    surveillance.low_altitude: 1,
    surveillance.report_when: 2,
    surveillance.correction_of_readback: 1,
    surveillance.words_of_procedure: 10,
    ground.setting: 2,
    chatter.withdrawn: 1,
}
"""Instructions in flight, with their weights."""
FIELD: dict[Instruction, int] = {
    runways.takeoff: 5,
    runways.landing: 5,
    vfr.land_and_hold_short: 1,
    runways.option: 5,
    runways.line_up: 3,
    runways.line_up_behind: 2,
    runways.hold_short: 3,
    runways.go_around: 3,
    runways.cancel_takeoff: 2,
    runways.vacate: 1,
    runways.circuit: 2,
    runways.sequence: 1,
    runways.expected_clearance: 4,
    runways.departure_restriction: 2,
    runways.cross: 3,
    ground.taxi: 5,
    ground.taxi_to_parking: 1,
    ground.give_way: 1,
    ground.taxi_later: 1,
    ground.pushback: 3,
    ground.backtrack: 1,
    ground.continue_taxi: 2,
    ground.route_clearance: 2,
    ground.amended_route: 1,
    ground.release: 3,
}
"""Instructions of a tower, with their weights."""
PILOTS: dict[Saying, int] = {
    pilots.check_in: 6,
    pilots.level_report: 2,
    pilots.position_report: 8,
    pilots.sight: 3,
    pilots.ready: 2,
    pilots.level_request: 2,
    pilots.lateral_request: 6,
    pilots.approach_request: 5,
    pilots.ground_request: 4,
    pilots.other_request: 7,
    pilots.own_go_around: 4,
    pilots.resolution: 4,
    pilots.distress: 8,
    pilots.unable: 2,
    pilots.weather: 2,
    pilots.acknowledgement: 5,
}
"""Calls that pilots make unasked, with their weights."""
TOGETHER: tuple[tuple[Instruction, ...], ...] = (
    (lateral.turn, vertical.climb_or_descend, speeds.speed, surveillance.traffic),
    (surveillance.radar_contact, vertical.climb_or_descend, lateral.turn, lateral.direct),
    (vertical.climb_or_descend, ground.setting, approaches.expected, speeds.speed),
    (approaches.cleared, speeds.speed_until, surveillance.contact_without_number),
    (lateral.direct, vertical.crossing, surveillance.contact),
    (runways.landing, surveillance.wake, surveillance.traffic),
    (runways.takeoff, surveillance.wake, surveillance.traffic),
    (runways.hold_short, surveillance.traffic),
    (surveillance.squawk, ground.setting, vertical.maintain),
    (ground.taxi, ground.setting, surveillance.contact_later),
    (runways.vacate, surveillance.contact, ground.continue_taxi),
    (vertical.expected_level, lateral.turn, surveillance.report_when),
    (approaches.visual, surveillance.contact, speeds.normal_speed),
    (runways.circuit, runways.sequence, surveillance.report_when),
)
"""Instructions that are given in one call."""
HESITATIONS = ("uh", "um", "er", "ah", "and uh")
HESITATING = 0.1
"""Share of calls with a hesitation."""
SLIPPING = 0.06
"""Share of calls in which a number is corrected."""


def corpus(seed: int, calls: int) -> Iterator[Call]:
    """Yield calls; the same seed gives the same calls.

    Parameters
    ----------
    seed
        The seed of the random numbers.
    calls
        The number of calls.
    """
    rng = random.Random(seed)
    deck: list[Make] = []
    turns: Counter[str] = Counter()
    for _ in range(calls):
        if not deck:
            deck = _deck()
            rng.shuffle(deck)
        make = deck.pop()
        while (call := make(_scene(rng, turns))) is None:
            pass
        yield call


def _scene(rng: random.Random, turns: Counter[str]) -> Scene:
    scene = Scene.drawn(rng, turns)
    scene.say.errors_left = int(rng.random() < SLIPPING)
    return scene


def _deck() -> list[Make]:
    makes: list[Make] = []
    for instruction, weight in (AIR | FIELD).items():
        makes += [_controlling((instruction,))] * weight
        makes += [_reading_back((instruction,))] * max(1, weight // 2)
    for together in TOGETHER:
        makes += [_controlling(together)] * 4 + [_reading_back(together)] * 3
    for saying, weight in PILOTS.items():
        makes += [_piloting(saying)] * weight
    makes += [_controller_says(chatter.small_talk)] * 2 + [_piloting(chatter.small_talk)] * 2
    return makes + [_broadcasting] * 3 + [_controller_says(chatter.hearsay)] * 3


def _controlling(makers: tuple[Instruction, ...]) -> Make:
    def make(scene: Scene) -> Call | None:
        phrases = [each.instruction for each in _some(scene, makers)]
        texts = [phrase.text for phrase in phrases]
        place = scene.rng.random()
        if place < 0.04:
            return _call(scene, texts, phrases, "controller", is_named=False)
        callsign = scene.callsign()
        if place < 0.09:
            return _call(scene, [*texts, callsign], phrases, "controller")
        opening = [callsign, scene.callsign()] if place > 0.97 else [callsign]
        if scene.chance(0.1):
            unit = scene.pick("tower", "approach", "center", "ground", "control")
            opening.append(f"{scene.city} {unit}")
        return _call(scene, opening + texts, phrases, "controller")

    return make


def _reading_back(makers: tuple[Instruction, ...]) -> Make:
    def make(scene: Scene) -> Call | None:
        found = _some(scene, makers)
        if len(found) > 1 and scene.chance(0.25):
            found.pop(scene.rng.randrange(len(found)))
        phrases = [scene.rng.choice(each.readbacks) for each in found]
        phrases = [phrase for phrase in phrases if phrase.text != "roger"] or phrases[:1]
        texts = [phrase.text for phrase in phrases]
        if scene.chance(0.15):
            texts.insert(0, scene.pick("okay", "roger", "all right", "copy"))
        place = scene.rng.random()
        if place < 0.1:
            return _call(scene, texts, phrases, "pilot", is_named=False)
        callsign = scene.callsign()
        texts = [callsign, *texts] if place < 0.2 else [*texts, callsign]
        return _call(scene, texts, phrases, "pilot")

    return make


def _piloting(saying: Saying) -> Make:
    def make(scene: Scene) -> Call | None:
        phrase = saying(scene)
        if saying is pilots.distress:
            return _call(scene, [phrase.text], [phrase], "pilot")
        texts = [scene.callsign(), phrase.text]
        if saying is pilots.acknowledgement or scene.chance(0.25):
            return _call(scene, texts[::-1], [phrase], "pilot")
        if scene.chance(0.3):
            texts.insert(0, scene.pick("good morning", "hello", "and"))
        if scene.chance(0.5):
            unit = scene.pick("approach", "tower", "center", "ground", "radar", "departure")
            texts.insert(0, f"{scene.city} {unit}")
        return _call(scene, texts, [phrase], "pilot")

    return make


def _controller_says(saying: Saying) -> Make:
    def make(scene: Scene) -> Call | None:
        phrase = saying(scene)
        return _call(scene, [scene.callsign(), phrase.text], [phrase], "controller")

    return make


def _broadcasting(scene: Scene) -> Call | None:
    phrase = chatter.broadcast(scene)
    return _call(scene, [phrase.text], [phrase], "controller", is_named=False)


def _some(scene: Scene, makers: tuple[Instruction, ...]) -> list[Exchange]:
    """Return one to three exchanges that do not order the same thing twice."""
    number = min(len(makers), scene.pick(2, 2, 3))
    found: list[Exchange] = []
    ordered: set[str] = set()
    for maker in scene.rng.sample(makers, number):
        made = maker(scene)
        kinds = {item.kind for item in made.instruction.items}
        if not kinds & ordered:
            found.append(made)
            ordered |= kinds
    return found


def _call(
    scene: Scene,
    texts: list[str],
    phrases: list[Phrase],
    speaker: Literal["controller", "pilot"],
    *,
    is_named: bool = True,
) -> Call | None:
    if any(run_together(*pair) for pair in pairwise(texts)):
        return None
    words = " ".join(texts).split()
    if scene.chance(HESITATING):
        words.insert(scene.rng.randrange(len(words) + 1), scene.rng.choice(HESITATIONS))
    return Call(
        text=" ".join(words),
        roster=tuple(aircraft.ident for aircraft in scene.aircraft),
        speaker=speaker,
        callsign=scene.own.ident if is_named else None,
        items=tuple(item for phrase in phrases for item in phrase.items),
        source="; ".join(dict.fromkeys(phrase.source for phrase in phrases)),
    )
