"""Speech in other voices by WORLD, and varied copies of shards."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pyworld = pytest.importorskip("pyworld", reason="needs the extra resynthesis")

import rooms  # noqa: E402
from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio  # noqa: E402
from resynthesis import Manner, analyse, resynthesise, timbre_of  # noqa: E402
from vary_speech import vary, write_varied  # noqa: E402
from vowel import PITCH_HZ, vowel  # noqa: E402

PLAIN = Manner()
SPOKEN_BINS = 200
"""Bins of a spectrum up to 3.1 kHz, where the vowel has sound."""


def spoken(manner: Manner, timbre: Audio | None = None) -> Audio:
    other = None if timbre is None else timbre_of(timbre)
    return resynthesise(analyse(vowel()), manner, np.random.default_rng(0), other)


def pitch_hz(speech: Audio) -> float:
    found, _ = pyworld.dio(np.asarray(speech, np.float64), SAMPLE_RATE_HZ)
    return float(np.median(found[found > 0.0])) if np.any(found > 0.0) else 0.0


def centroid_hz(speech: Audio) -> float:
    power = np.abs(np.fft.rfft(speech)) ** 2
    return float(np.sum(power * np.fft.rfftfreq(len(speech), 1 / SAMPLE_RATE_HZ)) / np.sum(power))


@pytest.mark.parametrize("factor", [0.7, 1.0, 1.5])
def test_the_pitch_changes_by_its_factor(factor: float) -> None:
    assert pitch_hz(spoken(replace(PLAIN, pitch=factor))) == pytest.approx(
        PITCH_HZ * factor, rel=0.03
    )


@pytest.mark.parametrize("factor", [0.75, 1.0, 1.35])
def test_the_tempo_changes_the_length_and_not_the_pitch(factor: float) -> None:
    faster = spoken(replace(PLAIN, tempo=factor, tempo_wander=0.1))
    assert len(faster) == pytest.approx(len(vowel()) / factor, rel=0.02)
    assert pitch_hz(faster) == pytest.approx(PITCH_HZ, rel=0.03)


def test_formants_move_without_the_pitch() -> None:
    low, high = (spoken(replace(PLAIN, formants=factor)) for factor in (0.85, 1.18))
    assert centroid_hz(high) > 1.2 * centroid_hz(low)
    assert pitch_hz(high) == pytest.approx(pitch_hz(low), rel=0.03)


def test_a_whisper_has_no_pitch() -> None:
    found, _ = pyworld.dio(
        np.asarray(spoken(replace(PLAIN, whispered=True)), np.float64), SAMPLE_RATE_HZ
    )
    assert np.mean(found > 0.0) < 0.2


def test_a_borrowed_timbre_is_nearer_to_its_owner() -> None:
    other = rooms.with_resonance(vowel(), 2500.0, 12.0, 2.0)
    own, borrowed, wanted = (
        timbre_of(speech)[:SPOKEN_BINS]
        for speech in (spoken(PLAIN), spoken(replace(PLAIN, borrowed=0.8), other), other)
    )
    assert np.linalg.norm(borrowed - wanted) < np.linalg.norm(own - wanted)


def test_variations_are_repeatable_finite_and_within_full_scale() -> None:
    for seed in range(12):
        first, again = (
            vary(vowel(0.6), np.random.default_rng(seed), [vowel(0.5, 190.0)]) for _ in range(2)
        )
        assert np.array_equal(first, again)
        assert np.all(np.isfinite(first))
        assert np.max(np.abs(first)) <= 1.0
        assert rooms.rms(first) > 0.01


def test_silence_may_be_varied() -> None:
    silence = np.zeros(8_000, np.float32)
    for seed in range(12):
        assert np.all(np.isfinite(vary(silence, np.random.default_rng(seed))))


def test_a_varied_shard_has_the_texts_of_the_shard(tmp_path: Path) -> None:
    calls = [np.asarray(vowel(0.4, pitch) * 32767.0, np.int16) for pitch in (110.0, 180.0)]
    lines = [
        {"text": text, "callsign": None, "voice": "v", "lineage": "l", "samples": len(pcm)}
        for text, pcm in zip(("hold position", "roger"), calls, strict=True)
    ]
    shard = tmp_path / "some-0-000.jsonl"
    shard.write_text("".join(f"{json.dumps(line)}\n" for line in lines))
    np.save(shard.with_suffix(".npy"), np.concatenate(calls))
    write_varied(shard, tmp_path, seed=1, share=1.0)
    copy = tmp_path / "some-0-000-varied-1.jsonl"
    written = [json.loads(line) for line in copy.read_text().splitlines()]
    assert [line["text"] for line in written] == ["hold position", "roger"]
    assert {line["lineage"] for line in written} == {"l"}
    assert sum(line["samples"] for line in written) == len(np.load(copy.with_suffix(".npy")))
