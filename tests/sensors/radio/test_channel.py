"""The VHF channel does to speech what it says."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio, from_pcm
from airhilt.errors import SpeechError
from airhilt.scenario.models import Radio
from airhilt.scenario.radio_profiles import PROFILES
from airhilt.sensors.radio.backends import SoundRequest
from airhilt.sensors.radio.backends.audio import AudioRadio
from airhilt.sensors.radio.channel import (
    WHISTLES_HZ,
    Other,
    VhfChannel,
    active,
    with_voice,
)
from airhilt.sensors.radio.on_air import BackgroundNoise, OnAir, Utterance
from airhilt.voices.engines.espeak import Espeak


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


def test_the_same_seed_gives_the_same_samples_and_another_seed_others() -> None:
    channel = VhfChannel(PROFILES["vhf"])
    said = speech()
    once, again, other = (
        channel.transmit(said, 5.0, np.random.default_rng(seed), (), "cockpit")
        for seed in (1, 1, 2)
    )
    assert once.tobytes() == again.tobytes()
    assert once.tobytes() != other.tobytes()


# --- what is heard ------------------------------------------------------------------------------


def detected(
    profile: str, said: Audio, snr_db: float | None = None, background: BackgroundNoise = "none"
) -> Audio:
    """Return what `transmit` gives out, without gain control and tail, and its limiter undone."""
    plain = replace(PROFILES[profile], gain_control=0.0, squelch_tail_s=0.0)
    heard = VhfChannel(plain).transmit(said, snr_db, np.random.default_rng(3), (), background)
    return np.asarray(np.arctanh(2.0 * heard) / 2.0, np.float32)


@pytest.mark.parametrize("profile", [name for name in PROFILES if name != "monitor"])
@pytest.mark.parametrize("snr_db", [0.0, 10.0, 20.0])
def test_the_noise_that_is_heard_is_what_was_asked_for(profile: str, snr_db: float) -> None:
    clean = detected(profile, speech())
    noise = detected(profile, speech(), snr_db) - clean
    talking = active(speech())
    ratio_db = decibels(power(clean[talking]) / power(noise[talking]))
    assert ratio_db == pytest.approx(snr_db, abs=0.1)


def swing_db(profile: str) -> float:
    """Return by how much the level of a steady buzz changes within ten seconds."""
    t = np.arange(10 * SAMPLE_RATE_HZ) / SAMPLE_RATE_HZ
    heard = detected(profile, (0.1 * np.sin(2 * np.pi * 700 * t)).astype(np.float32))
    levels = [power(second) for second in np.split(heard[SAMPLE_RATE_HZ // 2 :], 19)]
    return decibels(max(levels) / min(levels))


def test_speech_fades_where_it_is_to_and_nowhere_else() -> None:
    assert swing_db("fading") > 4.0
    assert swing_db("vhf") < 0.1


def test_a_cockpit_is_heard_in_the_pauses_a_tower_less_and_a_quiet_place_not_at_all() -> None:
    talking = active(speech())
    pauses = ~talking
    pauses[np.flatnonzero(talking)[-1] :] = False
    pauses &= np.convolve(talking, np.ones(1_600), "same") < 0.5

    def below_speech_db(profile: str, background: BackgroundNoise) -> float:
        heard = detected(profile, speech(), None, background)
        return decibels(power(heard[pauses]) / power(heard[talking]))

    # The band and the limiter take 3 to 6 dB off this buzz, and then it is levelled again.
    assert below_speech_db("vhf", "cockpit") == pytest.approx(-28.0 + 4.5, abs=2.0)
    assert below_speech_db("vhf", "tower") == pytest.approx(-40.0 + 4.5, abs=2.0)
    assert below_speech_db("noisy_cockpit", "cockpit") == pytest.approx(-15.0 + 4.5, abs=2.0)
    assert below_speech_db("vhf", "none") < -50.0


def test_a_monitor_hears_the_radio_and_over_it_the_voice_itself() -> None:
    radio, monitor = (
        VhfChannel(PROFILES[name]).transmit(speech(), 10.0, np.random.default_rng(0))
        for name in ("vhf", "monitor")
    )
    directly = (monitor - 0.7 * radio)[: len(speech())]
    voice = speech() * np.float32(0.1 / np.sqrt(power(speech()[active(speech())])))
    assert directly == pytest.approx(0.3 * voice, abs=1e-3)


# --- two at once --------------------------------------------------------------------------------


def beside(seconds: float, begin: int = 0, whistle_hz: float = 800.0) -> Other:
    """Return a carrier without words."""
    return Other(np.zeros(round(seconds * SAMPLE_RATE_HZ), np.float32), begin, whistle_hz)


def test_who_talks_at_the_same_time_is_heard_from_where_he_begins() -> None:
    channel = VhfChannel(PROFILES["vhf"])
    theirs = Other(speech(1.0, seed=2), SAMPLE_RATE_HZ, 800.0)
    parts = channel.parts(speech(seed=1), None, np.random.default_rng(0), [theirs])
    assert not parts.interference[:SAMPLE_RATE_HZ].any()
    covered = slice(SAMPLE_RATE_HZ, 2 * SAMPLE_RATE_HZ)
    assert decibels(power(parts.interference[covered]) / 0.1**2) > 6.0


@pytest.mark.parametrize("whistle_hz", [400.0, 800.0, 1_200.0])
def test_two_carriers_beat_far_louder_than_speech_at_the_frequency_between_them(
    whistle_hz: float,
) -> None:
    channel = VhfChannel(PROFILES["vhf"])
    parts = channel.parts(
        speech(), None, np.random.default_rng(0), [beside(2.0, whistle_hz=whistle_hz)]
    )
    assert 6.0 < decibels(power(parts.interference) / 0.1**2) < 10.0
    spectrum = np.abs(np.fft.rfft(parts.interference))
    loudest_hz = np.fft.rfftfreq(len(parts.interference), 1 / SAMPLE_RATE_HZ)[spectrum.argmax()]
    assert loudest_hz == pytest.approx(whistle_hz, abs=1.0)
    clear = channel.transmit(speech(), 20.0, np.random.default_rng(0))
    under = channel.transmit(
        speech(), 20.0, np.random.default_rng(0), [beside(2.0, whistle_hz=whistle_hz)]
    )
    assert decibels(power(under) / power(clear)) > 3.0


def test_a_microphone_that_nobody_speaks_into_gives_the_noise_of_its_cockpit() -> None:
    channel = VhfChannel(PROFILES["vhf"])
    silence = np.zeros(4 * SAMPLE_RATE_HZ, np.float32)
    beat = channel.parts(silence, None, np.random.default_rng(0), [beside(4.0)]).interference
    spectrum = np.abs(np.fft.rfft(beat)) ** 2
    hz = np.fft.rfftfreq(len(beat), 1 / SAMPLE_RATE_HZ)
    tones = np.abs((hz + 400.0) % 800.0 - 400.0) < 5.0
    assert decibels(spectrum[~tones].sum() / spectrum[tones].sum()) > -15.0


def test_a_carrier_may_last_long_or_for_a_sample() -> None:
    channel = VhfChannel(PROFILES["vhf"])
    for other in (beside(600.0, -1_000), beside(2.0, -2 * SAMPLE_RATE_HZ + 1), beside(1.0, 99_999)):
        heard = channel.transmit(speech(), 20.0, np.random.default_rng(0), [other])
        assert np.isfinite(heard).all()
    alone = channel.transmit(beside(10.0).speech, 20.0, np.random.default_rng(0))
    assert np.isfinite(alone).all()


def test_two_that_block_each_other_whistle_alike_whichever_is_received() -> None:
    spoken = AudioRadio(Espeak(), VhfChannel(PROFILES["vhf"]), 5, Radio())

    def whistle_hz(said: OnAir, over: OnAir) -> float:
        request = SoundRequest(said, (over,), "none", 0, said.t_end_ns)
        heard = from_pcm(spoken.receive(request))
        spectrum = np.abs(np.fft.rfft(heard))
        return float(np.fft.rfftfreq(len(heard), 1 / SAMPLE_RATE_HZ)[spectrum.argmax()])

    first, second, third = (
        OnAir(Utterance(name, 118_000, name, None, ""), 0, 2_000_000_000, None)
        for name in ("first", "second", "third")
    )
    assert whistle_hz(first, second) == pytest.approx(whistle_hz(second, first), abs=1.0)
    assert whistle_hz(first, second) != pytest.approx(whistle_hz(first, third), abs=5.0)


def test_two_carriers_are_apart_by_what_their_transmitters_may_be_off() -> None:
    """Each by 5 parts in a million, at 120 MHz (ICAO Annex 10 volume III)."""
    assert WHISTLES_HZ[1] == pytest.approx(2.0 * 5e-6 * 120e6)
    assert 0.0 < WHISTLES_HZ[0] < WHISTLES_HZ[1]


def test_gain_control_leaves_a_call_at_its_usual_level_as_loud_as_it_is() -> None:
    steady = np.sin(2 * np.pi * 1000.0 * np.arange(4 * SAMPLE_RATE_HZ) / SAMPLE_RATE_HZ)
    with_control, without = (
        VhfChannel(replace(PROFILES["vhf"], gain_control=strength, fade_db=0.0))
        for strength in (0.9, 0.0)
    )
    settled = slice(2 * SAMPLE_RATE_HZ, 3 * SAMPLE_RATE_HZ)
    loud, plain = (
        channel.transmit(steady.astype(np.float32), None, np.random.default_rng(0))[settled]
        for channel in (with_control, without)
    )
    assert decibels(power(loud) / power(plain)) == pytest.approx(0.0, abs=0.5)


def test_a_call_may_have_another_share_of_the_channel_than_its_profile() -> None:
    channel, said = VhfChannel(PROFILES["vhf"]), speech()
    wet = channel.transmit(said, 0.0, np.random.default_rng(0))
    half = channel.transmit(said, 0.0, np.random.default_rng(0), wet=0.5)[: len(said)]
    dry = channel.transmit(said, 0.0, np.random.default_rng(0), wet=0.0)[: len(said)]
    assert np.corrcoef(dry, said)[0, 1] > 0.999
    assert np.allclose(half, 0.5 * wet[: len(said)] + 0.5 * dry, atol=1e-6)


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


# --- its parts ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("hz", "expected_db"),
    [(1_000.0, 0.0), (300.0, -3.01), (3_400.0, -3.01), (150.0, -36.1), (6_800.0, -36.1)],
)
def test_the_band_is_that_of_a_butterworth_filter_of_the_sixth_order(
    hz: float, expected_db: float
) -> None:
    """Half of the power at its edges, and 36 dB an octave beyond them, for noise that is heard."""
    parts = VhfChannel(PROFILES["vhf"]).parts(speech(20.0), 0.0, np.random.default_rng(0))
    spectrum = np.abs(np.fft.rfft(parts.noise)) ** 2
    at_hz = np.fft.rfftfreq(len(parts.noise), 1 / SAMPLE_RATE_HZ)

    def density(around_hz: float) -> float:
        return float(spectrum[np.abs(at_hz - around_hz) < 8.0].mean())

    assert decibels(density(hz) / density(1_000.0)) == pytest.approx(expected_db, abs=1.5)


def test_the_channel_delays_nothing() -> None:
    said, heard = speech(), detected("line", speech())
    lags = np.correlate(heard[4_000:20_000], said[4_000:20_000], "same")
    assert lags.argmax() == 8_000


@pytest.mark.parametrize(("background", "corner_hz"), [("cockpit", 400.0), ("tower", 900.0)])
def test_the_noise_around_a_microphone_is_low(
    background: BackgroundNoise, corner_hz: float
) -> None:
    """By 6 dB at its corner, and by 12 dB an octave beyond; a cockpit hums at 400 Hz besides."""
    silence = np.zeros(20 * SAMPLE_RATE_HZ, np.float32)
    line = VhfChannel(PROFILES["line"])
    noise = line.parts(silence, None, np.random.default_rng(4), (), background).signal
    spectrum = np.abs(np.fft.rfft(noise)) ** 2
    hz = np.fft.rfftfreq(len(noise), 1 / SAMPLE_RATE_HZ)

    def density_db(at_hz: float) -> float:
        around = (np.abs(hz - at_hz) < 40.0) & (np.abs(hz - 400.0) > 10.0)
        return decibels(float(spectrum[around].mean()))

    for octaves in (1.0, 2.0, 4.0):
        expected_db = -20.0 * np.log10((1.0 + octaves**2) / (1.0 + (200.0 / corner_hz) ** 2))
        loss_db = density_db(octaves * corner_hz) - density_db(200.0)
        assert loss_db == pytest.approx(expected_db, abs=1.2)
    hum = spectrum[np.abs(hz - 400.0) <= 6.0].sum() / spectrum.sum()
    assert (hum > 0.03) == (background == "cockpit")


@pytest.mark.parametrize(
    ("snr_db", "tail_rms"), [(None, 0.0316), (20.0, 0.0316), (10.0, 0.0562), (-15.0, 0.1)]
)
def test_the_squelch_tail_is_the_louder_the_more_noise_there_is(
    snr_db: float | None, tail_rms: float
) -> None:
    """By half of the ratio, from the level of speech on."""
    profile = replace(PROFILES["vhf"], squelch_tail_s=4.0, low_hz=1.0, high_hz=1e6)
    said = speech()
    heard = VhfChannel(profile).transmit(said, snr_db, np.random.default_rng(0))
    tail = heard[len(said) + 100 :]
    assert np.sqrt(power(tail)) == pytest.approx(tail_rms, rel=0.02)


@pytest.mark.parametrize("wet", [0.0, 0.25, 1.0])
def test_the_voice_is_mixed_at_its_usual_level(wet: float) -> None:
    said = speech()
    heard = np.full(len(said) + 50, 0.2, np.float32)
    mixed = with_voice(heard, said, wet)
    voice = said * np.float32(0.1 / np.sqrt(power(said[active(said)])))
    assert mixed[: len(said)] == pytest.approx(wet * 0.2 + (1.0 - wet) * voice, abs=1e-6)
    assert mixed[len(said) :] == pytest.approx([wet * 0.2] * 50)


def test_speech_is_active_where_its_frames_have_more_than_a_fortieth_of_its_power() -> None:
    """15.9 dB below active speech a pause begins (ITU-T P.56)."""
    frame = SAMPLE_RATE_HZ // 50
    loud, levels = [1.0] * 50, {0.17: True, 0.15: False, 0.0: False}
    for level, is_active in levels.items():
        said = np.repeat(np.array([*loud, level, *loud], np.float32), frame)
        found = active(said)
        assert found[::frame][50] == is_active
        assert found[: 50 * frame].all()
        assert found[51 * frame :].all()
    assert not active(np.zeros(1_000, np.float32)).any()
    assert len(active(np.ones(frame + 7, np.float32))) == frame + 7
