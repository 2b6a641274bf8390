"""A damaged log is named, with its times, and never gives a message that the run did not write."""

from __future__ import annotations

import json
import random
import re
from collections.abc import Callable
from pathlib import Path

import pytest

import airhilt
from airhilt.errors import RunFolderError
from airhilt.messages import Clock
from airhilt.record import Logged, LogWriter, Run, RunFolder, open_run, read_log
from airhilt.units import SECOND_NS
from damage import chunks, flip, kill

FLIPS = 200
SPAN = re.compile(r"from ([\d.]+) s to (?:([\d.]+) s|its end)")


def messages(folder: Path) -> list[Logged]:
    return list(quiet(folder).log())


def quiet(folder: Path) -> Run:
    return open_run(folder, lambda _: None)


def seconds_of(line: str) -> list[tuple[float, float]]:
    return [(float(begin), float(end or "inf")) for begin, end in SPAN.findall(line)]


def assert_named_or_harmless(before: list[Logged], damaged: Run) -> None:
    """What is left is what the run wrote, and what is not there lies within what is named."""
    left = list(damaged.log())
    by_sequence = {message.sequence: message for message in before}
    assert all(by_sequence[message.sequence] == message for message in left)
    assert left == sorted(left, key=lambda message: message.sequence)
    missing = by_sequence.keys() - {message.sequence for message in left}
    lines = [line for line in damaged.damage if line.startswith("log.mcap")]
    if missing:
        (line,) = lines
        for sequence in missing:
            t_s = by_sequence[sequence].t_ns / SECOND_NS
            spans = seconds_of(line)
            assert any(begin - 1e-3 <= t_s <= end + 1e-3 for begin, end in spans), (t_s, line)
        (said,) = re.findall(r"(\d+) messages? (?:is|are) missing", line) or [None]
        assert said is None or int(said) == len(missing)


# --- flips ----------------------------------------------------------------------------------


def test_every_flipped_bit_of_a_finished_run_is_named_and_changes_no_message(
    run_copy: Path,
) -> None:
    log = run_copy / "log.mcap"
    whole, before = log.read_bytes(), messages(run_copy)
    assert not quiet(run_copy).damage
    draw = random.Random(20)
    for _ in range(FLIPS):
        flip(log, draw.randrange(8 * len(whole)))
        damaged = quiet(run_copy)
        (line,) = damaged.damage
        assert line.startswith("log.mcap: damaged")
        assert_named_or_harmless(before, damaged)
        log.write_bytes(whole)


def test_a_flipped_bit_of_a_killed_run_is_named_or_changes_no_message(run_copy: Path) -> None:
    kill(run_copy)
    log = run_copy / "log.mcap"
    whole, before = log.read_bytes(), messages(run_copy)
    assert not quiet(run_copy).damage
    draw = random.Random(21)
    for _ in range(FLIPS):
        flip(log, draw.randrange(8 * len(whole)))
        damaged = quiet(run_copy)
        if len(list(damaged.log())) < len(before) and damaged.damage:
            assert_named_or_harmless(before, damaged)
        else:  # What the file may have ended with is not known: a prefix is all there is.
            left = list(damaged.log())
            assert left == before[: len(left)]
        log.write_bytes(whole)


def test_each_bit_of_the_fields_of_a_chunk_costs_its_second_at_most(run_copy: Path) -> None:
    log = run_copy / "log.mcap"
    before, data = messages(run_copy), log.read_bytes()
    third = chunks(data)[2]
    for bit in range(8 * -9, 8 * 44):
        flip(log, 8 * third + bit)
        damaged = quiet(run_copy)
        assert_named_or_harmless(before, damaged)
        for begin_s, end_s in seconds_of(damaged.damage[0]):
            assert (begin_s, end_s) == (pytest.approx(2.0, abs=0.3), pytest.approx(3.0, abs=0.3))
        log.write_bytes(data)


def test_damage_after_the_last_message_is_said_to_be_outside_of_the_messages(
    run_copy: Path,
) -> None:
    """The index has the name of the compression too, by which chunks are found."""
    log = RunFolder(run_copy).log_path
    rewritten = LogWriter(log)
    for second in range(50):
        for key in ("one", "two", "three", "four"):
            rewritten.write(key, "run", Clock, second * SECOND_NS, b"{}")
        rewritten.flush()
    rewritten.close()
    whole, before = log.read_bytes(), messages(run_copy)
    for back in range(3, 2_000, 100):
        flip(log, 8 * (len(whole) - back))
        damaged = quiet(run_copy)
        assert damaged.damage == (
            "log.mcap: damaged outside of its messages, all of which are read",
        )
        assert list(damaged.log()) == before
        log.write_bytes(whole)


def test_a_damaged_first_chunk_costs_no_later_message(run_copy: Path) -> None:
    """The first chunk alone says what the channels of the others are."""
    log = run_copy / "log.mcap"
    before, data = messages(run_copy), log.read_bytes()
    flip(log, 8 * (chunks(data)[0] + 80))
    left = messages(run_copy)
    assert left == before[-len(left) :]
    assert left[0].t_ns <= 1.2 * SECOND_NS


# --- truncated, replaced, missing -----------------------------------------------------------


DAMAGES: dict[str, Callable[[bytearray, slice, random.Random], None]] = {
    "zeros": lambda data, part, _: data.__setitem__(part, bytes(len(data[part]))),
    "noise": lambda data, part, draw: data.__setitem__(part, draw.randbytes(len(data[part]))),
    "a cut": lambda data, part, _: data.__delitem__(part),
    "an insertion": lambda data, part, draw: data.__setitem__(
        slice(part.start, part.start), draw.randbytes(len(data[part]))
    ),
    "a part twice": lambda data, part, _: data.__setitem__(
        slice(part.start, part.start), data[part]
    ),
}


@pytest.mark.parametrize("is_killed", [False, True])
@pytest.mark.parametrize("damage", DAMAGES)
def test_larger_damage_gives_messages_of_the_run_in_order_and_is_named(
    run_copy: Path, damage: str, is_killed: bool
) -> None:
    if is_killed:
        kill(run_copy)
    log = run_copy / "log.mcap"
    whole, before = log.read_bytes(), messages(run_copy)
    draw = random.Random(damage)
    for _ in range(12):
        data = bytearray(whole)
        begin = draw.randrange(8, len(data) - 1)
        DAMAGES[damage](data, slice(begin, begin + draw.choice([10, 512, 20_000])), draw)
        log.write_bytes(data)
        damaged = quiet(run_copy)
        if is_killed and not damaged.damage:
            try:
                left = list(damaged.log())
            except RunFolderError:
                continue  # Nothing of it can be read.
            assert left == before[: len(left)]
        else:
            assert_named_or_harmless(before, damaged)
            assert damaged.log_damage


@pytest.mark.parametrize("share", [0.3, 0.8, 1.0])
def test_a_truncated_log_of_a_finished_run_says_from_when_on(run_copy: Path, share: float) -> None:
    log = run_copy / "log.mcap"
    before, data = messages(run_copy), log.read_bytes()
    log.write_bytes(data[: int(share * chunks(data)[-1])])
    damaged = quiet(run_copy)
    left = list(damaged.log())
    assert left == before[: len(left)]
    ((begin_s, end_s),) = seconds_of(damaged.damage[0])
    assert begin_s == pytest.approx(left[-1].t_ns / SECOND_NS, abs=1e-3)
    assert end_s == float("inf")


def test_a_file_of_another_kind_is_no_log(tmp_path: Path) -> None:
    path = tmp_path / "log.mcap"
    path.write_bytes(b"plain text")
    with pytest.raises(RunFolderError, match=r"log\.mcap: not an MCAP log: it has not the magic"):
        list(read_log(path))


def test_another_log_in_its_place_is_named(run_copy: Path) -> None:
    log = LogWriter(run_copy / "log.mcap")
    log.write("clock", "run", Clock, 0, b"{}")
    log.close()
    (line,) = quiet(run_copy).damage
    assert line.startswith("log.mcap: changed after the run")


def test_many_damaged_places_are_one_line(run_copy: Path) -> None:
    log = run_copy / "log.mcap"
    before, data = messages(run_copy), log.read_bytes()
    for begin in chunks(data)[1::2]:
        flip(log, 8 * (begin + 80))
    damaged = quiet(run_copy)
    (line,) = damaged.damage
    assert "in 4 places from 1." in line
    assert "\n" not in line
    assert_named_or_harmless(before, damaged)


# --- who is told ----------------------------------------------------------------------------


def test_python_warns_of_what_is_damaged_and_gives_the_rest(run_copy: Path) -> None:
    flip(run_copy / "log.mcap", 8 * 2000)
    with pytest.warns(UserWarning, match=r"log\.mcap: damaged from .* s to .* s: \d+ messages"):
        run = airhilt.open_run(run_copy)
    assert list(run.log())
    assert run.info.phase == "finished"


def test_a_log_that_is_read_alone_fails_where_messages_are_missing(run_copy: Path) -> None:
    flip(run_copy / "log.mcap", 8 * 2000)
    with pytest.raises(RunFolderError, match=r"log\.mcap: damaged from"):
        list(read_log(run_copy / "log.mcap"))


def test_a_changed_record_of_the_run_is_named(run_copy: Path) -> None:
    path = run_copy / "run.json"
    document = json.loads(path.read_text())
    document["options"]["seed"] = 7
    path.write_text(json.dumps(document))
    assert quiet(run_copy).damage == ("run.json: damaged or changed: not what its digest says",)


def test_a_changed_sound_is_named_when_all_files_are_asked_for(run_copy: Path) -> None:
    folder = RunFolder(run_copy)
    sound = run_copy / "audio" / "call-1.wav"
    sound.parent.mkdir(exist_ok=True)
    sound.write_bytes(b"heard")
    folder.write_info(folder.info().model_copy(update={"files": folder.manifest()}))
    assert quiet(run_copy).damage_of_all_files() == ()
    sound.write_bytes(b"other")
    assert quiet(run_copy).damage == ()
    (line,) = quiet(run_copy).damage_of_all_files()
    assert line.startswith("audio/call-1.wav: damaged or changed")
