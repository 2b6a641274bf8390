"""The people at the seats of a run, as a browser shows them."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from airhilt.messages import NasaTlx, Severity
from airhilt.metrics.summary import (
    IsaRating,
    PersonCall,
    PersonReaction,
    PersonSummary,
    WorkloadSummary,
)
from airhilt.record import RunFolder
from airhilt.report import write_report
from devtools import Page
from seats import act, logged, said, tower

pytestmark = pytest.mark.browser
ROW = "document.querySelector('#people-calls-table tbody tr:first-child')"
CELLS = f"Object.fromEntries([...{ROW}.cells].map((one) => [one.dataset.label, one.textContent]))"
TITLES = (
    "[...document.querySelectorAll('#people h3')].filter((one) => one.checkVisibility())"
    ".map((one) => one.textContent)"
)
WIDE = """[...document.querySelectorAll('#people .scroll')]
    .filter((one) => one.scrollWidth > one.clientWidth)
    .map((one) => `${one.firstChild.id}: ${one.scrollWidth} in ${one.clientWidth}`)"""
"""Script that returns the tables of which not all columns are seen."""
GAPS = """[...document.querySelectorAll('#people .scroll')]
    .filter((one) => one.checkVisibility()).map((one) => one.getBoundingClientRect())
    .slice(0, -1).map((box, i) => [...document.querySelectorAll('#people h3')]
        .filter((one) => one.checkVisibility())[i + 1].getBoundingClientRect().top - box.bottom)"""
"""Script that returns how many pixels are between a table and the title of the next one."""
CALL = PersonCall(
    call="microphone.Washington_Tower.1", way="spoken", frequency_khz=119_100, t_s=4.0, t_tx_s=4.01,
    to_air_s=0.012, to_loudspeaker_s=0.82, heard_at=2, length_s=4.2,
    recognised="american one two three washington tower runway zero one cleared to land wind calm",
    confidence=0.93, blocked=False, answer="Cleared to land.", answered_after_s=1.5,
)  # fmt: skip
TYPED = CALL.model_copy(
    update={"way": "typed", "said": CALL.recognised, "recognised": None, "confidence": None,
            "t_s": 6.0, "heard_at": None, "to_loudspeaker_s": None, "blocked": None},
)  # fmt: skip
REACTION = PersonReaction(
    advisory="reference-1", revision=2, kind="runway_conflict", severity=Severity.WARNING,
    advised="cancel_landing_clearance", t_advisory_s=3.0, t_seen_s=3.1, t_heard_s=3.4,
    voice_to_loudspeaker_s=0.1, first_action="spoken call", reaction_time_s=1.5, followed=True,
)  # fmt: skip
RATED = WorkloadSummary(
    isa_mean=3.5,
    isa=[IsaRating(t_s=120.0 * turn, rating=turn, answered_after_s=1.0) for turn in range(1, 6)],
    nasa_tlx=NasaTlx(
        mental_demand=55, physical_demand=10, temporal_demand=45, performance=20, effort=40,
        frustration=15,
    ),
    raw_tlx=30.8,
)  # fmt: skip
PERSON = PersonSummary(
    seat="Washington Tower", seat_time_s=8.0, spoken_calls=12, typed_calls=3, commands=2,
    asked_to_say_again=1, readback_errors=1, readback_errors_heard=1, press_to_transmit_s=0.012,
    press_to_loudspeaker_s=0.82, reaction_time_s=1.5, unperceived=1, calls=[CALL, TYPED],
    reactions=[REACTION], workload=RATED,
)  # fmt: skip


def report_of(recorded_run: Path, folder: Path, **changed: Any) -> Path:
    """Return the report of a run as if there had been a person, with these changes, at a seat."""
    paths = RunFolder(Path(shutil.copytree(recorded_run, folder)))
    person = PERSON.model_copy(update=changed).model_dump(mode="json")
    summary = json.loads(paths.summary_path.read_text()) | {"people": [person]}
    paths.summary_path.write_text(json.dumps(summary))
    paths.write_info(paths.info().model_copy(update={"files": paths.manifest()}))
    return write_report(folder)


@pytest.mark.parametrize("dark", [False, True])
def test_all_columns_of_people_are_seen_at_once(
    page: Page, recorded_run: Path, tmp_path: Path, dark: bool
) -> None:
    page.open(report_of(recorded_run, tmp_path / "run"), width=1280, height=720, dark=dark)
    assert page.evaluate(WIDE) == []
    assert page.evaluate(TITLES) == ["Seats", "Reactions to advisories", "Calls", "Workload"]
    assert all(16.0 <= gap <= 32.0 for gap in page.evaluate(GAPS))


def test_a_table_of_people_without_rows_is_left_out(
    page: Page, recorded_run: Path, tmp_path: Path
) -> None:
    page.open(
        report_of(recorded_run, tmp_path / "run", reactions=[], calls=[], workload=None),
        width=1280, height=720,
    )  # fmt: skip
    assert page.evaluate(TITLES) == ["Seats"]


@pytest.mark.parametrize(("heard_at", "shown"), [(2, "2"), (0, "0"), (None, None)])
def test_a_call_tells_at_how_many_seats_it_was_heard_where_that_is_known(
    page: Page, recorded_run: Path, tmp_path: Path, heard_at: int | None, shown: str | None
) -> None:
    call = CALL.model_copy(update={"heard_at": heard_at})
    page.open(report_of(recorded_run, tmp_path / "run", calls=[call]))
    assert page.evaluate(CELLS).get("Heard at seats") == shown


def test_each_call_of_a_person_is_in_the_report(page: Page, tmp_path: Path) -> None:
    words = "American one two three, runway zero one, cleared to land"
    given = [
        act("Washington_Tower", 1.0, "take"),
        act("Washington_Tower", 1.1, "agree", uses=["words"]),
        said("Washington_Tower", 5.0, words),
    ]
    logged(tower(20.0), tmp_path / "run", ["tower"], given)
    page.open(write_report(tmp_path / "run"))
    shown = page.evaluate(CELLS)
    assert [shown[name] for name in ("Seat", "Call", "Frequency", "Said", "Blocked")] == [
        "Washington Tower", "typed", "119.100 MHz", words, "no",
    ]  # fmt: skip
    assert shown["Answered after"].endswith(" s")
