"""Files that claim or take too much are refused before they are read."""

from __future__ import annotations

import os
import re
import struct
import tracemalloc
import zlib
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import zstandard
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import Chunk, Message

from airhilt.audio.wav import LARGEST_WAV_BYTES
from airhilt.configuration import read_configuration
from airhilt.errors import AirhiltError, RunFolderError
from airhilt.host import bounded_json
from airhilt.messages import Clock, Transmission
from airhilt.record import RunFolder, log_reader
from airhilt.record.audio import recorded_pcm
from airhilt.record.latency import LONGEST_STEP_BYTES, read_latencies
from airhilt.record.log import LogWriter
from airhilt.record.log_reader import CHUNK_HEAD, MAGIC, Gap, LogReader
from airhilt.record.manifest import problem_of
from airhilt.record.sweep_folder import SweepFolder
from sweep_tables import grid, write_sweep

MANY_VALUES = b"[" + b"0," * bounded_json.MOST_VALUES + b"0]"
ENDLESS = 1_000_000_000_000


def make_endless(path: Path) -> None:
    """Put a file of a terabyte, which takes no room, in the place of another."""
    path.unlink(missing_ok=True)
    path.touch()
    os.truncate(path, ENDLESS)


def make_many_values(path: Path) -> None:
    path.write_bytes(b'{"a": ' + MANY_VALUES + b"}")


TOO_MUCH = pytest.mark.parametrize(
    ("make", "answer"),
    [
        (make_endless, "has over 32,000,000 bytes"),
        (make_many_values, "found over 500,000 values"),
    ],
    ids=["bytes", "values"],
)


@TOO_MUCH
@pytest.mark.parametrize("name", ["run.json", "summary.json"])
def test_a_record_of_a_run_that_takes_too_much_is_refused(
    run_copy: Path, name: str, make: Callable[[Path], None], answer: str
) -> None:
    make(run_copy / name)
    folder = RunFolder.open(run_copy)
    with pytest.raises(RunFolderError, match=f"{re.escape(name)}: .*{answer}"):
        _ = folder.info(), folder.summary()


def test_a_command_names_a_record_that_takes_too_much(airhilt_command: Any, run_copy: Path) -> None:
    make_many_values(run_copy / "run.json")
    done = airhilt_command("report", run_copy)
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert "run.json: found over 500,000 values; expected fewer" in line


@TOO_MUCH
def test_a_plan_or_configuration_that_takes_too_much_is_refused(
    tmp_path: Path, make: Callable[[Path], None], answer: str
) -> None:
    make(tmp_path / "plan.json")
    with pytest.raises(AirhiltError, match=rf"plan\.json: .*{answer}"):
        read_configuration(tmp_path / "plan.json")


def test_latencies_with_a_line_without_end_are_refused(tmp_path: Path) -> None:
    make_endless(tmp_path / "latency.jsonl")
    with pytest.raises(RunFolderError, match=f"has a line of over {LONGEST_STEP_BYTES:,} bytes"):
        read_latencies(tmp_path / "latency.jsonl")


def test_sound_that_takes_too_much_is_refused(tmp_path: Path) -> None:
    (tmp_path / "audio").mkdir()
    make_endless(tmp_path / "audio" / "call.wav")
    call = Transmission.model_construct(id="call", frequency_khz=119_100, t_tx_ns=0, t_end_ns=0)
    with pytest.raises(RunFolderError, match=f"has over {LARGEST_WAV_BYTES:,} bytes"):
        recorded_pcm(tmp_path / "audio", call)


# --- tables of sweeps --------------------------------------------------------------------------


def rows_beyond_number() -> pa.Table:
    """Return a table that claims a billion rows, of which a file keeps one value."""
    return pa.table({f"column{n}": pa.nulls(1_000_000) for n in range(300)})


def long_text_in_each_row() -> pa.Table:
    """Return a table of 20 GB of text, of which a file keeps 100 kB."""
    texts = pa.array(["x" * 100_000])
    return pa.table({"key": pa.DictionaryArray.from_arrays(np.zeros(200_000, np.int32), texts)})


def lists() -> pa.Table:
    return pa.table({"key": pa.array([["a"]])})


@pytest.mark.parametrize(
    ("make", "answer"),
    [
        (rows_beyond_number, "1,000,000 rows of 300 columns"),
        (long_text_in_each_row, "its texts have over 1,000,000,000 bytes"),
        (lists, "column key has the type list<element: string>"),
    ],
)
def test_a_table_that_claims_too_much_is_refused(
    tmp_path: Path, make: Callable[[], pa.Table], answer: str
) -> None:
    folder = write_sweep(tmp_path / "sweep", grid(["s01a_tight_timing"], ["reference"]))
    pq.write_table(make(), folder / "sweep.parquet", compression="zstd")
    with pytest.raises(AirhiltError, match=rf"sweep\.parquet: damaged \(.*{answer}"):
        SweepFolder.open(folder).table()


def test_a_table_of_texts_is_read_as_it_was_written(tmp_path: Path) -> None:
    folder = write_sweep(tmp_path / "sweep", grid(["s01a_tight_timing"], ["reference"]))
    written = pq.read_table(folder / "sweep.parquet")
    read = SweepFolder.open(folder).table()
    assert read.equals(written)
    assert read.schema.equals(written.schema, check_metadata=True)


def test_a_large_file_in_the_place_of_a_small_one_is_not_hashed(run_copy: Path) -> None:
    size_bytes = (run_copy / "summary.json").stat().st_size
    make_endless(run_copy / "summary.json")
    record = RunFolder(run_copy).info().files["summary.json"]
    assert problem_of(run_copy, "summary.json", record) == (
        f"summary.json: damaged or changed: it has {ENDLESS} bytes, and run.json says {size_bytes}"
    )


def test_broken_chunks_within_each_other_end_the_log_before_they_hold_its_reader(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each of them claims all that is behind it."""
    good = zstandard.compress(bytes(200))
    broken = good[:-1] + bytes([good[-1] ^ 1])
    step_bytes, count = 9 + CHUNK_HEAD.size + len(broken), 10_000
    parts = []
    for left in reversed(range(count)):
        claimed = len(broken) + step_bytes * left
        head = struct.pack("<QQQII4sQ", 0, 0, 200, zlib.crc32(bytes(200)), 4, b"zstd", claimed)
        parts.append(struct.pack("<BQ", Opcode.CHUNK, len(head) + claimed) + head + broken)
    path = tmp_path / "log.mcap"
    path.write_bytes(MAGIC + b"".join(parts))
    monkeypatch.setattr(log_reader, "LARGEST_CHUNK_BYTES", 1_000_000)
    monkeypatch.setattr(log_reader, "MOST_EXPANSION", 1)
    expanded: list[Any] = []

    def noted(part: Any) -> bytes:
        expanded.append(type(part))
        return zstandard.ZstdDecompressor().decompress(part)

    monkeypatch.setattr(zstandard, "decompress", noted)
    reader = LogReader(path)
    assert list(reader.messages()) == []
    assert reader.gaps == [Gap(0, None, None)]
    assert 0 < 200 * len(expanded) < path.stat().st_size + 1_001_000
    assert set(expanded) == {memoryview}  # Copies would take the square of the size.


@pytest.mark.parametrize("opcode", [Opcode.MESSAGE, 0x80])
def test_records_without_number_end_the_log_before_they_hold_its_reader(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, opcode: int
) -> None:
    """In each of two chunks, which are whole."""
    monkeypatch.setattr(log_reader, "LARGEST_CHUNK_BYTES", 4_000_000)
    handled: list[None] = []
    read = Message.read

    def counted(*given: Any) -> Any:
        handled.append(None)
        return read(*given)

    monkeypatch.setattr(Message, "read", counted)
    builder = RecordBuilder()
    records = struct.pack("<BQ22x", opcode, 22) * 100_000
    Chunk("zstd", zstandard.compress(records), 0, 0, zlib.crc32(records), len(records)).write(
        builder
    )
    path = tmp_path / "log.mcap"
    path.write_bytes(MAGIC + 2 * builder.end())  # type: ignore[no-untyped-call]
    reader = LogReader(path)
    tracemalloc.start()
    assert list(reader.messages()) == []
    _, peak_bytes = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert reader.gaps == [Gap(0, None, None)]
    assert len(handled) < path.stat().st_size + 4_000
    assert peak_bytes < 5_000_000


@pytest.mark.parametrize("claimed_bytes", [200, 1_000_000_000_000])
def test_a_chunk_that_expands_beyond_its_limit_is_damaged_and_not_expanded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, claimed_bytes: int
) -> None:
    monkeypatch.setattr(log_reader, "LARGEST_CHUNK_BYTES", 1_000_000)
    records = bytes(50_000_000)
    builder = RecordBuilder()
    data = zstandard.compress(records)
    Chunk("zstd", data, 0, 0, zlib.crc32(records), claimed_bytes).write(builder)
    del records
    path = tmp_path / "log.mcap"
    path.write_bytes(MAGIC + builder.end())  # type: ignore[no-untyped-call]
    tracemalloc.start()
    reader = LogReader(path)
    assert list(reader.messages()) == []
    _, peak_bytes = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert reader.gaps == [Gap(0, None, None)]
    assert peak_bytes < 10_000_000


def test_a_log_that_a_program_has_flooded_with_one_text_is_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(log_reader, "LARGEST_CHUNK_BYTES", 5_000_000)
    monkeypatch.setattr(log_reader, "MOST_EXPANSION", 1)
    path = tmp_path / "log.mcap"
    with closing(LogWriter(path)) as log:
        for number in range(100):
            log.write("vision/tower", "a program", Clock, number, b"x" * 100_000)
    assert path.stat().st_size < 1_000_000
    reader = LogReader(path)
    assert len(list(reader.messages())) == 100
    assert reader.is_faultless()
