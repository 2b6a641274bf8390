"""What a tower says in any situation is done as read back, or refused, or asked about."""

from __future__ import annotations

import itertools
import json
import random
import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, get_args

import pytest

from airhilt.phraseology import Action, Instruction, parse_call
from airhilt.phraseology.say import speak_instruction
from airhilt.units import SECOND_NS
from airhilt.world.actors.orders import orders_of, subject_of
from seats import calls, contents, logged, said
from tower_calls import DEPARTURE, GROUND, LAYOUT, SITUATIONS, TOWER, Seen, scenario_of

SLOTS: dict[str, dict[str, Any]] = {
    "altitude": {"sense": "climb", "altitude_ft": 3000.0},
    "heading": {"turn": "left", "heading_deg": 270.0},
    "turn_by": {"turn": "right", "turn_deg": 20.0},
    "speed": {"speed_kt": 180.0},
    "mach": {"mach": 0.7},
    "vertical_rate": {"sense": "climb", "rate_fpm": 1000.0},
    "direct": {"position": "lam"},
    "hold_at": {"position": "lam"},
    "cross_fix": {"position": "lam", "altitude_ft": 4000.0},
    "climb_via": {"position": "lander 4"},
    "descend_via": {"position": "lander 4"},
    "cleared_approach": {"approach": "ils", "runway": "01"},
    "taxi": {"runway": "01", "via": ("K", "J")},
    "vacate": {"position": "E"},
    "follow": {"position": "the boeing 737"},
    "give_way": {"position": "the boeing 737"},
    "contact": {"position": "ground", "frequency_khz": 121_700},
    "monitor": {"position": "ground", "frequency_khz": 121_700},
    "join": {"turn": "left", "position": "downwind", "runway": "01"},
    "extend": {"position": "downwind"},
    "squawk": {"squawk": "2446"},
    "report": {"position": "established"},
    "say": {"position": "altitude"},
}
NO_RUNWAY = {*SLOTS, "hold_position", "stop", "own_navigation", "orbit", "ident", "expedite",
             "stand_by", "push_back", "start_up", "short_approach", "return_to_field",
             "no_speed_restrictions", "resume_speed", "visual_separation"}  # fmt: skip
REPORTS = {"wildlife", "wildlife_gone"}
"""Actions that no tower tells somebody to do."""
EVERY_S = 15.0
"""Time in s from one call to the next: what comes of it comes before."""
VARIATION_DEG = LAYOUT.airport.magnetic_variation.east_deg
FLOWN_S = 240.0
"""Time in s after two instructions in the air in which it is seen what is flown."""
UNSAID = frozenset({"climb_to_ft", "level_ft"})
"""Parts of commands that nobody has to say: the level of a published missed approach, and one on
the way to a runway that is refused."""


def instruction(action: Action) -> Instruction:
    """Return an instruction as a tower would give it."""
    slots = SLOTS.get(action, {} if action in NO_RUNWAY else {"runway": "01"})
    return Instruction(action, **slots)


def instructions(*actions: Action) -> list[Instruction]:
    return [instruction(each) for each in actions]


ACTIONS: list[Action] = [each for each in get_args(Action) if each not in REPORTS]
LAST = instructions("contact", "monitor", "report")
"""Instructions at the end of a call of any kind."""
TAXI = [
    *instructions("hold_position", "stop", "taxi", "follow", "give_way"),
    Instruction("taxi", runway="33", via=("J", "N")),
    Instruction("hold_short", runway="04"),
    Instruction("cross", runway="04", position="J"),
    Instruction("cross", runway="27", position="J"),
    Instruction("heading", turn="right", position="J"),
    Instruction("heading", turn="left", position="Z"),
]
LEVELS_AND_HEADINGS = [
    *instructions("altitude", "heading", "turn_by", "speed", "direct", "hold_at"),
    Instruction("altitude", sense="climb", altitude_ft=35_000.0),
]
LANDINGS = [
    *instructions("cleared_to_land", "touch_and_go", "circle"),
    Instruction("cleared_to_land", runway="33"),
]
CIRCUIT = instructions("extend", "join", "orbit", "short_approach")
EXITS = [instruction("vacate"), Instruction("vacate", position="B", turn="left")]
TOGETHER: dict[str, list[tuple[list[Instruction], list[Instruction]]]] = {
    "taxi": [(TAXI, [*TAXI, *LAST])],
    "departure": [
        (
            instructions("line_up", "cleared_for_takeoff", "cancel_takeoff", "backtrack"),
            [*EXITS, *instructions("hold_position", "stop", "altitude", "heading"), *LAST],
        )
    ],
    "rollout": [([*EXITS, *instructions("stop", "backtrack")], [*TAXI, *LAST])],
    "approach": [
        (LANDINGS, [*EXITS, Instruction("hold_short", runway="15"), *LAST]),
        (instructions("go_around"), [*LEVELS_AND_HEADINGS, *LAST]),
    ],
    "circuit": [(CIRCUIT, [*CIRCUIT, *instructions("cleared_to_land", "go_around"), *LAST])],
    "en_route": [
        (
            LEVELS_AND_HEADINGS,
            [*LEVELS_AND_HEADINGS, *instructions("cleared_approach"), *LAST],
        )
    ],
}
"""First and second instructions that a tower says in one call, by the phase."""
PHASES = {
    "final": "approach", "short_final": "approach", "final_cleared": "approach",
    "downwind": "circuit", "climb_out": "en_route", "en_route": "en_route",
    "holding_short": "departure", "short_of_d": "departure", "lined_up": "departure",
    "takeoff_roll": "departure", "landed": "rollout", "vehicle_on_runway": "rollout",
}  # fmt: skip
"""Phases of the situations in which nobody just taxies."""
PAIRS_OF_EACH = 3
"""Number of pairs of instructions that each situation gets, in both orders."""


def pairs_of(situation: str) -> list[Sequence[Instruction]]:
    """Return a seeded sample of two instructions that a tower says in one call, in both orders."""
    every = [
        (first, second)
        for firsts, seconds in TOGETHER[PHASES.get(situation, "taxi")]
        for first, second in itertools.product(firsts, seconds)
        if first.action != second.action
    ]
    some = random.Random(situation).sample(every, PAIRS_OF_EACH)
    return [pair for first, second in some for pair in ((first, second), (second, first))]


def faults(
    situation: str, given: Sequence[Sequence[Instruction]], out: Path, last_s: float = EVERY_S
) -> list[str]:
    """Return what is wrong about the answers to calls that are made one after another.

    What is flown is seen for ``last_s`` after the last of them.
    """
    callsign, _, first_s = SITUATIONS[situation]
    times_s = [first_s + EVERY_S * number for number in range(len(given))]
    texts = [speak_instruction(callsign, each, "faa") for each in given]
    messages = [
        said("Washington_Tower", time_s, text) for time_s, text in zip(times_s, texts, strict=True)
    ]
    log = logged(scenario_of(situation, (), times_s[-1] + last_s), out, ["tower"], messages)
    events = [each for each in contents(log, "truth/event") if each["subject"] == callsign]
    spoken = [each for each in calls(log) if each["speaker"] == callsign]
    found = []
    for each_given, time_s, text in zip(given, times_s, texts, strict=True):
        until_s = time_s + EVERY_S
        after = [each for each in events if time_s < each["t_ns"] / SECOND_NS <= until_s]
        if any(each["kind"] == "actor_ended" for each in after):
            break
        refused = [each["text"].lower() for each in after if each["kind"] == "unable"]
        done = [json.loads(each["text"]) for each in after if each["kind"] == "command"]
        answers = [
            each["text"].lower()
            for each in spoken
            if time_s < each["t_tx_ns"] / SECOND_NS <= until_s
        ]
        answer = Answer(callsign, answers, refused, done)
        seen = Seen(log, callsign, time_s) if len(given) == 1 else None
        fault = answer.fault(each_given) or (seen and not_flown(answer.read_back, seen))
        if fault:
            found.append(f"{situation}: {text!r} -> {answers!r}: {fault}")
        if any(each["action"] == "contact" for each in done):
            break  # It is on another frequency now.
    return found


@dataclass(frozen=True)
class Answer:
    """Answer and acts of somebody after a call."""

    callsign: str
    said: Sequence[str]
    refused: Sequence[str]
    done: Sequence[dict[str, Any]]

    @cached_property
    def words(self) -> str:
        """Words to the tower without those of a refusal."""
        answers = list(self.said)
        for refused in self.refused:
            answers = [each.replace(refused, "") for each in answers]
        units = tuple(unit.lower() for unit in (TOWER, GROUND, DEPARTURE))
        return " ".join(each for each in answers if not each.startswith(units))

    @cached_property
    def read_back(self) -> tuple[Instruction, ...]:
        return parse_call(re.sub("say again.*", "", self.words), [self.callsign]).instructions

    def fault(self, given: Sequence[Instruction]) -> str:
        """Return what is wrong about it; empty if nothing is."""
        for words in self.refused:
            if not any(words in each for each in self.said):
                return f"does not say {words!r}"
        read_back = self.read_back
        if is_report(self.words) and any(each.action == "say" for each in given):
            read_back = tuple(each for each in read_back if each.action != "altitude")
        if (wrong := wrongly_done(read_back, self.callsign, self.done)) is not None:
            return wrong
        if not read_back and "say again" in self.words:
            return ""  # It asks about all of the call.
        told = {each.action for each in read_back}
        missing = [each for each in given if each.action not in told]
        if is_report(self.words):
            missing = [each for each in missing if each.action != "say"]
        unanswered = len({reason(each) for each in missing}) - len(set(self.refused))
        unanswered -= len(re.findall(r"\bsay \w+", self.words))
        return f"no word of {[each.action for each in missing]}" if unanswered > 0 else ""


def reason(told: Instruction) -> str:
    """Return what the reason to refuse an instruction is about: one is said for all about that."""
    (order,) = orders_of([told], "01", VARIATION_DEG, "AAL123")
    if order.command is None:
        return told.action
    subject = subject_of(order.command)
    return "flight" if subject in ("level", "speed", "track", "approach") else subject


def not_flown(read_back: Sequence[Instruction], seen: Seen) -> str:
    """Return what of a readback is not seen in the movement afterwards; empty if all is."""
    now = [each for each in read_back if not each.is_conditional]
    does = {each.action for each in now}
    for each in now:
        match each:
            case Instruction(action="hold_position" | "stop") if not seen.stands_still():
                return "does not stand still"
            case Instruction(action="go_around") if not seen.goes_around():
                return "does not go around"
            case Instruction(action="altitude", altitude_ft=float(ft), bound=None):
                if not seen.altitude(ft) and not seen.comes_nearer_to_ft(ft):
                    return f"does not fly to {ft:g} ft"
            case Instruction(action="heading", heading_deg=float(degrees)):
                if not {"cleared_for_takeoff"} & does and not seen.has_flown_track(degrees):
                    return f"does not fly heading {degrees:g}"
            case Instruction(action="cleared_to_land", runway=str(runway)):
                if seen.lands() and not seen.lands_on(runway):
                    return f"does not land on runway {runway}"
    return ""


def wrongly_done(
    read_back: Sequence[Instruction], callsign: str, done: Sequence[dict[str, Any]]
) -> str | None:
    """Return how what was done differs from what the words of a readback order."""
    orders = orders_of(read_back, "01", VARIATION_DEG, callsign)
    commands = dict.fromkeys(
        each.command
        for each in sorted(orders, key=lambda one: one.rank)
        if each.command is not None and each.when is None
    )
    ordered = [each.model_dump(mode="json", exclude_none=True) for each in commands]
    is_same = len(done) == len(ordered) and all(
        {name: value for name, value in does.items() if name in said or name not in UNSAID} == said
        for does, said in zip(done, ordered, strict=True)
    )
    return None if is_same else f"does {done}, has read back {ordered}"


def is_report(answer: str) -> bool:
    """Return whether an answer tells an altitude."""
    return any(word in answer for word in ("thousand", "hundred", "feet", "on the ground"))


@pytest.mark.parametrize("situation", list(SITUATIONS))
def test_every_instruction_is_done_as_read_back_or_refused_aloud_or_asked_about(
    situation: str, tmp_path: Path
) -> None:
    """Each instruction is given in one situation; where ``slow`` tests run, in all of them."""
    offset = list(SITUATIONS).index(situation)
    some = [[instruction(each)] for each in ACTIONS[offset :: len(SITUATIONS)]]
    assert faults(situation, some, tmp_path / "run") == []


@pytest.mark.slow
@pytest.mark.parametrize("situation", list(SITUATIONS))
def test_every_instruction_in_every_situation(situation: str, tmp_path: Path) -> None:
    found = [
        each
        for number, action in enumerate(ACTIONS)
        for each in faults(situation, [[instruction(action)]], tmp_path / str(number))
    ]
    assert found == []


@pytest.mark.slow
@pytest.mark.parametrize("situation", list(SITUATIONS))
def test_each_of_two_instructions_in_one_call_is_flown_or_refused_in_both_orders(
    situation: str, tmp_path: Path
) -> None:
    is_flying = PHASES.get(situation) in ("approach", "circuit", "en_route")
    last_s = FLOWN_S if is_flying else 2.0 * EVERY_S
    found = [
        each
        for number, pair in enumerate(pairs_of(situation))
        for each in faults(situation, [pair], tmp_path / str(number), last_s)
    ]
    assert found == []


@pytest.mark.slow
@pytest.mark.parametrize("situation", ["taxiing", "taxiing_behind"])
@pytest.mark.parametrize(
    "words",
    [
        "turn left at Zulu, stop immediately",
        "stop immediately, turn left at Zulu",
        "cross runway two seven at Juliett, hold position",
        "hold position, taxi to runway two seven via Zulu",
    ],
)
def test_who_is_told_to_stop_stops_whatever_else_it_cannot_do(
    situation: str, words: str, tmp_path: Path
) -> None:
    callsign, _, at_s = SITUATIONS[situation]
    told = [said("Washington_Tower", at_s, f"American one two three, {words}")]
    log = logged(scenario_of(situation, (), at_s + 30.0), tmp_path / "run", ["tower"], told)
    seen = Seen(log, callsign, at_s)
    assert seen.stands_still()
    assert seen.refuses_or_asks()
