"""What people at seats did upon advisories, and how soon."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

from airhilt.commands import GoAroundCommand
from airhilt.messages import (
    ActorCommand,
    Advisory,
    AdvisoryAudio,
    AdvisoryPerceived,
    Evidence,
    GoAround,
    Message,
    MicrophoneAudio,
    Severity,
)
from airhilt.metrics.people import FOLLOWED_WITHIN_S, PeopleRecords
from airhilt.metrics.summary import PersonReaction, PersonSummary
from airhilt.record import RunFolder
from airhilt.report.people_csv import write_people_csv

SECOND = 1_000_000_000
GO_AROUND = ActorCommand(command=GoAroundCommand(action="go_around"))


def advisory(recommendation: GoAround | None = None) -> Advisory:
    return Advisory(
        id="a-1", revision=1, kind="runway_conflict", severity=Severity.WARNING, traffic=("AAL1",),
        recipient="AAL1", recipients=("AAL1",), message="go around",
        evidence=Evidence(sources=("adsb",)), recommendation=recommendation, t_ready_ns=0,
        active=True,
    )  # fmt: skip


def perceived(way: str, after_s: float = 0.0) -> AdvisoryPerceived:
    return AdvisoryPerceived.model_validate(
        {"id": "a-1", "revision": 1, "recipient": "AAL1", "way": way, "after_s": after_s}
    )


def person(*messages: tuple[float, str, Message]) -> PersonSummary:
    """Return what is known of the person in AAL1 after messages at times in s, with keys."""
    records = PeopleRecords(["AAL1"])
    for t_s, key, message in messages:
        records.take(key, message.model_copy(update={"t_ns": round(t_s * SECOND)}))
    return records.summaries()[0]


def reaction(*messages: tuple[float, str, Message]) -> PersonReaction:
    return person(*messages).reactions[0]


def test_the_reaction_time_begins_with_the_first_audible_sample() -> None:
    voice = AdvisoryAudio(
        id="a-1", revision=1, recipient="AAL1", text="", t_dec_ns=0, engine="", samples=0, sha256=""
    )
    found = reaction(
        (10.0, "advisory/AAL1", advisory(GoAround(runway="01"))),
        (10.1, "perceived/AAL1", perceived("seen")),
        (10.8, "tts/a-1", voice),
        (10.9, "perceived/AAL1", perceived("heard", after_s=0.1)),
        (12.5, "command/AAL1", GO_AROUND),
    )
    assert found.reaction_time_s == pytest.approx(1.5)
    assert found.voice_to_loudspeaker_s == pytest.approx(0.2)
    assert (found.first_action, found.followed) == ("go_around", True)


def test_what_is_not_heard_is_reacted_to_from_its_display() -> None:
    found = reaction(
        (10.0, "advisory/AAL1", advisory()),
        (10.1, "perceived/AAL1", perceived("seen")),
        (11.1, "microphone/AAL1", MicrophoneAudio(phase="pressed", delay_s=0.02)),
    )
    assert found.reaction_time_s == pytest.approx(1.0)
    assert (found.first_action, found.followed) == ("spoken call", None)


@pytest.mark.parametrize("late_s", [FOLLOWED_WITHIN_S + 1.0, None])
def test_advice_that_is_done_too_late_or_never_is_not_followed(late_s: float | None) -> None:
    told = [
        (10.0, "advisory/AAL1", advisory(GoAround(runway="01"))),
        (10.0, "perceived/AAL1", perceived("seen")),
    ]
    late = [] if late_s is None else [(10.0 + late_s, "command/AAL1", GO_AROUND)]
    assert reaction(*told, *late).followed is False


def test_what_the_person_did_before_is_no_reaction() -> None:
    found = reaction(
        (9.0, "command/AAL1", GO_AROUND),
        (10.0, "advisory/AAL1", advisory()),
        (10.1, "perceived/AAL1", perceived("seen")),
    )
    assert (found.first_action, found.reaction_time_s) == (None, None)


def test_commands_to_other_aircraft_are_of_nobody_at_a_seat() -> None:
    assert person((1.0, "command/DAL2", GO_AROUND)).commands == 0


def test_reactions_are_written_as_a_table(tmp_path: Path) -> None:
    summary = person(
        (10.0, "advisory/AAL1", advisory()),
        (10.1, "perceived/AAL1", perceived("seen")),
    )
    (tmp_path / "summary.json").write_text(
        json.dumps({"people": [summary.model_dump(mode="json")]})
    )
    table = tmp_path / "reactions.csv"
    write_people_csv(RunFolder(tmp_path), table)
    (row,) = csv.DictReader(table.read_text().splitlines())
    assert (row["seat"], row["severity"], row["t_seen_s"]) == ("AAL1", "WARNING", "10.1")
    assert row["reaction_time_s"] == ""
