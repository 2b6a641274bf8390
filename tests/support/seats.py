"""Runs with people at seats, and what these people type and speak."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio, to_pcm
from airhilt.cosim.recorded import Recorded, UnregisteredMessage
from airhilt.cosim.simulation import run
from airhilt.messages import SeatState
from airhilt.options import Options
from airhilt.record import Logged, open_run
from airhilt.scenario import Scenario
from airhilt.voices.engines import tts_engine
from nominal import nominal

T = TypeVar("T")
SECOND = 1_000_000_000
PIECE = SAMPLE_RATE_HZ // 10
"""Samples in a message of a microphone."""


def act(seat: str, t_s: float, do: str, **content: Any) -> UnregisteredMessage:
    """Return an act at a seat, a part of keys, as the log of a run has it."""
    return message(f"seat/{seat}/do", t_s, holder="somebody", act={"do": do, **content})


def said(seat: str, t_s: float, text: str) -> UnregisteredMessage:
    return act(seat, t_s, "text", text=text)


def message(key: str, t_s: float, **content: Any) -> UnregisteredMessage:
    return UnregisteredMessage(key, round(t_s * SECOND), json.dumps(content).encode())


def state_of(seat: str, **more: Any) -> SeatState:
    """Return the state of a seat before anybody has come."""
    given = {
        "frequencies_khz": (119_100,), "tuned_khz": (119_100,), "recogniser": "other",
    } | more  # fmt: skip
    return SeatState(seat=seat, voice_is_recorded=True, **given)


def tower(duration_s: float = 40.0) -> Scenario:
    """A landing at Washington, where the tower clears AAL123 to land at 1 s."""
    return nominal("s01b_nominal").model_copy(update={"duration_s": duration_s, "cameras": ()})


def logged(
    scenario: Scenario,
    out: Path,
    seats: Sequence[str],
    messages: Sequence[UnregisteredMessage] = (),
    **more: Any,
) -> list[Logged]:
    options = Options(
        **{
            "out": out,
            "seat": tuple(seats),
            "pace": "virtual",
            "latency": "fixed",
            "assistant": "none",
            "speech": False,
            "report": False,
        }
        | more
    )
    run(scenario, options, recorded=Recorded(unregistered=tuple(messages)))
    return list(open_run(out).log())


def contents(log: Sequence[Logged], key: str) -> list[dict[str, Any]]:
    return [json.loads(one.data) for one in log if one.key.startswith(key)]


def acts(log: Sequence[Logged], seat: str) -> list[dict[str, Any]]:
    return [one["act"] for one in contents(log, f"seat/{seat}/do")]


def states(log: Sequence[Logged], seat: str) -> list[dict[str, Any]]:
    """Return the states of a seat, a part of keys, one after another."""
    return [json.loads(one.data) for one in log if one.key == f"seat/{seat}"]


def once(found: Iterable[T]) -> list[T]:
    """Return what is there, each once, in the order in which it came."""
    every = list(found)
    return [one for i, one in enumerate(every) if one not in every[:i]]


def cards(log: Sequence[Logged], seat: str) -> list[dict[str, Any]]:
    """Return the task cards that a seat has had."""
    return once(card for state in states(log, seat) for card in state["tasks"])


def offers(log: Sequence[Logged], seat: str) -> list[dict[str, Any]]:
    """Return the offers that a seat has had."""
    return once(offer for state in states(log, seat) for offer in state["offers"])


def notices(log: Sequence[Logged], seat: str) -> list[str]:
    """Return what a seat was told."""
    told = once(state["notice"] for state in states(log, seat) if state["notice"])
    return [notice["text"] for notice in told]


def calls(log: Sequence[Logged]) -> list[dict[str, Any]]:
    return contents(log, "truth/radio/")


def voice(text: str) -> Audio:
    """Return a text as somebody says it, between two short silences."""
    engine = tts_engine("espeak")
    quiet = np.zeros(SAMPLE_RATE_HZ // 5, np.float32)
    return np.concatenate([quiet, engine.synthesise(text, engine.voice_of("a person")), quiet])


def spoken(seat: str, t_s: float, audio: Audio) -> list[UnregisteredMessage]:
    """Return the acts of somebody who speaks into a microphone from a time on."""
    given = [act(seat, t_s, "press")]
    for begin in range(0, len(audio), PIECE):
        t_s += PIECE / SAMPLE_RATE_HZ
        pcm = b64encode(to_pcm(audio[begin : begin + PIECE])).decode()
        given.append(act(seat, t_s, "say", pcm=pcm))
    return [*given, act(seat, t_s + 0.01, "release")]
