"""Mixing of calls for the training of the recogniser."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="no torch or onnx: pip install torch onnx")

from hypothesis import given, settings  # noqa: E402
from hypothesis import strategies as st  # noqa: E402

from airhilt.assistant.asr.features import (  # noqa: E402
    BINS,
    FLOOR,
    LOUD_FRAMES,
    is_near_speech,
    normalised,
)
from mixing import ANY, EASY, Drawn, Mixer  # noqa: E402
from mixing import is_near_speech as is_near_speech_of_batch  # noqa: E402
from mixing import normalised as normalised_batch  # noqa: E402

pytestmark = pytest.mark.filterwarnings("default")  # torch's own
torch.set_num_threads(1)


def power_of(rng: np.random.Generator, frames: int) -> np.ndarray:
    """Return noise with louder stretches in it, clicks among them."""
    power = rng.exponential(10.0 ** rng.uniform(-6, -2), (frames, BINS)).astype(np.float32)
    for _ in range(rng.integers(0, 4)):
        begin, size = rng.integers(0, frames), rng.integers(1, 120)
        power[begin : begin + size] += 10.0 ** rng.uniform(-4, 0)
    return power


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32), st.lists(st.integers(LOUD_FRAMES, 600), min_size=1, max_size=5))
def test_a_batch_has_the_features_that_the_recogniser_computes_of_each_call(
    seed: int, lengths: list[int]
) -> None:
    rng = np.random.default_rng(seed)
    calls = [power_of(rng, frames) for frames in lengths]
    power = torch.zeros(len(calls), max(lengths) + 40, BINS)
    for row, call in enumerate(calls):
        power[row, : len(call)] = torch.from_numpy(call)
    is_own = torch.arange(power.shape[1]) < torch.tensor(lengths)[:, None]
    near, features = is_near_speech_of_batch(power, is_own), normalised_batch(power, is_own)
    for row, call in enumerate(calls):
        assert np.array_equal(near[row, : len(call)].numpy(), is_near_speech(call))
        assert not near[row, len(call) :].any()
        assert np.allclose(features[row, : len(call)].numpy(), normalised(call), atol=1e-3)


def mixer_of(calls: list[np.ndarray], noise_power: float = 1.0) -> tuple[Mixer, Drawn]:
    """Return a mixer of calls, and a batch with all of them, the last of which is silent."""
    logarithms = np.concatenate([np.log(call + FLOOR) for call in calls]).astype(np.float16)
    lengths = np.array([len(call) for call in calls])
    begins = np.concatenate([[0], np.cumsum(lengths)[:-1]])
    noise = torch.full((2, 300, BINS), noise_power)
    is_silent = torch.zeros(len(calls), dtype=torch.bool)
    is_silent[-1] = True
    drawn = Drawn(
        torch.from_numpy(begins),
        torch.from_numpy(lengths),
        torch.zeros(len(calls), dtype=torch.bool),
        is_silent,
    )
    return Mixer(torch.from_numpy(logarithms), noise), drawn


def speech(frames: int, seed: int = 0) -> np.ndarray:
    """Return powers like those of speech, in which each frame differs from the others."""
    rng = np.random.default_rng(seed)
    return np.exp(rng.normal(-6.0, 1.5, (frames, BINS))).astype(np.float32)


def generator(seed: int) -> Any:
    """Return a generator of the processor."""
    return torch.Generator().manual_seed(seed)


def test_what_is_mixed_follows_from_the_generator() -> None:
    mixer, drawn = mixer_of([speech(200), speech(260, 1), speech(240, 2)])
    first, again, other = (mixer.mix(drawn, ANY, generator(seed))[0] for seed in (1, 1, 2))
    assert torch.equal(first, again)
    assert first.shape != other.shape or not torch.allclose(first, other)


def test_easy_calls_keep_their_speed_and_timbre() -> None:
    call = speech(200)
    mixer, drawn = mixer_of([call, call], noise_power=0.0)
    features, lengths = mixer.mix(drawn, EASY, generator(0))
    assert lengths.tolist() == [200, 200]
    assert np.allclose(features[0, :200].numpy(), normalised(call), atol=0.02)


def test_others_differ_in_speed_and_stay_within_its_bounds() -> None:
    mixer, drawn = mixer_of([speech(300, seed) for seed in range(60)])
    _, lengths = mixer.mix(drawn, ANY, generator(0))
    spoken = lengths[:-1].float()
    assert spoken.std() > 20.0
    assert 300 / 1.23 < spoken.min() < spoken.max() < 300 / 0.81
    assert lengths[-1] == 300


def test_a_received_call_has_no_noise_added_and_is_only_masked() -> None:
    call = speech(200)
    mixer, drawn = mixer_of([call, call])
    received = replace(drawn, is_received=torch.tensor([True, False]))
    features, lengths = mixer.mix(received, ANY, generator(3))
    heard, expected = features[0, : lengths[0]].numpy(), normalised(call)
    is_masked = heard == 0.0
    assert lengths[0] == 200
    assert np.allclose(heard[~is_masked], expected[~is_masked], atol=0.02)
    assert is_masked.mean() < 0.6


def test_a_silent_call_has_the_noise_of_the_receiver_alone() -> None:
    silence = np.zeros((200, BINS), np.float32)
    mixer, drawn = mixer_of([speech(200), silence], noise_power=0.0)
    features, _ = mixer.mix(drawn, ANY, generator(0))
    assert features[0].abs().max() > 1.0
    assert features[1].abs().max() < 1e-3


def test_frames_behind_a_call_are_empty() -> None:
    mixer, drawn = mixer_of([speech(100), speech(300, 1), speech(120, 2)])
    features, lengths = mixer.mix(drawn, ANY, generator(5))
    for row, length in enumerate(lengths.tolist()):
        assert not features[row, length:].any()
        assert features[row, :length].any()
