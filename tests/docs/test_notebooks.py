"""The notebooks under examples run from the first cell to the last."""

from __future__ import annotations

import json
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

from airhilt.scenario import Scenario
from paths import ROOT
from shortened import shortened

NOTEBOOK = ROOT / "examples" / "sweep.ipynb"


def test_the_notebook_has_its_outputs() -> None:
    cells = json.loads(NOTEBOOK.read_text())["cells"]
    assert all(cell["outputs"] for cell in cells if cell["cell_type"] == "code")
    assert NOTEBOOK.stat().st_size < 100_000


@pytest.mark.slow
def test_the_notebook_runs_a_sweep_and_plots_it(
    encounter: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    short = shortened(encounter.model_dump(mode="json"), 4.0) | {"name": "short"}
    (tmp_path / "short.json").write_text(json.dumps(short))
    notebook = nbformat.read(NOTEBOOK, as_version=4)  # type: ignore[no-untyped-call]
    for cell in notebook.cells:
        cell.source = cell.source.replace('"s02a_vertical"', '"short.json"')
        cell.source = cell.source.replace("seeds=5", "seeds=2").replace("[-2, 0, 2, 4]", "[0, 10]")
    one = 'airhilt.run("short.json", out="runs/one", **options)'
    notebook.cells.append(nbformat.v4.new_code_cell(one))  # type: ignore[no-untyped-call]
    client = NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}})
    client.execute()
    assert (tmp_path / "sweeps" / "notebook" / "sweep.parquet").exists()
    outputs = [cell.outputs for cell in notebook.cells if cell.cell_type == "code"]
    (progress,), table, plot, (line, result) = outputs
    assert progress.data["text/plain"] == "8 of 8 runs"
    assert "x real time" in line.data["text/plain"]
    assert "time to first warning" in result.data["text/html"]
    assert "adsb_only" in table[0].data["text/html"]
    assert any("image/png" in output.get("data", {}) for output in plot)
