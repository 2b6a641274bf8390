"""The page of a sweep, as a file, and its figures."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from airhilt.errors import AirhiltError
from airhilt.metrics.measures import MISSED
from airhilt.record.manifest import digest, manifest
from airhilt.record.sweep_folder import SweepFolder
from airhilt.report.figures import Figures
from airhilt.report.sweeps import write_sweep_report
from airhilt.report.sweeps.axes import Level, axis_of, heat_map_axes
from airhilt.report.sweeps.data import SweepData, read_sweep_data
from airhilt.report.sweeps.sections import failures, heat_maps, overview, runs
from sweep_tables import Row, grid, sweep_row, write_sweep

HOSTILE = "</script><script>alert(1)</script><!-- $x_{1 --> & <b>"

LEFT_OUT = ("warned_in_time", "missed", "lost", "radio_wer", "first_detection_range_m")
"""Columns without which there are fewer figures to draw."""


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A sweep over SNR and visibility, with a name that is no good, and its page."""
    rows = grid(["s01a_tight_timing"], ["reference", HOSTILE], snrs=(0.0, 10.0), seeds=2,
                visibilities=(400.0, 10000.0))  # fmt: skip
    rows = [{name: row[name] for name in row if name not in LEFT_OUT} for row in rows]
    rows.append(failed("s01a_tight_timing", HOSTILE))
    ended = [{"key": "f" * 64, "status": "over_time", "cause": "took more than 600 s"}]
    folder = write_sweep(tmp_path_factory.mktemp("sweep") / "sweep", rows, ended)
    write_sweep_report(folder)
    return folder


def failed(scenario: str, cause: str) -> Row:
    row = sweep_row(scenario, "reference", 99, status="failed", cause=cause, snr_db=0.0)
    return {
        name: row[name] for name in row if name not in ("nominal", "duration_s", "nuisance_alerts")
    }


def read(folder: Path) -> SweepData:
    return read_sweep_data(SweepFolder.open(folder), folder / "report.html")


def test_runs_whose_cameras_left_exposures_out_are_told(tmp_path: Path) -> None:
    rows = [
        sweep_row("s02a_headon", "reference", seed, vision_exposures_left_out=seed)
        for seed in range(3)
    ]
    (note,) = small(tmp_path / "adaptive", rows).notes
    assert "in 2 of 3 runs" in note
    assert not small(tmp_path / "full", rows[:1]).notes


def small(folder: Path, rows: list[Row]) -> SweepData:
    return read(write_sweep(folder, rows))


def data_of(page: Path) -> dict[str, Any]:
    found = re.findall(
        r'<script type="application/json" id="sweep">(.*?)</script>', page.read_text(), re.DOTALL
    )
    assert len(found) == 1
    data: dict[str, Any] = json.loads(found[0])
    return data


def test_the_page_has_all_sections_and_says_of_nothing_that_it_is_missing(written: Path) -> None:
    data = data_of(written / "report.html")
    assert list(data["sections"]) == [
        "header", "overview", "ablation", "heat_maps", "curves", "runs", "failures", "origin",
    ]  # fmt: skip
    assert data["notes"] == []


def test_no_text_of_a_run_becomes_markup(written: Path) -> None:
    text = (written / "report.html").read_text()
    assert "<script>alert" not in text
    assert "<b>" not in text.replace("<b>16</b>", "").replace('<b class="bad">', "")


def test_each_figure_is_a_file_for_a_paper_and_stands_in_the_page(written: Path) -> None:
    data = data_of(written / "report.html")["sections"]
    text = (written / "report.html").read_text()
    for section in ("heat_maps", "curves", "ablation"):
        for figure in data[section]["figures"]:
            assert (written / figure["svg"]).read_bytes().startswith(b"<?xml")
            assert (written / figure["pdf"]).read_bytes().startswith(b"%PDF")
            assert f'data-figure="{figure["name"]}"' in text


def test_a_heat_map_counts_the_runs_of_each_cell(tmp_path: Path) -> None:
    rows = [
        sweep_row("s01a_x", "reference", seed, snr_db=snr, visibility_m=seen, missed=seed > 0)
        for snr in (0.0, 10.0)
        for seen in (400.0, 800.0)
        for seed in range(4)
    ]
    sweep = small(tmp_path / "sweep", rows)
    axes = heat_map_axes(sweep.axes())
    assert axes is not None
    cells = heat_maps._Cells(MISSED, axes, sweep.finished)
    assert cells.values.tolist() == [[75.0, 75.0], [75.0, 75.0]]
    assert cells.counts.tolist() == [[4, 4], [4, 4]]


def _series(values: list[Any]) -> Any:
    import pandas as pd

    return pd.Series(values)


def test_many_values_are_put_into_bins_that_hold_each_of_them_once() -> None:
    runs = _series([400.0 * 1.2**n for n in range(18)]).to_frame("visibility_m")
    axis = axis_of("visibility_m", runs["visibility_m"], "m")
    held = np.array([axis.among(runs, level) for level in axis.levels])
    assert held.sum(axis=1).tolist() == [3] * 6
    assert held.sum(axis=0).tolist() == [1] * 18


@pytest.mark.parametrize(
    ("values", "unit", "is_logarithmic"),
    [([400.0, 800.0, 1600.0, 5000.0], "m", True), ([100.0, 200.0, 300.0], "m", False),
     ([0.0, 10.0, 100.0], "m", False), ([1.0, 10.0, 100.0], "dB", False)],
)  # fmt: skip
def test_an_axis_is_logarithmic_where_its_levels_are(
    values: list[float], unit: str, is_logarithmic: bool
) -> None:
    assert axis_of("x", _series(values), unit).is_logarithmic is is_logarithmic


def test_a_parameter_that_a_run_leaves_to_its_scenario_is_at_no_level() -> None:
    runs = _series([0.0, 10.0, None]).to_frame("snr_db")
    axis = axis_of("snr_db", runs["snr_db"], "dB")
    assert [level.label for level in axis.levels] == ["0", "10"]
    assert axis.among(runs, Level("0", 0.0)).tolist() == [True, False, False]


def test_the_overview_has_a_row_for_each_family_and_assistant(tmp_path: Path) -> None:
    rows = grid(["s01a_x", "s01b_x"], ["paper", "reference"], seeds=1)
    content = overview.content(small(tmp_path / "sweep", rows), Figures())
    assert content is not None
    assert [(row["family"], row["assistant"]) for row in content["rows"]] == [
        (family, assistant)
        for family in ("all", "s01a", "s01b")
        for assistant in ("paper", "reference")
    ]
    assert [row["runs"] for row in content["rows"]] == [18, 18, 9, 9, 9, 9]


def test_a_sweep_in_which_nothing_finished_still_has_a_page(tmp_path: Path) -> None:
    folder = write_sweep(tmp_path / "sweep", [failed("s01a_x", "RendererError: no renderer")])
    data = data_of(write_sweep_report(folder))
    assert data["notes"] == []
    assert data["sections"]["failures"]["rows"][0]["count"] == 1


def test_failures_are_counted_by_their_cause(written: Path) -> None:
    content = failures.content(read(written), Figures())
    assert content is not None
    assert [(row["count"], row["status"]) for row in content["rows"]] == [
        (1, "failed"),
        (1, "over time"),
    ]


def test_a_run_that_is_kept_is_linked_and_nothing_outside_the_folder(tmp_path: Path) -> None:
    rows = [sweep_row("s01a_x", "reference", seed) for seed in range(3)]
    rows[0]["folder"], rows[1]["folder"] = "runs/kept", "../../etc"
    sweep = small(tmp_path / "sweep", rows)
    links = dict(zip(sweep.runs["seed"], runs.content(sweep, Figures())["links"], strict=True))
    assert links == {0: "runs/kept/", 1: "", 2: ""}


def test_a_page_says_that_a_table_was_changed_after_the_sweep(tmp_path: Path) -> None:
    folder = write_sweep(tmp_path / "sweep", [sweep_row("s01a_x", "reference", 0)])
    table = folder / "sweep.parquet"
    document = json.loads((folder / "sweep.json").read_text())
    files = {name: record.model_dump() for name, record in manifest(folder, [table]).items()}
    document["files"] = files
    (folder / "sweep.json").write_text(json.dumps(document | {"digest": digest(document)}))
    pq.write_table(pq.read_table(table), table, compression="none")
    told: list[str] = []
    (note,) = data_of(write_sweep_report(folder, notice=told.append))["notes"]
    assert note.startswith("Damaged: sweep.parquet: damaged or changed")
    assert len(told) == 1


def test_a_table_that_is_none_of_a_sweep_is_named(tmp_path: Path) -> None:
    folder = write_sweep(tmp_path / "sweep", [sweep_row("s01a_x", "reference", 0)])
    table = pq.read_table(folder / "sweep.parquet").drop_columns(["status"])
    pq.write_table(table, folder / "sweep.parquet")
    with pytest.raises(AirhiltError, match="no table of a sweep; expected columns key, scenario"):
        write_sweep_report(folder)
