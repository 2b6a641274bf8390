"""The report of a run."""

from __future__ import annotations

import json
import re
import shutil
from contextlib import closing
from pathlib import Path

import pytest

from airhilt import run
from airhilt.errors import RunFolderError
from airhilt.messages import Advisory, Evidence, Severity
from airhilt.metrics.report import write_report
from airhilt.record import LogWriter, RunFolder
from airhilt.scenario import Scenario


@pytest.fixture(scope="module")
def finished(encounter: Scenario, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return run(encounter, out=tmp_path_factory.mktemp("r") / "run", latency="fixed").folder


@pytest.fixture
def folder(finished: Path, tmp_path: Path) -> Path:
    return shutil.copytree(finished, tmp_path / "run")


def data_of(page: Path) -> dict:
    match = re.search(r"^const data = (.*);$", page.read_text(), flags=re.MULTILINE)
    assert match is not None
    return json.loads(match[1])


def test_a_run_leaves_its_report(finished: Path) -> None:
    data = data_of(finished / "report.html")
    assert [actor["callsign"] for actor in data["actors"]] == ["AAL123", "DAL456"]
    assert data["summary"]["avoided"] is True
    kinds = {event["kind"] for event in data["events"]}
    assert {"radio", "advisory", "conflict", "pilot_reacts"} <= kinds
    assert set(data["latencies"]) == {"adsb", "decision"}


def test_the_same_folder_gives_the_same_page(folder: Path, tmp_path: Path) -> None:
    first = write_report(folder, tmp_path / "a.html").read_bytes()
    assert write_report(folder, tmp_path / "b.html").read_bytes() == first


def test_a_page_refers_to_nothing_outside_itself(finished: Path) -> None:
    page = (finished / "report.html").read_text()
    outside = re.findall(r"""(?:src|href)\s*=|https?://[^\s"'<]+|@import""", page)
    assert set(outside) <= {"http://www.w3.org/2000/svg"}


def test_a_broken_off_run_has_a_report_too(folder: Path) -> None:
    (folder / "summary.json").unlink()
    log = folder / "log.mcap"
    log.write_bytes(log.read_bytes()[: log.stat().st_size // 2])
    latencies = folder / "latency.jsonl"
    latencies.write_text(latencies.read_text()[:-10])
    data = data_of(write_report(folder))
    assert data["summary"] is None
    assert 0.0 < data["end_s"] < 30.0
    assert data["actors"]


def test_hostile_text_stays_text(folder: Path) -> None:
    hostile = "</script><script>alert(1)</script><!-- <img src=x onerror=alert(2)>"
    advisory = Advisory(
        id="x", revision=0, recipient="ATC", recipients=("ATC",), kind="loss_of_separation",
        severity=Severity.CAUTION, traffic=("A",), message=hostile,
        evidence=Evidence(sources=()), t_ready_ns=0,
    )  # fmt: skip
    with closing(LogWriter(folder / "log.mcap")) as log:
        log.write("advisory/ATC", "evil", Advisory, 0, advisory.model_dump_json().encode())
    page = write_report(folder)
    assert hostile not in page.read_text()
    assert page.read_text().count("</script>") == 1
    assert data_of(page)["events"][0]["text"] == hostile


def test_a_long_run_of_many_aircraft_stays_small(folder: Path) -> None:
    states = [
        {"t_ns": second * 10**9, "actor": f"A{index}", "latitude_deg": 39.0 + second / 9000,
         "longitude_deg": -77.0 + index / 100, "altitude_m": 10000.0 + second}
        for second in range(1200)
        for index in range(50)
    ]  # fmt: skip
    with closing(LogWriter(folder / "log.mcap")) as log:
        for state in states:
            key = f"truth/state/{state['actor']}"
            log.write(key, "run", Advisory, state["t_ns"], json.dumps(state).encode())
    assert write_report(folder).stat().st_size < 2_500_000


def test_a_folder_without_a_run_is_named(tmp_path: Path) -> None:
    with pytest.raises(RunFolderError, match="no run here"):
        write_report(tmp_path)


def test_a_log_that_is_none_is_named(folder: Path) -> None:
    (folder / "log.mcap").write_bytes(b"not a log at all")
    with pytest.raises(RunFolderError, match="not an MCAP log"):
        write_report(folder)


def test_an_unwritable_file_is_named(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(RunFolderError, match="--out"):
        write_report(folder, tmp_path / "missing" / "x.html")


def test_the_report_folder_is_complete(folder: Path) -> None:
    write_report(folder)
    assert RunFolder(folder).report_path.is_file()
    assert not list(folder.glob("*.partial"))
