"""What a tower says in any situation is done as read back, or refused, or asked about."""

from __future__ import annotations

import itertools
import json
from pathlib import Path
from typing import Any, get_args

import pytest

from airhilt.phraseology import Action, Instruction, parse_call
from airhilt.phraseology.say import speak_instruction
from airhilt.units import SECOND_NS
from airhilt.world.actors.orders import NOTHING_MOVES, orders_of
from seats import calls, contents, logged, said
from tower_calls import SITUATIONS, scenario_of

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
EVERY_S = 9.0
"""Time in s from one call to the next: the answer comes before."""
OTHER_RUNWAY = "33"


def instruction(action: Action) -> Instruction:
    """Return an instruction as a tower would give it."""
    slots = SLOTS.get(action, {} if action in NO_RUNWAY else {"runway": "01"})
    return Instruction(action, **slots)


ACTIONS: list[Action] = [each for each in get_args(Action) if each not in REPORTS]


def unanswered(situation: str, actions: list[Action], out: Path) -> list[str]:
    """Return the instructions, given one after another, of which the outcome is not told."""
    callsign, _, first_s = SITUATIONS[situation]
    times_s = [first_s + EVERY_S * number for number in range(len(actions))]
    texts = [speak_instruction(callsign, instruction(each), "faa") for each in actions]
    messages = [
        said("Washington_Tower", time_s, text) for time_s, text in zip(times_s, texts, strict=True)
    ]
    log = logged(scenario_of(situation, (), times_s[-1] + EVERY_S), out, ["tower"], messages)
    events = [each for each in contents(log, "truth/event") if each["subject"] == callsign]
    spoken = [each for each in calls(log) if each["speaker"] == callsign]
    ended_s = next(
        (each["t_ns"] / SECOND_NS for each in events if each["kind"] == "actor_ended"), float("inf")
    )
    found = []
    for action, time_s, text in zip(actions, times_s, texts, strict=True):
        after = [s for s in spoken if time_s < s["t_tx_ns"] / SECOND_NS <= time_s + EVERY_S]
        answer = " ".join(each["text"] for each in after).lower()
        done = [
            each
            for each in events
            if each["kind"] == "command" and time_s < each["t_ns"] / SECOND_NS <= time_s + EVERY_S
        ]
        is_told = "unable" in answer or "say " in answer
        is_done = bool(answer) and (action in NOTHING_MOVES or is_as_read_back(done, answer))
        if not is_told and not is_done and time_s + EVERY_S < ended_s:
            found.append(f"{situation}: {text!r} -> {answer!r}")
        if action in ("contact", "monitor") and not is_told:
            break  # It is on another frequency now.
    for event in events:
        if event["kind"] == "unable" and not any(
            event["text"].lower() in each["text"].lower() for each in spoken
        ):
            found.append(f"{situation}: not said aloud: {json.dumps(event['text'])}")
    return found


def is_as_read_back(done: list[dict[str, Any]], answer: str) -> bool:
    """Return whether what was done is what the words of an answer order, and nothing else."""
    read_back = parse_call(answer, [callsign for callsign, _, _ in SITUATIONS.values()])
    ordered = orders_of(read_back.instructions, "01", 0.0, "AAL1")
    meant = [each.command.model_dump() for each in ordered if each.command is not None]
    return bool(done) and meanings(meant) == meanings([json.loads(each["text"]) for each in done])


def meanings(commands: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return what commands mean, without what is not said of them."""
    unsaid = {"track_deg", "climb_to_ft", "via", "exit", "cross", "hold_short"}
    return [
        {name: value for name, value in command.items() if name not in unsaid and value is not None}
        for command in commands
    ]


@pytest.mark.parametrize("situation", list(SITUATIONS))
def test_every_instruction_is_done_as_read_back_or_refused_aloud_or_asked_about(
    situation: str, tmp_path: Path
) -> None:
    """Each situation gets every 14th instruction; all get all where ``slow`` tests run."""
    offset = list(SITUATIONS).index(situation)
    some = list(itertools.islice(ACTIONS, offset % len(SITUATIONS), None, len(SITUATIONS)))
    assert unanswered(situation, some, tmp_path / "run") == []


@pytest.mark.slow
@pytest.mark.parametrize("situation", list(SITUATIONS))
def test_every_instruction_in_every_situation(situation: str, tmp_path: Path) -> None:
    found = [
        each
        for number, action in enumerate(ACTIONS)
        for each in unanswered(situation, [action], tmp_path / str(number))
    ]
    assert found == []
