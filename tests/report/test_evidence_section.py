"""The report shows what each advisory rests on."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from airhilt.messages import CONTROLLER, Advisory, Evidence, Severity
from airhilt.report import write_report
from radio_folder import RadioFolder
from report_pages import shown


def advisory(recipient: str, revision: int = 0, **more: Any) -> Advisory:
    return Advisory(
        t_ns=20_000_000_000, id="a-1", revision=revision, recipient=recipient,
        recipients=("AAL123", CONTROLLER), kind="runway_conflict", severity=Severity.WARNING,
        traffic=("AAL123",), message="truck on runway 01", t_ready_ns=19_000_000_000,
        evidence=Evidence(
            sources=("vision", "radio"), radio_ids=("clearance",), camera_ids=("tower",),
            rules=("score",), shares={"vision": 0.6, "radio": 0.4}, time_to_go_s=31.0,
        ), **more,
    )  # fmt: skip


def rows(tmp_path: Path, *advisories: Advisory) -> Any:
    folder = RadioFolder(tmp_path / "run")
    for one in advisories:
        folder.write(f"advisory/{one.recipient}", one)
    return shown(write_report(folder.close()))["sections"]["evidence"]


def test_an_advisory_has_one_row_for_all_its_recipients(tmp_path: Path) -> None:
    (row,) = rows(tmp_path, advisory("AAL123"), advisory(CONTROLLER))
    assert (row["t"], row["severity"], row["recipients"]) == (20.0, "WARNING", ["AAL123", "ATC"])
    assert row["rules"] == ["score"]
    assert (row["radio"], row["cameras"], row["tracks"]) == (["clearance"], ["tower"], [])
    assert row["shares"] == {"vision": 0.6, "radio": 0.4}
    assert row["time_to_go_s"] == 31.0
