"""Files that claim or take too much are refused before they are read."""

from __future__ import annotations

import os
import re
import tracemalloc
import zlib
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import zstandard
from mcap.data_stream import RecordBuilder
from mcap.records import Chunk

from airhilt.audio.wav import LARGEST_WAV_BYTES
from airhilt.configuration import read_configuration
from airhilt.errors import AirhiltError, RunFolderError
from airhilt.host import bounded_json
from airhilt.messages import Clock, Transmission
from airhilt.record import RunFolder, log_reader
from airhilt.record.audio import recorded_pcm
from airhilt.record.latency import LONGEST_STEP_BYTES, read_latencies
from airhilt.record.log import LogWriter
from airhilt.record.log_reader import MAGIC, Gap, LogReader
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


def test_a_table_that_claims_too_much_is_refused(tmp_path: Path) -> None:
    folder = write_sweep(tmp_path / "sweep", grid(["s01a_tight_timing"], ["reference"]))
    pq.write_table(rows_beyond_number(), folder / "sweep.parquet", compression="zstd")
    with pytest.raises(AirhiltError, match=r"sweep\.parquet: damaged \(.*1,000,000 rows of 300"):
        SweepFolder.open(folder).table()


def test_a_large_file_in_the_place_of_a_small_one_is_not_hashed(run_copy: Path) -> None:
    size_bytes = (run_copy / "summary.json").stat().st_size
    make_endless(run_copy / "summary.json")
    record = RunFolder(run_copy).info().files["summary.json"]
    assert problem_of(run_copy, "summary.json", record) == (
        f"summary.json: damaged or changed: it has {ENDLESS} bytes, and run.json says {size_bytes}"
    )


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
    path = tmp_path / "log.mcap"
    with closing(LogWriter(path)) as log:
        for number in range(100):
            log.write("vision/tower", "a program", Clock, number, b"x" * 100_000)
    assert path.stat().st_size < 1_000_000
    reader = LogReader(path)
    assert len(list(reader.messages())) == 100
    assert reader.is_faultless()
