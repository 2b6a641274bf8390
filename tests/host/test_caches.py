"""The cache: made once, shared by processes, never trusted blindly, and never in the way."""

from __future__ import annotations

import json
import multiprocessing
import os
from pathlib import Path
from typing import Any

import pytest

from airhilt.cosim.recorded import Recorded
from airhilt.cosim.setup import Setup
from airhilt.errors import AirhiltError
from airhilt.host.caches import (
    DEFAULT_LIMIT_MB,
    CacheFolder,
    cache_folder,
    cache_limit_bytes,
    clear,
    usage,
    write_problem,
)
from airhilt.options import Options
from airhilt.scenario import Scenario
from racing import CONTENT_BYTES, race


class Made:
    """Makes contents, and counts how often."""

    def __init__(self, content: bytes = b"content") -> None:
        self.times = 0
        self._content = content

    def __call__(self) -> bytes:
        self.times += 1
        return self._content


def entries(base: Path) -> list[Path]:
    return [path for path in base.rglob("*") if path.is_file()]


def test_an_entry_is_made_once_for_all(tmp_path: Path) -> None:
    first, again, other = Made(), Made(b"never"), Made(b"other")
    assert CacheFolder("voices", tmp_path).get("key", first) == b"content"
    assert CacheFolder("voices", tmp_path).get("key", again) == b"content"
    assert CacheFolder("voices", tmp_path).get("another key", other) == b"other"
    assert CacheFolder("aircraft", tmp_path).get("key", other) == b"other"
    assert (first.times, again.times, other.times) == (1, 0, 2)


@pytest.mark.parametrize("damage", [b"", "one byte"])
def test_a_damaged_entry_is_made_anew(damage: bytes | str, tmp_path: Path) -> None:
    made, cache = Made(b"0123456789" * 50), CacheFolder("voices", tmp_path)
    content = cache.get("key", made)
    (path,) = entries(tmp_path)
    data = bytearray(path.read_bytes())
    data[200] ^= 1
    path.write_bytes(damage if isinstance(damage, bytes) else data)
    assert cache.get("key", made) == content
    assert cache.get("key", made) == content
    assert made.times == 2


def test_processes_that_race_for_one_entry_end_with_one_good_entry(tmp_path: Path) -> None:
    context = multiprocessing.get_context("spawn")
    start = context.Barrier(3)
    racers = [context.Process(target=race, args=(tmp_path, start, n)) for n in range(3)]
    for racer in racers:
        racer.start()
    for racer in racers:
        racer.join()
    assert [racer.exitcode for racer in racers] == [0, 0, 0]
    assert len(entries(tmp_path)) == 1
    never = Made(b"never")
    assert len(CacheFolder("voices", tmp_path).get("key", never)) == CONTENT_BYTES
    assert never.times == 0


def test_the_entries_used_longest_ago_go_first_whatever_their_kind(tmp_path: Path) -> None:
    for n, (kind, key) in enumerate((("voices", "a"), ("aircraft", "b"), ("voices", "c"))):
        CacheFolder(kind, tmp_path).get(key, Made(bytes(900)))
        for path in entries(tmp_path):
            os.utime(path, (path.stat().st_atime, path.stat().st_mtime - 100 * (3 - n)))
    CacheFolder("voices", tmp_path).get("a", Made(b"never"))
    limited = CacheFolder("voices", tmp_path, limit_bytes=3_000)
    limited.get("d", Made(bytes(900)))
    a, b, c = Made(), Made(), Made()
    limited.get("a", a)
    limited.get("c", c)
    limited.get("d", Made(b"never"))
    CacheFolder("aircraft", tmp_path, limit_bytes=0).get("b", b)
    assert (a.times, b.times, c.times) == (0, 1, 0)


def test_a_process_that_writes_on_and_on_stays_within_the_limit(tmp_path: Path) -> None:
    cache = CacheFolder("voices", tmp_path, limit_bytes=10_000)
    for n in range(40):
        cache.get(f"key {n}", Made(bytes(900)))
    assert sum(path.stat().st_size for path in entries(tmp_path)) <= 10_500


def test_what_is_larger_than_the_limit_is_not_kept_and_pushes_nothing_out(tmp_path: Path) -> None:
    CacheFolder("voices", tmp_path, limit_bytes=1_000).get("small", Made(bytes(500)))
    CacheFolder("voices", tmp_path, limit_bytes=1_000).get("large", Made(bytes(1_000)))
    CacheFolder("voices", tmp_path, limit_bytes=0).get("none", Made(b""))
    assert [each.files for each in usage(tmp_path) if each.kind == "voices"] == [1]


def test_a_cache_that_cannot_be_written_costs_only_time(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    made, cache = Made(), CacheFolder("voices", tmp_path / "file" / "airhilt")
    assert cache.get("key", made) == cache.get("key", made) == b"content"
    assert made.times == 2


def test_a_run_without_a_cache_says_so_once_and_goes_on(
    encounter: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    options = Options(out=tmp_path / "run")
    (told,) = Setup(encounter, options, Recorded()).notices
    assert told.startswith("the cache cannot be written, so that later runs make everything anew:")
    monkeypatch.setenv("AIRHILT_CACHE_LIMIT_MB", "0")
    assert not Setup(encounter, options, Recorded()).notices


def test_the_cache_is_where_the_user_has_theirs_if_they_have_a_home(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def no_home() -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setenv("XDG_CACHE_HOME", "/var/my-cache")
    assert cache_folder() == Path("/var/my-cache/airhilt")
    monkeypatch.setenv("XDG_CACHE_HOME", "")
    monkeypatch.setenv("HOME", "/home/her")
    assert cache_folder() == Path("/home/her/.cache/airhilt")
    monkeypatch.setattr(Path, "home", no_home)
    assert write_problem(cache_folder())
    assert CacheFolder("voices").get("key", Made()) == b"content"


@pytest.mark.parametrize(
    ("text", "size"), [("", 1e6 * DEFAULT_LIMIT_MB), ("0", 0), ("1.5", 1_500_000), ("-1", 0)]
)
def test_the_environment_sets_the_limit(
    text: str, size: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("AIRHILT_CACHE_LIMIT_MB", text)
    assert cache_limit_bytes() == size


@pytest.mark.parametrize("text", ["1 GB", "nan"])
def test_a_limit_that_is_no_number_is_named(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("AIRHILT_CACHE_LIMIT_MB", text)
    with pytest.raises(AirhiltError, match=r"AIRHILT_CACHE_LIMIT_MB .*: expected a number of mega"):
        cache_limit_bytes()


def test_only_entries_are_deleted(tmp_path: Path) -> None:
    base, outside = tmp_path / "airhilt", tmp_path / "outside"
    for kind in ("voices", "aircraft"):
        CacheFolder(kind, base).get("key", Made())
    outside.write_text("mine")
    (base / "voices" / "notes.txt").write_text("mine")
    (base / "voices" / f"{'0' * 64}.entry").symlink_to(outside)
    (base / "voices" / f"{'1' * 64}.partial").write_text("of a process that was killed")
    assert [(each.kind, each.files) for each in clear(base, ("voices", "voices"))] == [
        ("voices", 2)
    ]
    assert {each.kind: each.files for each in usage(base) if each.files} == {"aircraft": 1}
    assert outside.read_text() == (base / "voices" / "notes.txt").read_text() == "mine"
    assert sum(each.files for each in clear(base)) == 1


def test_the_command_shows_and_clears(
    airhilt_command: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("AIRHILT_CACHE_LIMIT_MB", "100")
    CacheFolder("voices").get("key", Made(bytes(1_000_000 - 32)))
    shown = json.loads(airhilt_command("cache", "--json").stdout)
    assert (shown["folder"], shown["limit_mb"]) == (str(tmp_path / "airhilt"), 100.0)
    assert shown["kinds"][-1] == {"kind": "voices", "files": 1, "mb": 1.0}
    assert "at most 100 MB" in airhilt_command("cache").stdout
    wrong = airhilt_command("cache", "clear", "voice")
    assert (wrong.returncode, "did you mean 'voices'?" in wrong.stderr) == (2, True)
    assert airhilt_command("cache", "clear", "voices").returncode == 0
    assert json.loads(airhilt_command("cache", "--json").stdout)["kinds"][-1]["files"] == 0
