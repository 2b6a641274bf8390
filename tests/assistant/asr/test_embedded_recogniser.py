"""The recogniser that AIRHILT brings along: with a tiny network that is known, and with its own."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import jiwer
import numpy as np
import pytest

import airhilt.assistant.asr.engines.embedded
from airhilt.assistant.asr.confidences import WordCurve
from airhilt.assistant.asr.engines.embedded import FILES, Ctc, Emission
from airhilt.assistant.asr.features import BINS
from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.engine_families import RECOGNISERS
from airhilt.errors import SpeechError
from airhilt.scenario.radio_profiles import PROFILES
from airhilt.sensors.radio.channel import Other, VhfChannel
from airhilt.voices.engines.espeak import Espeak
from breadth import mostly_slow
from paths import DATA

TINY = DATA / "tiny_recogniser"
"""Made by tools/make/tiny_recogniser.py: each tone below is a word with a known posterior."""
ALFA_HZ, BRAVO_HZ, CHARLIE_HZ, DOUBTFUL_ALFA_HZ = 588.0, 1_202.0, 2_108.0, 3_446.0
TONE_S = 0.24


def silence(seconds: float) -> Audio:
    return np.zeros(round(seconds * SAMPLE_RATE_HZ), np.float32)


def noise(level: float, seconds: float = 5.0) -> Audio:
    rng = np.random.default_rng(0)
    return rng.standard_normal(len(silence(seconds)), np.float32) * np.float32(level)


def with_tones(audio: Audio, tones: Iterable[tuple[float, float]]) -> Audio:
    """Return audio with tones in it, each a frequency and the time at which its middle is."""
    audio = audio.copy()
    samples = round(TONE_S * SAMPLE_RATE_HZ)
    phase = 2.0 * np.pi * np.arange(samples) / SAMPLE_RATE_HZ
    for frequency_hz, middle_s in tones:
        begin = round((middle_s - TONE_S / 2.0) * SAMPLE_RATE_HZ)
        tone = 0.1 * np.hanning(samples) * np.sin(phase * frequency_hz)
        audio[begin : begin + samples] += tone.astype(np.float32)
    return audio


def call(*frequencies_hz: float) -> Audio:
    """Return tones one after the other, with pauses of half a second."""
    tones = [
        (frequency_hz, 0.75 * (place + 1)) for place, frequency_hz in enumerate(frequencies_hz)
    ]
    return with_tones(silence(0.75 * (len(tones) + 2)), tones)


def said_by(speaker: str, text: str) -> Audio:
    voices = Espeak()
    return voices.synthesise(text, voices.voice_of(speaker))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return Path(shutil.copytree(TINY, tmp_path / "model"))


def with_card(folder: Path, **changes: Any) -> Ctc:
    path = folder / "card.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | changes))
    return Ctc(folder)


# --- what a posterior is worth --------------------------------------------------------------------


# --- with a network that is known ---------------------------------------------------------------


def test_words_come_in_order_with_their_posteriors() -> None:
    heard = Ctc(TINY).recognise(call(BRAVO_HZ, ALFA_HZ, ALFA_HZ, CHARLIE_HZ), ())
    assert heard.text == "bravo alfa alfa charlie"
    assert [word for word, _ in heard.words] == heard.text.split()
    assert [sure for _, sure in heard.words] == pytest.approx([0.8, 0.9, 0.9, 0.95], abs=1e-4)
    assert heard.confidence == pytest.approx(0.8 * 0.9 * 0.9 * 0.95, abs=1e-3)


def test_the_confidence_of_a_word_counts_what_else_may_have_been_said(folder: Path) -> None:
    """All that is not in its posterior is in alternatives, which the language model has alike."""
    curve = {"posterior_slope": 0.0, "alternatives_slope": 2.0, "offset": -1.0}
    engine = with_card(folder, word_curve=curve)
    ((word, sure),) = engine.recognise(call(BRAVO_HZ), ()).words
    assert word == "bravo"
    assert sure == pytest.approx(WordCurve(**curve)(0.5, np.log(0.8 / 0.2)), abs=1e-3)


def test_a_callsign_of_the_roster_needs_no_calibration(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shy = {"posterior_slope": 1.0, "alternatives_slope": 0.0, "offset": -1.0}
    engine = with_card(folder, word_curve=shy)
    path = [Emission("climb", 0.9, 0), Emission("alfa", 0.9, 1, is_callsign=True)]
    monkeypatch.setattr(engine, "path", lambda *_: path)
    (_, climb), (_, alfa) = engine.recognise(call(BRAVO_HZ), ()).words
    assert climb == pytest.approx(WordCurve(**shy)(0.9, 0.0))
    assert alfa == pytest.approx(0.9)


def test_words_are_unsure_where_something_was_heard_between_them_that_is_not_written(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    curve = {"heard_slope": 2.0, "inserted_slope": 0.0, "offset": 0.0}
    engine = with_card(folder, lost_words=curve, least_word_confidence=0.0)
    steps = np.zeros((12, 4), np.float32)
    steps[[1, 9, 11], [2, 1, 3]] = 0.97
    steps[3:7, 3] = 0.4
    steps[:, 0] = 1.0 - steps[:, 1:].sum(axis=1)
    monkeypatch.setattr(engine, "posteriors", lambda _: steps)
    (_, bravo), (_, alfa), (_, charlie) = engine.recognise(call(BRAVO_HZ), ()).words
    assert bravo == alfa == pytest.approx(1.0 / (1.0 + (4 * 0.4 + 0.1) ** 2), abs=0.01)
    assert charlie == pytest.approx(0.97)


def test_a_word_that_is_too_unsure_is_left_out_and_makes_the_call_unsure(folder: Path) -> None:
    doubtful = call(BRAVO_HZ, DOUBTFUL_ALFA_HZ)
    assert Ctc(folder).recognise(doubtful, ()).text == "bravo alfa"
    strict = with_card(folder, least_word_confidence=0.7)
    heard = strict.recognise(doubtful, ())
    assert heard.text == "bravo"
    assert heard.confidence == pytest.approx(0.8 * 0.6, abs=1e-3)
    assert strict.recognise(call(DOUBTFUL_ALFA_HZ), ()).text == ""


@pytest.mark.parametrize(
    "audio",
    [silence(0.0), noise(0.1, 0.099), silence(0.2), silence(5.0), noise(1e-6), noise(0.1)],
    ids=["no audio", "99 ms", "a short silence", "silence", "faint noise", "noise"],
)
def test_where_nothing_is_said_nothing_is_heard(audio: Audio) -> None:
    heard = Ctc(TINY).recognise(audio, ())
    assert (heard.text, heard.words) == ("", ())
    assert heard.confidence > 0.5


# --- microphones that are stuck -----------------------------------------------------------------


@pytest.mark.parametrize("windows", mostly_slow([6, 20], 6))
def test_no_word_is_lost_or_doubled_where_windows_meet(windows: int) -> None:
    """They meet every 30 s. There, and 60 ms at a time around, a tone is on."""
    meets = [(CHARLIE_HZ, 30.0 * (k + 1) + 0.06 * (k % 5 - 2)) for k in range(windows - 1)]
    between = [(ALFA_HZ, 30.0 * k + 15.0) for k in range(windows)]
    heard = Ctc(TINY).recognise(with_tones(silence(30.0 * windows), meets + between), ())
    assert heard.text == "alfa charlie " * (windows - 1) + "alfa"


# --- model folders that are wrong ---------------------------------------------------------------


@pytest.mark.parametrize("name", FILES)
def test_a_missing_file_is_named(name: str, folder: Path) -> None:
    (folder / name).unlink()
    with pytest.raises(SpeechError, match=rf"{folder} lacks {name}; expected .*train_asr"):
        Ctc(folder)


@pytest.mark.parametrize("pieces", ["", "_alfa _bravo", "_alfa _bravo _charlie x", "\udcff" * 2])
def test_pieces_that_do_not_fit_the_network_are_refused(pieces: str, folder: Path) -> None:
    (folder / "pieces.txt").write_bytes(pieces.encode("utf-8", "surrogateescape"))
    with pytest.raises(
        SpeechError, match=r"does not fit together.*4 units.*one unit more than pieces"
    ):
        Ctc(folder)


@pytest.mark.parametrize(
    ("card", "wrong"),
    [
        ("", "Invalid JSON"),
        (
            '{"word_curve": {"posterior_slope": NaN, "alternatives_slope": 1, "offset": 0}}',
            "word_curve/posterior_slope",
        ),
        ('{"word_curve": {"posterior_slope": 1, "alternatives_slope": 1}}', "word_curve/offset"),
        ("\udcff", "Invalid JSON"),
    ],
)
def test_a_card_that_does_not_say_what_it_must_is_refused(
    card: str, wrong: str, folder: Path
) -> None:
    (folder / "card.json").write_bytes(card.encode("utf-8", "surrogateescape"))
    with pytest.raises(SpeechError, match=rf"card\.json is no model card: .*{wrong}"):
        Ctc(folder)


def test_a_language_model_that_is_damaged_is_refused(folder: Path) -> None:
    path = folder / "language.npz"
    path.write_bytes(path.read_bytes()[:200])
    with pytest.raises(SpeechError, match=r"language\.npz: no language model.*learn_language"):
        Ctc(folder)


def test_a_network_of_another_kind_is_refused(folder: Path) -> None:
    shutil.copy(DATA / "channels" / "echo.onnx", folder / "ctc.onnx")
    with pytest.raises(SpeechError, match=r"ctc\.onnx is of another kind.*expected a network of"):
        Ctc(folder)


def test_a_network_that_never_ends_is_stopped(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("onnx")
    from onnx import TensorProto

    from endless_networks import write_endless

    monkeypatch.setattr("airhilt.host.onnx.FIRST_LOOK_S", 0.3)
    write_endless(
        folder / "ctc.onnx",
        {"features": (TensorProto.FLOAT, ["n", "frames", BINS])},
        {"logits": ["n", 50, 4]},
    )
    with pytest.raises(SpeechError, match=r"ctc\.onnx .*does not end within 0\.3 s"):
        Ctc(folder)


def test_the_command_line_names_a_folder_of_ones_own(folder: Path) -> None:
    engine = RECOGNISERS.create(f"embedded:{folder}")
    assert engine.recognise(call(CHARLIE_HZ), ()).text == "charlie"


# --- the network that ships ---------------------------------------------------------------------


@pytest.fixture(scope="module")
def embedded() -> Ctc:
    return Ctc()


CALLS = [
    ("TOWER", "american one two three runway zero one left cleared to land"),
    ("AAL123", "delta four five six climb and maintain flight level three three zero"),
    ("DAL456", "washington tower american one two three holding short runway one niner"),
]


@pytest.mark.parametrize("snr_db", [None, 25.0])
def test_clear_calls_are_mostly_right(embedded: Ctc, snr_db: float | None) -> None:
    texts, heard = [], []
    for number, (speaker, text) in enumerate(CALLS):
        rng = np.random.default_rng(number)
        audio = VhfChannel(PROFILES["vhf"]).transmit(said_by(speaker, text), snr_db, rng)
        texts.append(text)
        heard.append(embedded.recognise(audio, ("AAL123", "DAL456")).text)
    assert jiwer.wer(texts, heard) < 0.3


@pytest.mark.parametrize("over", ["a carrier", "another voice"])
def test_of_blocked_calls_most_words_are_lost(embedded: Ctc, over: str) -> None:
    texts, heard = [], []
    for number, (speaker, text) in enumerate(CALLS):
        other = silence(20.0) if over == "a carrier" else said_by(*CALLS[number - 1])
        for whistle_hz in (400.0, 700.0, 1_200.0):
            audio = VhfChannel(PROFILES["vhf"]).transmit(
                said_by(speaker, text),
                20.0,
                np.random.default_rng(number),
                [Other(other, 0, whistle_hz)],
                "cockpit",
            )
            texts.append(text)
            heard.append(embedded.recognise(audio, ()).text)
    assert jiwer.wer(texts, heard) > 0.6


@pytest.mark.parametrize("level", [0.0, 1e-4, 0.01, 0.1, 0.5])
def test_noise_alone_gives_nothing(embedded: Ctc, level: float) -> None:
    receiver = VhfChannel(PROFILES["vhf"]).parts(silence(5.0), 0.0, np.random.default_rng(1))
    for sound in (noise(level), receiver.noise * np.float32(level / 0.1)):
        assert embedded.recognise(sound, ("AAL123", "DAL456")).text == ""


def test_windows_change_nothing(embedded: Ctc, monkeypatch: pytest.MonkeyPatch) -> None:
    spoken = said_by(*CALLS[0])
    audio = np.tile(np.concatenate([spoken, silence(0.5)]), 1 + 65 * SAMPLE_RATE_HZ // len(spoken))
    by_windows = embedded.posteriors(audio)
    monkeypatch.setattr(airhilt.assistant.asr.engines.embedded, "WINDOW_FRAMES", len(audio))
    assert np.abs(by_windows - embedded.posteriors(audio)).max() < 1e-4


def test_a_language_model_of_other_pieces_is_refused(folder: Path) -> None:
    np.savez(folder / "language.npz", keys1=np.arange(9, dtype=np.uint64),
             scores1=np.zeros(9), backoffs1=np.zeros(9))  # fmt: skip
    with pytest.raises(SpeechError, match="no language model of 4 units"):
        Ctc(folder)
