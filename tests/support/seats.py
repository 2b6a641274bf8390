"""Runs with people at seats, and what these people type and speak."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from airhilt import load
from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio, to_pcm
from airhilt.cosim.recorded import Recorded, UnregisteredMessage
from airhilt.cosim.simulation import run
from airhilt.options import Options
from airhilt.record import Logged, open_run
from airhilt.scenario import Scenario
from airhilt.voices.engines import tts_engine

SECOND = 1_000_000_000
PIECE = SAMPLE_RATE_HZ // 10
"""Samples in a message of a microphone."""


def said(seat: str, t_s: float, text: str) -> UnregisteredMessage:
    return message(f"speech/{seat}", t_s, text=text)


def message(key: str, t_s: float, **content: Any) -> UnregisteredMessage:
    return UnregisteredMessage(key, round(t_s * SECOND), json.dumps(content).encode())


def tower(duration_s: float = 40.0) -> Scenario:
    """A landing at Washington, where the tower clears AAL123 to land at 1 s."""
    return load("s01b_nominal").model_copy(update={"duration_s": duration_s, "cameras": ()})


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
    return list(open_run(out).messages())


def contents(log: Sequence[Logged], key: str) -> list[dict[str, Any]]:
    return [json.loads(one.data) for one in log if one.key.startswith(key)]


def calls(log: Sequence[Logged]) -> list[dict[str, Any]]:
    return contents(log, "truth/radio/")


def voice(text: str) -> Audio:
    """Return a text as somebody says it, between two short silences."""
    engine = tts_engine("espeak")
    quiet = np.zeros(SAMPLE_RATE_HZ // 5, np.float32)
    return np.concatenate([quiet, engine.synthesise(text, engine.voice_of("a person")), quiet])


def spoken(seat: str, t_s: float, audio: Audio) -> list[UnregisteredMessage]:
    """Return the messages of a microphone into which somebody speaks from a time on."""
    key = f"microphone/{seat}"
    messages = [message(key, t_s, phase="pressed")]
    for begin in range(0, len(audio), PIECE):
        t_s += PIECE / SAMPLE_RATE_HZ
        pcm = b64encode(to_pcm(audio[begin : begin + PIECE])).decode()
        messages.append(message(key, t_s, phase="samples", pcm=pcm))
    return [*messages, message(key, t_s + 0.01, phase="released")]
