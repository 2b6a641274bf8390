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
    LONGEST_CLICK_FRAMES,
    is_near_speech,
    normalised,
)
from mixing import (  # noqa: E402
    ANY,
    CLEAR,
    EASY,
    SPEECH_POWER,
    Drawn,
    Mixer,
    Sound,
    _Chance,
    _gain_controlled,
    _in_a_room,
    _in_other_timbre,
    _others,
)
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
@given(
    st.integers(0, 2**32), st.lists(st.integers(LONGEST_CLICK_FRAMES, 600), min_size=1, max_size=5)
)
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


def mixer_of(calls: list[np.ndarray], noise: Any = None) -> tuple[Mixer, Drawn]:
    """Return a mixer of calls, and a batch with all of them, the last of which is silent.

    Without noise, the receiver has none.
    """
    logarithms = np.concatenate([np.log(call + FLOOR) for call in calls]).astype(np.float16)
    lengths = np.array([len(call) for call in calls])
    begins = np.concatenate([[0], np.cumsum(lengths)[:-1]])
    noise = torch.zeros(2, 300, BINS) if noise is None else noise
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
    mixer, drawn = mixer_of([call, call])
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
    assert 0.0 < is_masked.mean() < 0.6


def test_a_silent_call_has_noise_alone_of_any_level() -> None:
    silence = np.zeros((200, BINS), np.float32)
    rng = np.random.default_rng(0)
    noise = torch.from_numpy(rng.exponential(1.0, (2, 300, BINS)).astype(np.float32))
    mixer, drawn = mixer_of([silence] * 2, noise)
    silent = replace(drawn, is_silent=torch.tensor([True, True]))
    features, _ = mixer.mix(silent, EASY, generator(0))
    assert features[0].std() > 0.3
    assert not torch.allclose(features[0], features[1], atol=0.1)
    quiet, drawn = mixer_of([silence] * 2)
    assert quiet.mix(drawn, EASY, generator(0))[0].abs().max() < 1e-3


@pytest.mark.parametrize(
    ("sound", "lowest_db", "highest_db"),
    [(CLEAR, 12.0, 35.0), (EASY, 12.0, 35.0), (ANY, -4.0, 40.0)],
)
def test_noise_has_the_ratios_of_a_batch(sound: Sound, lowest_db: float, highest_db: float) -> None:
    drawn = mixer_of([speech(60)] * 300)[1]
    mixer, _ = mixer_of([speech(60)] * 300, torch.ones(2, 300, BINS))
    power = mixer._noise_of(60, drawn, sound, _Chance(300, generator(1), torch.device("cpu")))
    noise = power[:-1].mean(dim=(1, 2)).numpy()
    ratios_db = 10.0 * np.log10(SPEECH_POWER / noise[noise > 0.0])
    assert lowest_db <= ratios_db.min() < lowest_db + 2.0
    assert highest_db - 3.0 < ratios_db.max() <= highest_db
    assert (noise == 0.0).mean() == pytest.approx(0.1 if sound.is_noisy else 0.0, abs=0.06)


def test_timbres_move_the_bands_and_tilt_them() -> None:
    log = torch.zeros(400, 5, BINS)
    log[:, :, 30] = 50.0
    chance = _Chance(400, generator(2), torch.device("cpu"))
    other = _in_other_timbre(log, torch.ones(400, dtype=torch.bool), ANY, chance)
    at = other.mean(dim=1).argmax(dim=1)
    assert at.float().std() > 1.0
    assert 24 <= at.min() < at.max() <= 37
    assert other[:, :, 60].std() > 0.3
    chance = _Chance(400, generator(2), torch.device("cpu"))
    assert torch.equal(_in_other_timbre(log, torch.zeros(400, dtype=torch.bool), ANY, chance), log)


def test_a_room_is_heard_behind_a_sound_and_falls_by_60_db_in_its_time() -> None:
    power = torch.zeros(300, 80, BINS)
    power[:, 10] = 1.0
    chance = _Chance(300, generator(3), torch.device("cpu"))
    heard = _in_a_room(power, torch.ones(300, dtype=torch.bool), ANY, chance)[:, :, 0]
    assert not heard[:, :10].any()
    in_room = heard[heard[:, 12] > 0.0]
    assert 0.2 < len(in_room) / 300 < 0.4
    ratios = in_room[:, 13:40] / in_room[:, 12:39]
    assert torch.allclose(ratios, ratios[:, :1].expand_as(ratios), atol=1e-3)
    slowest, fastest = float(ratios[:, 0].max()), float(ratios[:, 0].min())
    assert fastest >= 10.0 ** (-6.0 / 5.0) - 1e-3
    assert slowest <= 10.0 ** (-6.0 / 40.0) + 1e-3
    assert (in_room[:, 11:].sum(dim=1) <= 1.0).all()


def test_another_call_is_far_beneath_some() -> None:
    power = torch.ones(500, 3, BINS) * torch.arange(1, 501)[:, None, None]
    chance = _Chance(500, generator(4), torch.device("cpu"))
    others = _others(power, torch.ones(500, dtype=torch.bool), ANY, chance)
    is_heard = others[:, 0, 0] > 0.0
    assert 0.02 < is_heard.float().mean() < 0.12
    assert (others[1:][is_heard[1:]] / power[:-1][is_heard[1:]]).max() < 10.0**-1.19


def test_a_gain_control_makes_what_is_loud_quieter() -> None:
    power = torch.ones(200, 200, BINS) * 1e-3
    power[:, 100:] = 1.0
    is_own = torch.ones(200, 200, dtype=torch.bool)
    chance = _Chance(200, generator(5), torch.device("cpu"))
    heard = _gain_controlled(power, is_own, torch.ones(200, dtype=torch.bool), ANY, chance)
    step = heard[:, 190, 0] / heard[:, 90, 0]
    is_controlled = step < 999.0
    assert 0.6 < is_controlled.float().mean() < 0.8
    assert (step[is_controlled] < 500.0).all()
    assert torch.allclose(step[~is_controlled], torch.tensor(1e3), rtol=1e-3)


def test_frames_behind_a_call_are_empty() -> None:
    mixer, drawn = mixer_of([speech(100), speech(300, 1), speech(120, 2)])
    features, lengths = mixer.mix(drawn, ANY, generator(5))
    for row, length in enumerate(lengths.tolist()):
        assert not features[row, length:].any()
        assert features[row, :length].any()
