"""Radio calls: how fast they are read, and what their sound costs."""

from __future__ import annotations

import math
import re
import statistics
import tempfile
import time
from pathlib import Path

from airhilt import load, run
from airhilt.audio.pcm import SAMPLE_RATE_HZ
from airhilt.audio.wav import read_wav
from airhilt.engine_families import RECOGNISERS
from airhilt.host.library import names
from airhilt.metrics.summary import Summary
from airhilt.phraseology import Instruction, parse_call, say
from benchmarks.rounds import ROUNDS


def calls() -> tuple[list[str], tuple[str, ...]]:
    """Return calls as they are made, and who is on the frequency.

    They are the lines of the scenario suite, and instructions and readbacks of all kinds in both
    phraseologies, each as it is written and as a recogniser writes it.
    """
    callsigns = ("AAL123", "DAL456", "BAW38", "DLH4AB", "UAL1200", "N172SP", "G-ABCD", "OPS1")
    told = [
        [Instruction("cleared_to_land", "19")],
        [Instruction("cleared_for_takeoff", "01L", immediate=True)],
        [Instruction("line_up", "33", condition="behind the landing cessna")],
        [Instruction("cross", "15", "M"), Instruction("hold_short", "01")],
        [Instruction("taxi", "19", via=("A", "K")), Instruction("hold_short", "15")],
        [Instruction("altitude", sense="climb", altitude_ft=33_000.0)],
        [
            Instruction("heading", turn="right", heading_deg=90.0),
            Instruction("altitude", sense="descend", altitude_ft=4500.0),
        ],
        [Instruction("contact", position="washington centre", frequency_khz=134_325)],
        [Instruction("go_around"), Instruction("altitude", sense="climb", altitude_ft=3000.0)],
        [Instruction("speed", speed_kt=180.0, until="until 4 mile final")],
    ]
    said = [
        speak(callsign, instructions, style)
        for speak in (say.speak_instruction, say.speak_readback)
        for style in ("faa", "icao")
        for callsign in callsigns
        for instructions in told
    ]
    said += [line.text for name in names("scenarios") for line in load(name).radio.lines]
    return said + [re.sub(r"[^a-z ]", "", text.lower()) for text in said], callsigns


def phraseology() -> dict[str, float]:
    """Read calls, in the time of one core that it takes."""
    said, callsigns = calls()

    def once() -> float:
        begun = time.process_time()
        for text in said:
            parse_call(text, callsigns)
        return time.process_time() - begun

    once()
    spent = [once() for _ in range(3 * ROUNDS)]
    return {
        "calls": len(said),
        "calls_per_s_best": len(said) / min(spent),
        "calls_per_s_median": len(said) / statistics.median(spent),
    }


def speech() -> dict[str, float]:
    """Compare a run with sound, its voices cached, with one without, turn by turn."""
    engine = RECOGNISERS.create("embedded")

    def measured(*, is_spoken: bool) -> tuple[float, Summary, float]:
        """Return CPU time, summary, and the CPU time of recognition by the length of the calls."""
        with tempfile.TemporaryDirectory() as scratch:
            begun = time.process_time()
            done = run("s01a_misaddressed", out=Path(scratch) / "run", speech=is_spoken)
            cpu_s = time.process_time() - begun
            calls = [read_wav(path) for path in sorted(done.folder.glob("audio/[!a]*.wav"))]
            begun = time.process_time()
            for call in calls:
                engine.recognise(call, ("AAL123", "DAL456"))
            heard_s = sum(map(len, calls)) / SAMPLE_RATE_HZ
            return cpu_s, done.summary, (time.process_time() - begun) / max(heard_s, 1e-9)

    measured(is_spoken=True)
    silent_s = spoken_s = factor = late_s = math.inf
    for _ in range(ROUNDS):
        silent_s = min(silent_s, measured(is_spoken=False)[0])
        cpu_s, summary, of_time = measured(is_spoken=True)
        spoken_s, factor = min(spoken_s, cpu_s), min(factor, of_time)
        late_s = min(late_s, summary.latencies["asr_after_end"].p95_s or math.inf)
    return {
        "cpu_ms_a_call": 1e3 * (spoken_s - silent_s) / summary.radio.transmissions,
        "asr_real_time_factor": factor,
        "asr_after_end_p95_s": late_s,
        "cpu_ratio_to_no_speech": spoken_s / silent_s,
    }
