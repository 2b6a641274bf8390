"""Lines are synthesised once."""

from __future__ import annotations

import multiprocessing
import os
from pathlib import Path

import numpy as np
import pytest

from airhilt.voices.cache import CachedTts, user_cache_folder
from airhilt.voices.engine import VoiceSpec
from tone import Tone, say_lines

PILOT = VoiceSpec("pilot")


def test_a_line_is_synthesised_once_for_all_runs(tmp_path: Path) -> None:
    first, second = Tone(), Tone()
    said = CachedTts(first, tmp_path).synthesise("hello", PILOT)
    again = CachedTts(second, tmp_path).synthesise("hello", PILOT)
    assert said.tobytes() == again.tobytes()
    assert len(first.asked) == 1
    assert second.asked == []


def test_samples_are_the_same_with_and_without_a_cache(tmp_path: Path) -> None:
    cached = CachedTts(Tone(), tmp_path)
    first, second = (cached.synthesise("hello", PILOT) for _ in range(2))
    assert first.dtype == second.dtype == np.float32
    assert np.array_equal(first, second)


@pytest.mark.parametrize(
    ("text", "voice", "version"),
    [
        ("good bye", PILOT, "1"),
        ("hello", VoiceSpec("tower"), "1"),
        ("hello", VoiceSpec("pilot", rate=1.1), "1"),
        ("hello", VoiceSpec("pilot", pitch=1.1), "1"),
        ("hello", PILOT, "2"),
    ],
)
def test_another_line_voice_or_version_is_another_sound(
    text: str, voice: VoiceSpec, version: str, tmp_path: Path
) -> None:
    CachedTts(Tone(), tmp_path).synthesise("hello", PILOT)
    engine = Tone(version)
    CachedTts(engine, tmp_path).synthesise(text, voice)
    assert len(engine.asked) == 1


@pytest.mark.parametrize("damage", [b"", b"short", b"x" * 5_000])
def test_a_damaged_file_is_made_anew(damage: bytes, tmp_path: Path) -> None:
    engine = Tone()
    cached = CachedTts(engine, tmp_path)
    said = cached.synthesise("hello", PILOT)
    (path,) = tmp_path.iterdir()
    path.write_bytes(damage)
    assert np.array_equal(cached.synthesise("hello", PILOT), said)
    assert np.array_equal(cached.synthesise("hello", PILOT), said)
    assert len(engine.asked) == 2


def test_a_file_with_one_wrong_byte_is_made_anew(tmp_path: Path) -> None:
    cached = CachedTts(Tone(), tmp_path)
    said = cached.synthesise("hello", PILOT)
    (path,) = tmp_path.iterdir()
    data = bytearray(path.read_bytes())
    data[200] ^= 1
    path.write_bytes(data)
    assert np.array_equal(cached.synthesise("hello", PILOT), said)


def test_a_folder_that_cannot_be_written_costs_only_time(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    engine = Tone()
    cached = CachedTts(engine, tmp_path / "file" / "voices")
    assert np.array_equal(cached.synthesise("hello", PILOT), cached.synthesise("hello", PILOT))
    assert len(engine.asked) == 2


def test_what_was_used_longest_ago_goes_first(tmp_path: Path) -> None:
    cached = CachedTts(Tone(), tmp_path)
    for text in ("aaaaa", "bbbbb", "ccccc"):
        cached.synthesise(text, PILOT)
        for path in tmp_path.iterdir():
            stat = path.stat()
            os.utime(path, (stat.st_atime, stat.st_mtime - 100))
    cached.synthesise("aaaaa", PILOT)
    one_file = next(tmp_path.iterdir()).stat().st_size
    engine = Tone()
    smaller = CachedTts(engine, tmp_path, maximum_bytes=2 * one_file)
    assert len(list(tmp_path.iterdir())) == 2
    for text in ("aaaaa", "ccccc"):
        smaller.synthesise(text, PILOT)
    assert engine.asked == []
    smaller.synthesise("bbbbb", PILOT)
    assert len(engine.asked) == 1


def test_parallel_processes_share_it(tmp_path: Path) -> None:
    with multiprocessing.get_context("spawn").Pool(3) as pool:
        first, *others = pool.map(say_lines, [tmp_path] * 3)
    assert all(other == first for other in others)
    assert len(list(tmp_path.iterdir())) == 7


def test_the_cache_is_where_the_user_has_his(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", "/var/my-cache")
    assert user_cache_folder() == Path("/var/my-cache/airhilt/voices")
    monkeypatch.setenv("XDG_CACHE_HOME", "")
    monkeypatch.setenv("HOME", "/home/her")
    assert user_cache_folder() == Path("/home/her/.cache/airhilt/voices")


def test_a_line_said_again_and_again_is_synthesised_once(tmp_path: Path) -> None:
    engine = Tone()
    cached = CachedTts(engine, tmp_path)
    said = {cached.synthesise("words " * 80, PILOT).tobytes() for _ in range(20)}
    assert len(said) == 1
    assert len(engine.asked) == 1
