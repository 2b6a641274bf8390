"""The VHF channel does to speech what it says."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.errors import SpeechError
from airhilt.radio.channel import PROFILES, Channel, VhfChannel, active
from airhilt.radio.voices.engine import SAMPLE_RATE_HZ, Audio


@cache
def speech(seconds: float = 2.0, seed: int = 7) -> Audio:
    """Return something like syllables: a buzz that comes and goes, with pauses between words."""
    rng = np.random.default_rng(seed)
    t = np.arange(round(seconds * SAMPLE_RATE_HZ)) / SAMPLE_RATE_HZ
    buzz = sum(np.sin(2 * np.pi * 120 * k * t + k) / k for k in range(1, 40))
    syllables = np.clip(np.sin(2 * np.pi * 3.0 * t), 0.0, 1.0)
    words = np.repeat(rng.random(int(seconds * 2) + 1) > 0.25, SAMPLE_RATE_HZ // 2)[: len(t)]
    said = (0.2 * buzz * syllables * words).astype(np.float32)
    said.flags.writeable = False
    return said


def decibels(ratio: float) -> float:
    return 10.0 * float(np.log10(ratio))


def power(samples: Audio) -> float:
    return float(np.mean(np.square(samples, dtype=np.float64)))


def measured_snr_db(profile: str, snr_db: float, seed: int) -> float:
    """Return the ratio over active speech of what a receiver detects."""
    said = speech(1.5, seed % 3)
    parts = VhfChannel(PROFILES[profile]).parts(said, snr_db, np.random.default_rng(seed))
    talking = active(said)
    return decibels(power(parts.signal[talking]) / power(parts.noise[talking]))


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("snr_db", [-3.0, 0.0, 5.0, 10.0, 20.0, 30.0])
def test_the_noise_over_active_speech_is_what_was_asked_for(profile: str, snr_db: float) -> None:
    assert measured_snr_db(profile, snr_db, 1) == pytest.approx(snr_db, abs=0.5)


@settings(max_examples=10, deadline=None)
@given(st.sampled_from(list(PROFILES)), st.floats(-5.0, 40.0), st.integers(0, 99))
def test_it_is_so_at_any_ratio_and_with_any_seed(profile: str, snr_db: float, seed: int) -> None:
    assert measured_snr_db(profile, snr_db, seed) == pytest.approx(snr_db, abs=0.5)


def test_the_same_seed_gives_the_same_samples_and_another_seed_others() -> None:
    channel: Channel = VhfChannel(PROFILES["vhf"])
    said = speech()
    once, again, other = (
        channel.transmit(said, 5.0, np.random.default_rng(seed), (), "cockpit")
        for seed in (1, 1, 2)
    )
    assert once.tobytes() == again.tobytes()
    assert once.tobytes() != other.tobytes()


@pytest.mark.parametrize(("profile", "high_hz"), [("vhf", 3_400.0), ("vhf_833", 2_500.0)])
def test_nothing_beyond_the_audio_band_comes_through(profile: str, high_hz: float) -> None:
    parts = VhfChannel(PROFILES[profile]).parts(speech(4.0), 0.0, np.random.default_rng(0))
    spectrum = np.abs(np.fft.rfft(parts.signal + parts.noise)) ** 2
    hz = np.fft.rfftfreq(len(parts.signal), 1 / SAMPLE_RATE_HZ)
    inside = spectrum[(hz > 400) & (hz < high_hz - 200)].mean()
    assert decibels(spectrum[hz > 1.5 * high_hz].mean() / inside) < -15
    assert decibels(spectrum[hz < 150].mean() / inside) < -15


def test_two_that_talk_at_once_are_both_covered_by_the_other_and_a_whistle() -> None:
    channel = VhfChannel(PROFILES["vhf"])
    ours, theirs = speech(seed=1), speech(1.0, seed=2)
    parts = channel.parts(ours, None, np.random.default_rng(0), [(theirs, SAMPLE_RATE_HZ)])
    assert power(parts.interference[: SAMPLE_RATE_HZ // 2]) == 0.0
    covered = slice(SAMPLE_RATE_HZ, 2 * SAMPLE_RATE_HZ)
    wanted = decibels(power(parts.signal[covered]) / power(parts.interference[covered]))
    assert wanted < 3.0


def test_a_stuck_button_is_a_whistle_to_the_others_however_long_it_is() -> None:
    channel = VhfChannel(PROFILES["vhf"])
    carrier = np.zeros(600 * SAMPLE_RATE_HZ, np.float32)
    heard = channel.transmit(speech(), 20.0, np.random.default_rng(0), [(carrier, -1_000)])
    assert np.isfinite(heard).all()
    alone = channel.transmit(carrier[: 10 * SAMPLE_RATE_HZ], 20.0, np.random.default_rng(0))
    assert np.isfinite(alone).all()


def test_gain_control_evens_out_a_weak_and_a_strong_half() -> None:
    rng = np.random.default_rng(0)
    uneven = speech(8.0).copy()
    uneven[: len(uneven) // 2] *= 0.2
    channel = VhfChannel(PROFILES["vhf"])
    before = channel.parts(uneven, None, rng).signal
    after = channel.transmit(uneven, None, rng)[: len(uneven)]

    def difference(samples: Audio) -> float:
        half = len(samples) // 2
        return decibels(power(samples[half:]) / power(samples[:half]))

    assert difference(after) < difference(before) - 4.0


def test_a_call_ends_with_the_squelch_tail() -> None:
    said = speech()
    heard = VhfChannel(PROFILES["vhf"]).transmit(said, 10.0, np.random.default_rng(0))
    assert len(heard) == len(said) + round(0.12 * SAMPLE_RATE_HZ)
    assert power(heard[len(said) :]) > 0.0


def test_a_wired_line_leaves_the_voice_nearly_as_it_was() -> None:
    said = speech()
    heard = VhfChannel(PROFILES["line"]).transmit(said, None, np.random.default_rng(0))
    assert np.corrcoef(said, heard)[0, 1] > 0.95


@pytest.mark.parametrize(
    ("bad", "says"),
    [
        (np.array([], np.float32), "mono samples"),
        (np.zeros((2, 10), np.float32), "mono samples"),
        (np.array([0.0, np.nan], np.float32), "NaN"),
        (np.array([0.0, np.inf], np.float32), "NaN"),
    ],
)
def test_what_is_no_audio_is_refused(bad: Audio, says: str) -> None:
    with pytest.raises(SpeechError, match=says):
        VhfChannel(PROFILES["vhf"]).transmit(bad, 10.0, np.random.default_rng(0))


def test_a_ratio_that_is_no_number_is_refused() -> None:
    with pytest.raises(SpeechError, match="no number"):
        VhfChannel(PROFILES["vhf"]).transmit(speech(), float("nan"), np.random.default_rng(0))
