"""`airhilt export` writes what the frames and the sounds of a run have."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import airhilt
from airhilt.audio.wav import read_wav
from airhilt.errors import AirhiltError, SpeechError
from airhilt.export import export
from airhilt.report.frequency import read_frequency
from damage import flip
from engine_package import installed
from radio_folder import TOWER_KHZ, RadioFolder, busy_radio

PLAIN = """
def write(run, out):
    path = out / "calls.txt"
    path.write_text("\\n".join(run.calls()["text"]))
    return [path]


ENGINE = write
"""


def test_tables_of_parquet_are_the_frames(recorded_run: Path, tmp_path: Path) -> None:
    run = airhilt.open_run(recorded_run)
    files = export(run, "parquet", tmp_path / "tables")
    read = {path.stem: pd.read_parquet(path) for path in files}
    for name, frame in run.frames().items():
        pd.testing.assert_frame_equal(read[name], frame)
        assert read[name].attrs == frame.attrs


def test_tables_of_csv_are_the_frames(recorded_run: Path, tmp_path: Path) -> None:
    run = airhilt.open_run(recorded_run)
    files = {path.stem: path for path in export(run, "csv", tmp_path / "tables")}
    for name, frame in run.frames().items():
        kinds = {"t_s": "float64", **frame.dtypes.to_dict()}
        read = pd.read_csv(files[name], dtype=kinds, index_col="t_s")
        texts = frame.select_dtypes("str").columns
        expected = frame.assign(**{each: frame[each].replace("", None) for each in texts})
        pd.testing.assert_frame_equal(read, expected)


def test_the_sound_of_each_frequency_is_a_file_with_the_timing_of_the_run(tmp_path: Path) -> None:
    run = airhilt.open_run(busy_radio(tmp_path / "run"))
    wav, text = export(run, "wav", tmp_path / "sound")
    assert (wav.name, text.name) == (f"frequency-{TOWER_KHZ}.wav", f"frequency-{TOWER_KHZ}.txt")
    recording = read_frequency(run, TOWER_KHZ)
    expected = np.concatenate([*recording.sound.pieces()])
    assert np.allclose(read_wav(wav), expected, atol=1e-4)
    assert text.read_text() == recording.text()


def test_a_run_without_sound_leaves_no_folder(tmp_path: Path) -> None:
    run = airhilt.open_run(RadioFolder(tmp_path / "run").close())
    with pytest.raises(SpeechError, match="a run without sound"):
        export(run, "wav", tmp_path / "sound")
    assert not (tmp_path / "sound").exists()


def test_what_is_there_already_is_not_touched(tmp_path: Path) -> None:
    run = airhilt.open_run(RadioFolder(tmp_path / "run").close())
    taken = tmp_path / "tables"
    export(run, "csv", taken)
    (taken / "calls.csv").write_text("mine")
    for out in (taken, taken / "calls.csv"):
        with pytest.raises(AirhiltError, match="there already; delete it, or choose another"):
            export(run, "csv", out)
    assert (taken / "calls.csv").read_text() == "mine"


def test_a_package_adds_a_format(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = airhilt.open_run(busy_radio(tmp_path / "run"))
    with installed(tmp_path, monkeypatch, "airhilt.exports", "plain", PLAIN):
        (path,) = export(run, "plain", tmp_path / "out")
    assert "cleared to land" in path.read_text()


def test_the_command_names_what_is_damaged_and_writes_the_rest(
    airhilt_command: Any, run_copy: Path
) -> None:
    flip(run_copy / "log.mcap", 8 * 2500)
    done = airhilt_command("export", run_copy, "--to", "csv")
    assert done.returncode == 0, done.stderr
    assert f"airhilt: {run_copy}: log.mcap: damaged from" in done.stderr
    assert len(pd.read_csv(run_copy / "export" / "csv" / "states.csv")) > 10
    assert str(run_copy / "export" / "csv" / "states.csv") in done.stdout.splitlines()
    verified = airhilt_command("verify", run_copy).stdout
    assert "made from the run, and not checked: export/csv/adsb.csv" in verified


@pytest.mark.parametrize(
    ("folder", "name", "said"),
    [
        ("run", "kml2", "no export format named 'kml2'; expected one of csv, "),
        ("nothing", "csv", "no run here; expected a folder with a run.json"),
    ],
)
def test_a_mistake_is_one_line(
    airhilt_command: Any, tmp_path: Path, folder: str, name: str, said: str
) -> None:
    RadioFolder(tmp_path / "run").close()
    done = airhilt_command("export", tmp_path / folder, "--to", name)
    assert (done.returncode, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert said in line
