"""Measures what a recogniser makes of noisy calls with an enhancer and without.

    python tools/asr/asr_speech.py build/enhancement espeak --count 60 --seed 5
    python tools/enhancement_errors.py build/enhancement --enhancer spectral

Each utterance of each shard goes through the channel "vhf" with a noise of its own, the same with
the enhancer and without. The table has word error rates, and callsigns that are right.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

import jiwer
import numpy as np

sys.path.append(str(Path(__file__).parent / "asr"))
from airhilt.assistant.asr.engine import AsrEngine
from airhilt.audio.pcm import Audio
from airhilt.engine_families import ENHANCERS, RECOGNISERS
from airhilt.phraseology import parse_call
from airhilt.scenario.radio_profiles import PROFILES
from airhilt.sensors.radio.channel import VhfChannel
from eval_asr import SpokenCall, rosters_for, spoken

RATIOS_DB = (0.0, 5.0, 10.0)


def errors(
    calls: list[SpokenCall], snr_db: float, engine: AsrEngine, enhance: Callable[[Audio], Audio]
) -> str:
    """Return the word error rate and the share of callsigns that are right, both in percent."""
    channel = VhfChannel(PROFILES["vhf"])
    heard, named = [], []
    for index, (call, roster) in enumerate(zip(calls, rosters_for(calls), strict=True)):
        noise = np.random.default_rng([index, int(snr_db) + 100])
        audio = enhance(channel.transmit(call.speech, snr_db, noise, (), "cockpit"))
        heard.append(engine.recognise(audio, roster).text)
        if call.callsign is not None:
            named.append(parse_call(heard[-1], roster).callsign == call.callsign)
    rate = jiwer.wer([call.text for call in calls], heard)
    return f"{100 * rate:.1f} ({100 * float(np.mean(named)):.0f})"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="shards of tools/asr/asr_speech.py")
    parser.add_argument("--enhancer", default="spectral")
    parser.add_argument("--engine", default="embedded", help="recogniser")
    given = parser.parse_args()
    engine, enhance = RECOGNISERS.create(given.engine), ENHANCERS.create(given.enhancer).enhance
    print(
        f"| WER % (callsigns right %) | SNR | as received | {given.enhancer} |\n|---|---|---|---|"
    )
    for shard in sorted(given.folder.glob("*.jsonl")):
        calls = list(spoken(shard))
        for snr_db in RATIOS_DB:
            cells = [errors(calls, snr_db, engine, each) for each in (lambda audio: audio, enhance)]
            print(f"| {shard.stem}, {len(calls)} calls | {snr_db:g} dB | {' | '.join(cells)} |")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
