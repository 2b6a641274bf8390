"""The report of a run, as a file."""

from __future__ import annotations

import itertools
import json
import re
import shutil
from contextlib import closing
from importlib import resources
from pathlib import Path
from typing import Any

import pytest

from airhilt.cosim import Options, run
from airhilt.errors import AirhiltError, RunFolderError
from airhilt.messages import Advisory, AircraftTruth, Event, Evidence, Message, Severity
from airhilt.metrics import report
from airhilt.metrics.report import write_report
from airhilt.record import LogWriter, RunFolder
from airhilt.scenario import Scenario
from airhilt.units import SECOND_NS

HOSTILE = (
    "</script><script>alert(1)</script><!-- <img src=x onerror=alert(2)> &lt;b> \u2028 @@RUN@@"
)


@pytest.fixture(scope="module")
def finished(encounter: Scenario, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run that came to its end."""
    out = tmp_path_factory.mktemp("report") / "run"
    return run(encounter, Options(latency="fixed", out=out)).folder


@pytest.fixture
def folder(finished: Path, tmp_path: Path) -> Path:
    """A copy of it to damage."""
    return shutil.copytree(finished, tmp_path / "run")


def shown(page: Path) -> dict[str, Any]:
    """Return what the page was given to show."""
    scripts = re.findall(
        r'<script type="application/json" id="run">(.*?)</script>', page.read_text(), re.DOTALL
    )
    assert len(scripts) == 1
    data: dict[str, Any] = json.loads(scripts[0])
    return data


def rewrite_log(folder: Path, *messages: tuple[str, Message]) -> None:
    with closing(LogWriter(folder / "log.mcap")) as log:
        for key, message in messages:
            data = message.model_dump_json().encode()
            log.write(key, "test", type(message), message.t_ns, data)


def truth(actor: str, t_s: float, **changed: float) -> AircraftTruth:
    place = {"latitude_deg": 38.9, "longitude_deg": -77.0, "altitude_m": 10_668.0} | changed
    still = dict.fromkeys(AircraftTruth.model_fields, 0.0)
    return AircraftTruth.model_validate(
        still | place | {"actor": actor, "icao24": "a1b2c3", "t_ns": round(t_s * SECOND_NS)}
    )


def hostile_advisory() -> Advisory:
    return Advisory(
        t_ns=SECOND_NS, id=HOSTILE, revision=0, recipient="ATC", recipients=(HOSTILE,),
        kind="loss_of_separation", severity=Severity.WARNING, traffic=(HOSTILE,), message=HOSTILE,
        evidence=Evidence(sources=("adsb",)), t_ready_ns=0,
    )  # fmt: skip


# --- what it shows --------------------------------------------------------------------------


def test_a_finished_run_is_shown_with_its_numbers_tracks_and_events(folder: Path) -> None:
    page = write_report(folder)
    assert page == folder / "report.html"
    data = shown(page)
    assert data["summary"] == RunFolder(folder).summary()
    assert data["notes"] == []
    assert data["pair"] == ["AAL123", "DAL456"]
    assert [track["callsign"] for track in data["tracks"]] == ["AAL123", "DAL456"]
    assert {"advisory", "conflict", "status", "finished"} <= {e["kind"] for e in data["events"]}
    assert {worker["worker"] for worker in data["latencies"]} == {"adsb", "decision"}


def test_tracks_lie_where_the_aircraft_flew(folder: Path) -> None:
    west, east = shown(write_report(folder))["tracks"]
    assert west["east_nm"][0] == pytest.approx(-13.3, abs=1.0)
    assert east["east_nm"][0] == pytest.approx(13.3, abs=1.0)
    assert west["east_nm"] == sorted(west["east_nm"])
    assert max(map(abs, west["north_nm"] + east["north_nm"])) < 0.5
    assert west["altitude_ft"][0] == pytest.approx(35_000, abs=50)


def test_separation_is_that_of_the_two_tracks(folder: Path) -> None:
    data = shown(write_report(folder))
    west, east = data["tracks"]
    apart = data["separations"]
    assert apart["t"] == west["t"]
    assert apart["horizontal_nm"][0] == pytest.approx(
        east["east_nm"][0] - west["east_nm"][0], abs=0.01
    )
    assert apart["vertical_ft"][-1] == pytest.approx(
        abs(east["altitude_ft"][-1] - west["altitude_ft"][-1]), abs=1.5
    )


def test_tracks_across_the_antimeridian_stay_together(folder: Path) -> None:
    rewrite_log(
        folder,
        ("truth/state/AAL123", truth("AAL123", 0.0, longitude_deg=179.95)),
        ("truth/state/DAL456", truth("DAL456", 0.0, longitude_deg=-179.95)),
    )
    data = shown(write_report(folder))
    (west,), (east,) = (track["east_nm"] for track in data["tracks"])
    assert east - west == pytest.approx(data["separations"]["horizontal_nm"][0], rel=0.01)
    assert 4.0 < east - west < 5.0


def test_without_an_annotation_the_pair_is_the_one_of_the_summarys_closest_approach(
    folder: Path,
) -> None:
    info = RunFolder(folder).info()
    info.realised["conflict"] = None
    RunFolder(folder).write_info(info)
    summary = json.loads((folder / "summary.json").read_text())
    summary["closest_approach"] = {"t_s": 5.0, "horizontal_m": 0.0, "vertical_m": 300.0}
    (folder / "summary.json").write_text(json.dumps(summary))
    far, near, above = {"latitude_deg": 39.5}, {}, {"altitude_m": 10_968.0}
    rewrite_log(
        folder,
        *(
            (f"truth/state/{actor}", truth(actor, t_s, **place))
            for t_s in (0.0, 10.0)
            for actor, place in (("FAR", far), ("NEAR", near), ("ABOVE", above))
        ),
    )
    data = shown(write_report(folder))
    assert data["pair"] == ["NEAR", "ABOVE"]
    assert not data["pair_is_annotated"]


def test_latencies_count_every_finished_step_once(folder: Path) -> None:
    rows = [json.loads(line) for line in (folder / "latency.jsonl").read_text().splitlines()]
    finished = [row["worker"] for row in rows if row.get("finished")]
    for worker in shown(write_report(folder))["latencies"]:
        assert worker["n"] == finished.count(worker["worker"])
        assert sum(step["n"] for step in worker["bins"]) == worker["n"]


# --- runs that did not come to their end ----------------------------------------------------


def test_a_killed_run_says_what_is_missing_and_shows_the_rest(folder: Path) -> None:
    (folder / "summary.json").unlink()
    log = folder / "log.mcap"
    log.write_bytes(log.read_bytes()[: log.stat().st_size // 3])
    data = shown(write_report(folder))
    assert data["summary"] is None
    assert any("no summary.json" in note for note in data["notes"])
    assert any("breaks off" in note for note in data["notes"])
    assert len(data["tracks"]) == 2
    assert 0.0 < data["end_s"] < 30.0


@pytest.mark.parametrize("size", [0, 5, 10, 300, 1500, 5000, 9999, 19_435])
def test_a_log_cut_anywhere_gives_a_page(folder: Path, size: int) -> None:
    log = folder / "log.mcap"
    log.write_bytes(log.read_bytes()[:size])
    assert shown(write_report(folder))["notes"]


def test_a_latency_log_cut_in_a_line_counts_up_to_there(folder: Path) -> None:
    text = (folder / "latency.jsonl").read_text()
    (folder / "latency.jsonl").write_text(text[: len(text) // 2 + 7])
    assert shown(write_report(folder))["latencies"]


def test_missing_parts_are_named_on_the_page(folder: Path) -> None:
    for name in ("log.mcap", "latency.jsonl"):
        (folder / name).unlink()
    notes = " ".join(shown(write_report(folder))["notes"])
    assert "log.mcap" in notes
    assert "latency.jsonl" in notes


def test_a_summary_of_another_version_is_left_out_and_said(folder: Path) -> None:
    (folder / "summary.json").write_text('{"seed": 0}')
    data = shown(write_report(folder))
    assert data["summary"] is None
    assert any("summary.json" in note for note in data["notes"])


def test_a_stopped_run_says_why(folder: Path) -> None:
    info = RunFolder(folder).info()
    info.phase, info.cause = "stopped", "worker 'ears' is gone"
    RunFolder(folder).write_info(info)
    assert any("'ears'" in note for note in shown(write_report(folder))["notes"])


# --- mistakes -------------------------------------------------------------------------------


def test_a_folder_without_a_run_is_an_error_that_names_it(tmp_path: Path) -> None:
    with pytest.raises(RunFolderError, match="no run here"):
        write_report(tmp_path / "nothing")


def test_a_page_that_cannot_be_written_is_an_error(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(AirhiltError, match="cannot be written"):
        write_report(folder, tmp_path / "missing" / "page.html")


# --- the file -------------------------------------------------------------------------------


def test_hostile_text_stays_data(folder: Path) -> None:
    info = RunFolder(folder).info()
    info.realised["title"] = HOSTILE
    RunFolder(folder).write_info(info)
    before = write_report(folder, folder.parent / "before.html").read_text().lower()
    rewrite_log(folder, ("advisory/ATC", hostile_advisory()))
    page = write_report(folder)
    after = page.read_text().lower()
    for markup in ("<script", "</script", "<!--", "<img", "onerror=alert(2)>"):
        assert after.count(markup) == before.count(markup)
    (event,) = shown(page)["events"]
    assert event["text"] == HOSTILE
    assert shown(page)["scenario"]["title"] == HOSTILE


def test_nothing_in_the_page_makes_markup_of_data() -> None:
    template = resources.files("airhilt.metrics").joinpath("report.html").read_text("utf-8")
    assert template.count(report.PLACEHOLDER) == 1
    for maker in ("innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval("):
        assert maker not in template


def test_the_page_needs_nothing_from_outside() -> None:
    template = resources.files("airhilt.metrics").joinpath("report.html").read_text("utf-8")
    assert "://" not in template
    assert not re.search(r"<(img|iframe|object|embed)|\bsrc=|@import|url\((?!#)", template)
    assert re.findall(r'href="([^"]*)"', template) == ["data:,"]
    assert "default-src 'none'" in template


def test_the_same_folder_gives_the_same_bytes(folder: Path, tmp_path: Path) -> None:
    first = write_report(folder, tmp_path / "first.html").read_bytes()
    assert write_report(folder, tmp_path / "second.html").read_bytes() == first
    assert write_report(folder).read_bytes() == first


def test_a_track_is_thinned_out_evenly_and_keeps_its_ends() -> None:
    thinned = report._Thinned(most=50)
    for tick in range(1234):
        thinned.add(truth("AAL123", tick / 5).model_dump_json().encode())
    times = [state.t_ns for state in thinned.states()]
    assert 25 <= len(times) <= 51
    assert (times[0], times[-1]) == (0, round(1233 / 5 * SECOND_NS))
    steps = {after - before for before, after in itertools.pairwise(times[:-1])}
    assert len(steps) == 1


def test_fifty_aircraft_and_many_long_messages_stay_below_a_megabyte(folder: Path) -> None:
    info = RunFolder(folder).info()
    (actor, *_) = info.realised["actors"]
    names = [f"TST{number:03d}" for number in range(50)]
    info.realised["actors"] = [actor | {"callsign": name} for name in names]
    RunFolder(folder).write_info(info)
    talk = "x" * 10_000
    states = (
        (f"truth/state/{name}", truth(name, tick / 5, latitude_deg=38.0 + tick * 1.2345e-3))
        for tick in range(500)
        for name in names
    )
    chatter = (
        ("truth/event", Event(t_ns=tick * SECOND_NS, kind="refused", subject="advisory", text=talk))
        for tick in range(500)
    )
    rewrite_log(folder, *states, *chatter)
    assert write_report(folder).stat().st_size < 1_000_000
