"""Experiments: the order of trials, what is finished, and the table."""

from __future__ import annotations

import csv
import itertools
import json
import os
import shutil
import subprocess
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import psutil
import pyarrow.parquet as pq
import pytest

from airhilt.errors import AirhiltError, RunFolderError, StationError
from airhilt.host.library import find
from airhilt.messages import NasaTlx, Severity
from airhilt.metrics.summary import (
    IsaRating,
    PersonCall,
    PersonReaction,
    PersonSummary,
    WorkloadSummary,
)
from airhilt.options import Options
from airhilt.record import RunFolder
from airhilt.station.conductor import Conductor
from airhilt.station.experiment_tables import write_tables
from airhilt.station.participant_progress import Asked, Progress
from airhilt.station.plan import Plan, balanced_latin_square, plan_of
from airhilt.station.questionnaires import NASA_TLX, Answers
from airhilt.station.started_runs import StartedRun, StartedRuns
from stations import reachable

Cli = Callable[..., subprocess.CompletedProcess[str]]
ANSWERS: Answers = {
    "mental_demand": 50, "physical_demand": 10, "temporal_demand": 30, "performance": 20,
    "effort": 40, "frustration": 0,
}  # fmt: skip
TRUST = {
    "type": "scale", "name": "trust", "question": "How much did you trust the assistant?",
    "low": "Not at all", "high": "Completely",
}  # fmt: skip
LICENCE = {
    "type": "choice", "name": "licence", "question": "Which licence have you?",
    "choices": ["none", "private", "commercial"],
}  # fmt: skip
PREFERRED = LICENCE | {"name": "preferred", "choices": ["with", "without"]}
QUESTIONS = {"before": [LICENCE], "after_trial": [TRUST], "end": [PREFERRED]}


REACTION = PersonReaction(
    advisory="reference-1", revision=2, kind="runway_conflict", severity=Severity.WARNING,
    advised="go_around", t_advisory_s=3.0, t_seen_s=3.1, t_heard_s=3.4,
    voice_to_loudspeaker_s=0.1, first_action="go_around", reaction_time_s=1.5, followed=True,
)  # fmt: skip
CALL = PersonCall(
    call="microphone.AAL123.1", way="spoken", frequency_khz=119_100, t_s=4.0, t_tx_s=4.01,
    to_air_s=0.01, to_loudspeaker_s=0.8, heard_at=1, length_s=2.0, recognised="going around",
    confidence=0.9, blocked=False, answer="Roger.", answered_after_s=1.5,
)  # fmt: skip
PERSON = PersonSummary(
    seat="AAL123", seat_time_s=8.0, spoken_calls=3, typed_calls=1, commands=2, asked_to_say_again=0,
    readback_errors=1, press_to_transmit_s=0.01, press_to_loudspeaker_s=0.8,
    reaction_time_s=1.5,
    calls=[CALL], reactions=[REACTION],
    workload=WorkloadSummary(
        isa_mean=4.0,
        isa=[IsaRating(t_s=2.0, rating=4, answered_after_s=1.0)],
        nasa_tlx=None,
        raw_tlx=None,
    ),
)  # fmt: skip


def finished(recorded_run: Path, folder: Path, people: list[Any]) -> None:
    """Copy a run to a folder as if these people had been at its seats, as JSON has them."""
    paths = RunFolder(Path(shutil.copytree(recorded_run, folder)))
    summary = json.loads(paths.summary_path.read_text()) | {"people": people}
    paths.summary_path.write_text(json.dumps(summary))
    paths.write_info(paths.info().model_copy(update={"files": paths.manifest()}))


def table(path: Path) -> list[dict[str, Any]]:
    """Return the rows of a Parquet file; its CSV file has the same columns and as many rows."""
    found = pq.read_table(path)
    head, *lines = path.with_suffix(".csv").read_text().splitlines()
    assert (next(csv.reader([head])), len(lines)) == (found.column_names, found.num_rows)
    rows: list[dict[str, Any]] = found.to_pylist()
    return rows


def plan(**given: Any) -> Plan:
    document = {
        "participants": ["P01", "P02"],
        "seat": "AAL123",
        "scenarios": ["s02a_headon"],
        "conditions": {"assistant": ["reference", "none"]},
    }
    return plan_of(document | given, "plan.json")


TEAMS: dict[str, Any] = {
    "participants": [["P01", "P02"], ["P03", "P04"]],
    "seats": ["tower", "AAL123"],
    "seat": None,
    "scenarios": ["s01b_nominal"],
}
"""What a plan has where a controller and a pilot take part together."""


def team_plan(**given: Any) -> Plan:
    return plan(**TEAMS | given)


def led(experiment: Plan, folder: Path, participant: str) -> list[Progress]:
    """Return the progress of each in the team of a participant."""
    return [Progress(experiment, folder, name) for name in experiment.team_of(participant)]


def asking(*items: dict[str, Any]) -> dict[str, Any]:
    """Return what a plan has to ask these items at the end."""
    return {"questions": {"end": items}}


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Options, str]]:
    """Options and names of the runs that are started; none of them runs."""
    started: list[tuple[Options, str]] = []
    monkeypatch.setattr(StartedRuns, "start", lambda _, __, *run: started.append(run))
    return started


@pytest.fixture
def progress(tmp_path: Path) -> Progress:
    """The progress of one participant who has done nothing yet."""
    return Progress(plan(participants=["P01"]), tmp_path, "P01")


@pytest.mark.parametrize("size", [4, 5])
def test_each_trial_is_equally_often_at_each_place_and_after_each_other(size: int) -> None:
    rows = balanced_latin_square(size)
    for place in range(size):
        assert len(set(Counter(row[place] for row in rows).values())) == 1
    followers = Counter(pair for row in rows for pair in itertools.pairwise(row))
    assert len(followers) == size * (size - 1)
    assert len(set(followers.values())) <= 1


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"participants": ["Jane Doe"]}, "participants"),
        ({"participants": ["P01", "P01"]}, "twice"),
        ({"conditions": {"seat": ["tower"]}}, "the experiment gives it"),
        ({"options": {"wait_for_seats": False}}, "the experiment gives it"),
        ({"conditions": {"snr_db": [900]}}, "snr_db"),
        (
            {"conditions": {"snr_db": [*range(40)], "seed": [*range(26)]}},
            "found 1,040 trials; expected at most 1,000",
        ),
        ({"scenarios": ["nowhere"]}, "nowhere"),
        ({"seat": "nobody"}, "nobody of that name"),
        ({"seat": None}, "expected either seat, of one participant, or seats, of a team"),
        ({"seats": ["tower", "AAL123"]}, "expected either seat, of one participant, or seats"),
        ({"participants": [["P01", "P02"]]}, "expected an identifier"),
        (
            TEAMS | {"participants": [["P01", "Jo Doe"]]},
            "participants/0/team/1: String should match",
        ),
        (TEAMS | {"participants": ["P01", "P02"]}, "expected a list, for there are seats"),
        (
            TEAMS | {"participants": [["P01", "P02", "P03"]]},
            "a team of 3, P01, P02, P03; expected 2",
        ),
        (
            TEAMS | {"participants": [["P01", "P02"], ["P01", "P03"]]},
            "participants: one is there tw",
        ),
        (TEAMS | {"seats": ["tower", "tower"]}, "seats: one is there twice"),
        (TEAMS | {"seats": ["tower", "Washington Tower"]}, "are the same seat in s01b_nominal"),
        (asking(TRUST, TRUST), "two items are called trust; expected another name"),
        (asking(LICENCE | {"choices": ["one", "one"]}), "one choice is there twice"),
    ],
)
def test_a_plan_that_cannot_be_is_refused_in_words(given: dict[str, Any], said: str) -> None:
    with pytest.raises(AirhiltError, match=said):
        plan(**given).check()


def test_a_finished_trial_is_not_run_again_and_has_a_row(
    progress: Progress, recorded_run: Path, tmp_path: Path
) -> None:
    conductor = Conductor([progress])
    assert conductor.state()["step"] == "ready"
    first, second = progress.trials
    stopped = shutil.copytree(recorded_run, progress.folder / f"01-{first.name}") / "run.json"
    stopped.write_text(json.dumps(json.loads(stopped.read_text()) | {"phase": "stopped"}))
    assert conductor.state()["step"] == "ready"
    assert progress.new_run(first) == f"01-{first.name}-2"
    shutil.copytree(recorded_run, progress.folder / f"01-{first.name}-2")
    assert conductor.state()["step"] == "questions"
    with pytest.raises(StationError, match="not time"):
        conductor.begin()
    conductor.answer("nasa_tlx", ANSWERS)
    assert (progress.is_done(first), progress.is_done(second)) == (True, False)
    assert Conductor([progress]).state()["trial"] == 2
    with pytest.raises(StationError, match="no question"):
        conductor.answer("nasa_tlx", ANSWERS)
    assert write_tables(progress.plan, tmp_path) == (1, 0, 0)
    row = pq.read_table(tmp_path / "experiment.parquet").to_pylist()[0]
    assert row["run"] == f"P01/01-{first.name}-2"
    assert row["condition.assistant"] == "reference"
    assert row["nasa_tlx.raw_tlx"] == 25.0
    assert row["duration_s"] == pytest.approx(8.0)
    assert (tmp_path / "experiment.csv").read_text().startswith('"participant"')


def test_the_row_of_a_trial_has_the_totals_of_its_person(
    progress: Progress, recorded_run: Path, tmp_path: Path
) -> None:
    ignored = REACTION.model_copy(
        update={"t_heard_s": None, "reaction_time_s": None, "followed": False}
    )
    unadvised = ignored.model_copy(update={"t_seen_s": None, "t_heard_s": 5.0, "followed": None})
    person = PERSON.model_copy(update={"reactions": [REACTION, ignored, unadvised]})
    name = f"01-{progress.trials[0].name}"
    finished(recorded_run, progress.folder / name, [person.model_dump(mode="json")])
    write_tables(progress.plan, tmp_path)
    row = table(tmp_path / "experiment.parquet")[0]
    own = {key.removeprefix("person."): row[key] for key in row if key.startswith("person.")}
    assert own == own | {
        "seat_time_s": 8.0, "spoken_calls": 3, "commands": 2, "reaction_time_s": 1.5,
        "reaction_times": 1, "advisories_seen": 2, "advisories_heard": 2, "followed": 1,
        "not_followed": 1,
    }  # fmt: skip


def test_a_reaction_and_a_call_have_a_row_with_their_trial(
    progress: Progress, recorded_run: Path, tmp_path: Path
) -> None:
    for position, trial in enumerate(progress.trials, 1):
        folder = progress.folder / f"{position:02d}-{trial.name}"
        people = [PERSON.model_dump(mode="json")] if position == 2 else []
        finished(recorded_run, folder, people)
    assert write_tables(progress.plan, tmp_path) == (2, 1, 1)
    of_trial = table(tmp_path / "experiment.parquet")[1]
    names = ("participant", "trial", "scenario", "position", "run", "condition.assistant")
    for kind, told in (("reactions", REACTION), ("calls", CALL)):
        row = table(tmp_path / f"{kind}.parquet")[0]
        assert {name: row[name] for name in names} == {name: of_trial[name] for name in names}
        assert row["seat"] == "AAL123"
        assert {name: row[name] for name in type(told).model_fields} == told.model_dump()


@pytest.mark.parametrize(("given", "may_pause"), [({}, False), ({"pause": True}, True)])
def test_a_trial_is_paused_only_where_the_plan_lets_it(
    tmp_path: Path,
    started: list[tuple[Options, str]],
    given: dict[str, bool],
    may_pause: bool,
) -> None:
    conductor = Conductor([Progress(plan(participants=["P01"], **given), tmp_path, "P01")])
    conductor.begin()
    assert (started[0][0].pause, conductor.state()["may_pause"]) == (may_pause, may_pause)


def test_the_page_of_a_trial_that_is_over_is_not_that_of_the_next_one(
    progress: Progress, recorded_run: Path
) -> None:
    name = f"01-{progress.trials[0].name}"
    shutil.copytree(recorded_run, progress.folder / name)
    progress.answer(Asked(NASA_TLX, name), ANSWERS)
    still_there = StartedRun(
        name=name,
        scenario="s02a_headon",
        seats=("AAL123",),
        process=os.getpid(),
        created_s=psutil.Process().create_time(),
    )
    kept = progress.folder / ".station"
    kept.mkdir()
    (kept / f"{name}.json").write_text(still_there.model_dump_json())
    state = Conductor([progress]).state()
    assert (state["trial"], state["step"], state["url"]) == (2, "ready", "")


def test_a_participant_is_told_nothing_of_the_scenario(
    progress: Progress, started: list[tuple[Options, str]]
) -> None:
    conductor = Conductor([progress])
    conductor.begin()
    ((options, name),) = started
    assert (options.run_name, name) == ("Trial-1", "01-s02a_headon-1")
    assert "headon" not in json.dumps(conductor.state())


def test_numbers_that_a_run_did_not_write_do_not_enter_the_table(
    progress: Progress, recorded_run: Path, tmp_path: Path
) -> None:
    name = f"01-{progress.trials[0].name}"
    numbers = shutil.copytree(recorded_run, progress.folder / name) / "summary.json"
    numbers.write_text(numbers.read_text().replace('"duration_s": 8.0', '"duration_s": 80.0'))
    with pytest.raises(RunFolderError, match=r"summary\.json: damaged or changed"):
        write_tables(progress.plan, tmp_path)
    numbers.unlink()
    with pytest.raises(RunFolderError, match=r"summary\.json: missing"):
        write_tables(progress.plan, tmp_path)


def test_a_trial_whose_record_cannot_be_read_is_begun_again(
    progress: Progress, recorded_run: Path
) -> None:
    first = progress.trials[0]
    folder = shutil.copytree(recorded_run, progress.folder / f"01-{first.name}")
    (folder / "run.json").write_bytes(b"[" * 100_000)
    assert progress.finished_run(first) is None


@pytest.mark.parametrize("content", [None, b"{", b'{"people": [{}]}'])
def test_a_finished_trial_whose_seats_cannot_be_read_is_neither_done_nor_begun_again(
    progress: Progress, recorded_run: Path, content: bytes | None
) -> None:
    name = f"01-{progress.trials[0].name}"
    folder = shutil.copytree(recorded_run, progress.folder / name)
    if content is None:
        RunFolder(folder).summary_path.unlink()
    else:
        RunFolder(folder).summary_path.write_bytes(content)
    with pytest.raises(RunFolderError, match=r"summary\.json: .*move the folder away to run"):
        Conductor([progress])


def test_a_break_has_to_be_taken(recorded_run: Path, tmp_path: Path) -> None:
    progress = Progress(plan(break_after=1), tmp_path, "P01")
    shutil.copytree(recorded_run, progress.folder / f"01-{progress.trials[0].name}")
    assert Conductor([progress]).state()["rest_s"] == 0.0
    conductor = Conductor([progress])
    conductor.answer("nasa_tlx", ANSWERS)
    for leader in (conductor, Conductor([progress])):  # The page may have been started again.
        assert leader.state()["rest_s"] > 100.0
        with pytest.raises(StationError, match="not time"):
            leader.begin()


def test_a_number_of_participants_that_makes_no_balanced_order_is_told(
    airhilt_command: Cli, tmp_path: Path
) -> None:
    path = tmp_path / "plan.json"
    path.write_text(plan(participants=["P01", "P02", "P03"]).model_dump_json())
    done = airhilt_command("experiment", path)
    assert "not balanced with 3 participants; expected 2," in done.stderr
    assert "P01: s02a_headon-1, s02a_headon-2" in done.stdout
    assert "P02: s02a_headon-2, s02a_headon-1" in done.stdout
    assert (tmp_path / "experiments" / "plan" / "reactions.csv").is_file()
    path.write_text(team_plan(participants=TEAMS["participants"][:1]).model_dump_json())
    done = airhilt_command("experiment", path)
    assert done.returncode == 0
    assert "P02: s01b_nominal-1, s01b_nominal-2" in done.stdout
    assert "not balanced with 1 teams; expected 2, or a multiple" in done.stderr


def names_asked(conductor: Conductor, participant: str = "") -> list[str]:
    """Return the names of the items that the page of a participant has to ask now."""
    asked = conductor.state(participant).get("questions", {"items": []})
    return [item["name"] for item in asked["items"]]


def test_own_questions_are_asked_before_after_each_trial_and_at_the_end(
    recorded_run: Path, tmp_path: Path
) -> None:
    experiment = plan(participants=["P01"], questions=QUESTIONS)
    progress = Progress(experiment, tmp_path, "P01")
    conductor = Conductor([progress])
    assert names_asked(conductor) == ["licence"]
    with pytest.raises(StationError, match="not time"):
        conductor.begin()
    conductor.answer("before", {"licence": "private"})
    assert conductor.state()["step"] == "ready"
    for position, trial in enumerate(progress.trials, 1):
        finished(recorded_run, progress.folder / f"{position:02d}-{trial.name}", [])
        assert names_asked(conductor) == list(ANSWERS)
        conductor.answer("nasa_tlx", ANSWERS)
        assert names_asked(conductor) == ["trust"]
        assert not progress.is_done(trial)
        conductor.answer("after_trial", {"trust": position})
    assert names_asked(conductor) == ["preferred"]
    conductor.answer("end", {"preferred": "with"})
    assert conductor.state()["step"] == "done"
    write_tables(experiment, tmp_path)
    rows = table(tmp_path / "experiment.parquet")
    names = ("before.licence", "nasa_tlx.raw_tlx", "after_trial.trust", "end.preferred")
    assert [[row[name] for name in names] for row in rows] == [
        ["private", 25.0, 1.0, "with"],
        ["private", 25.0, 2.0, "with"],
    ]
    kept = json.loads((progress.folder / "before.json").read_text())
    assert kept == {"licence": "private"}


def test_ratings_that_were_given_at_the_seat_are_not_asked_again(
    recorded_run: Path, tmp_path: Path
) -> None:
    experiment = plan(participants=["P01"], questions={"after_trial": [TRUST]})
    progress = Progress(experiment, tmp_path, "P01")
    workload = PERSON.workload.model_copy(update={"nasa_tlx": NasaTlx.model_validate(ANSWERS)})
    person = PERSON.model_copy(update={"workload": workload}).model_dump(mode="json")
    finished(recorded_run, progress.folder / f"01-{progress.trials[0].name}", [person])
    assert names_asked(Conductor([progress])) == ["trust"]
    write_tables(experiment, tmp_path)
    assert table(tmp_path / "experiment.parquet")[0]["nasa_tlx.raw_tlx"] == 25.0


@pytest.mark.parametrize(
    ("answers", "said"),
    [
        ({}, "trust: not answered"),
        ({"trust": 8}, "trust: found 8; expected 1 to 7"),
        ({"trust": 4, "more": 1}, "'more': not asked"),
    ],
)
def test_answers_that_the_items_do_not_take_are_refused_in_words(
    tmp_path: Path, answers: Answers, said: str
) -> None:
    progress = Progress(plan(participants=["P01"], questions={"before": [TRUST]}), tmp_path, "P01")
    conductor = Conductor([progress])
    with pytest.raises(StationError, match=said):
        conductor.answer("before", answers)
    with pytest.raises(StationError, match="no question of it is open"):
        conductor.answer("end", answers)
    assert names_asked(conductor) == ["trust"]


@pytest.mark.parametrize("content", ['{"trust": 8}', "["])
def test_answers_that_no_page_wrote_are_refused_in_words(tmp_path: Path, content: str) -> None:
    """They are not asked again by themselves: the answers of a person would be lost."""
    progress = Progress(plan(participants=["P01"], questions={"before": [TRUST]}), tmp_path, "P01")
    progress.folder.mkdir()
    (progress.folder / "before.json").write_text(content)
    with pytest.raises(RunFolderError, match=r"before\.json: .*move the file away to ask again"):
        Conductor([progress]).state()


def test_an_item_that_came_into_the_plan_later_or_is_not_answered_yet_leaves_a_gap(
    recorded_run: Path, tmp_path: Path
) -> None:
    progress = Progress(plan(participants=["P01"], questions={"before": [TRUST]}), tmp_path, "P01")
    Conductor([progress]).answer("before", {"trust": 3})
    later = plan(participants=["P01"], questions={"before": [TRUST, LICENCE]})
    finished(recorded_run, progress.folder / f"01-{progress.trials[0].name}", [])
    write_tables(later, tmp_path)
    row = table(tmp_path / "experiment.parquet")[0]
    names = ("before.trust", "before.licence", "nasa_tlx.effort")
    assert [row[name] for name in names] == [3.0, None, None]


def test_the_scales_of_nasa_tlx_are_those_that_the_run_takes() -> None:
    """The page asks by the items, and the message of the seat has the limits."""
    assert [item.name for item in NASA_TLX.items] == list(NasaTlx.model_fields)
    for end in (0, 100):
        ratings = dict.fromkeys(NasaTlx.model_fields, end)
        NASA_TLX.check(ratings)
        NasaTlx.model_validate(ratings)
    for outside in (-5, 105, 52):
        with pytest.raises(ValueError, match=f"mental_demand: found {outside}; expected 0 to 100"):
            NASA_TLX.check(ratings | {"mental_demand": outside})


def test_a_team_has_one_order_of_trials_and_the_next_team_another() -> None:
    experiment = team_plan()
    order = {name: [trial.name for trial in experiment.order_of(name)] for name in
             ("P01", "P02", "P03", "P04")}  # fmt: skip
    assert order["P01"] == order["P02"] == ["s01b_nominal-1", "s01b_nominal-2"]
    assert order["P03"] == order["P04"] == ["s01b_nominal-2", "s01b_nominal-1"]


def test_a_trial_of_a_team_has_all_its_seats_and_begins_when_each_is_ready(
    tmp_path: Path, started: list[tuple[Options, str]]
) -> None:
    conductor = Conductor(led(team_plan(questions={"before": [LICENCE]}), tmp_path, "P02"))
    assert conductor.state()["step"] == "choose"
    assert conductor.state()["seats"] == {"P01": "tower", "P02": "AAL123"}
    conductor.answer("before", {"licence": "none"}, "P01")
    assert conductor.state("P01")["step"] == "waiting"
    assert conductor.state("P02")["step"] == "questions"
    with pytest.raises(StationError, match="not time for a trial"):
        conductor.begin("P01")
    conductor.answer("before", {"licence": "private"}, "P02")
    assert [conductor.state(name)["step"] for name in ("P01", "P02")] == ["ready", "ready"]
    conductor.begin("P02")
    assert started[0][0].seat == ("tower", "AAL123")
    with pytest.raises(StationError, match="'P03': not of these trials; expected one of P01, P02"):
        conductor.state("P03")


def test_a_run_that_was_moved_away_hides_no_other_one(
    progress: Progress, recorded_run: Path
) -> None:
    trial = progress.trials[0]
    name = f"01-{trial.name}-2"
    finished(recorded_run, progress.folder / name, [PERSON.model_dump(mode="json")])
    assert progress.finished_run(trial) == name
    assert progress.new_run(trial) == f"01-{trial.name}-3"


def test_a_run_with_seats_begins_when_they_are_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    commands: list[list[str]] = []

    def begin(command: list[str], **_: Any) -> Any:
        commands.append(command)
        raise OSError("no process in this test")

    monkeypatch.setattr(subprocess, "Popen", begin)
    for seats in ((), ("tower",)):
        with pytest.raises(OSError, match="no process"):
            StartedRuns(tmp_path).start(
                find("scenarios", "s01b_nominal"), Options(seat=seats), f"run-{len(seats)}"
            )
    assert ["--wait-for-seats" in command for command in commands] == [False, True]


def goes_on(progress: Progress) -> None:
    """Let the first trial of a team go on, in the process of the tests."""
    name = f"01-{progress.trials[0].name}"
    kept = progress.folder / ".station"
    kept.mkdir(parents=True)
    started = StartedRun(
        name=name,
        scenario="s01b_nominal",
        seats=("Washington Tower", "AAL123"),
        process=os.getpid(),
        created_s=psutil.Process().create_time(),
    )
    (kept / f"{name}.json").write_text(started.model_dump_json())
    (kept / f"{name}.txt").write_text("http://127.0.0.1:9\n")


def test_each_of_a_team_is_led_to_the_own_seat(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both press the button: the slower one does not know yet that the trial has begun."""
    team = led(team_plan(), tmp_path, "P01")
    monkeypatch.setattr(StartedRuns, "start", lambda *_: goes_on(team[0]))
    conductor = Conductor(team)
    for name in ("P01", "P02"):
        conductor.begin(name)  # The folder of a second run would be there already.
    shown = [conductor.state(name) for name in ("P01", "P02")]
    assert [one["seat"] for one in shown] == ["Washington Tower", "AAL123"]
    assert {(one["step"], one["url"]) for one in shown} == {("running", "http://127.0.0.1:9")}


def two_people(**controller: Any) -> list[Any]:
    """Return the summaries of a controller, with these fields, and of a pilot."""
    at_tower = PERSON.model_copy(
        update={"seat": "Washington Tower", "calls": [], "reactions": []} | controller
    )
    return [one.model_dump(mode="json") for one in (at_tower, PERSON)]


def test_each_of_a_team_has_own_rows_and_answers(recorded_run: Path, tmp_path: Path) -> None:
    experiment = team_plan(questions=QUESTIONS)
    team = led(experiment, tmp_path, "P01")
    conductor = Conductor(team)
    trial = team[0].trials[0]
    conductor.answer("before", {"licence": "none"}, "P01")
    conductor.answer("before", {"licence": "private"}, "P02")
    rated = PERSON.workload.model_copy(update={"nasa_tlx": NasaTlx.model_validate(ANSWERS)})
    run = tmp_path / "P01+P02" / f"01-{trial.name}"
    finished(recorded_run, run, two_people(workload=rated, commands=0))
    assert [names_asked(conductor, name) for name in ("P01", "P02")] == [["trust"], list(ANSWERS)]
    conductor.answer("nasa_tlx", dict.fromkeys(ANSWERS, 100), "P02")
    conductor.answer("after_trial", {"trust": 2}, "P02")
    assert conductor.state("P02")["step"] == "waiting"
    conductor.answer("after_trial", {"trust": 7}, "P01")
    assert {conductor.state(name)["trial"] for name in ("P01", "P02")} == {2}
    assert write_tables(experiment, tmp_path) == (2, 1, 1)
    names = ("participant", "seat", "run", "before.licence", "nasa_tlx.raw_tlx",
             "after_trial.trust", "person.commands")  # fmt: skip
    rows = table(tmp_path / "experiment.parquet")
    shared = f"P01+P02/{run.name}"
    assert [[row[name] for name in names] for row in rows] == [
        ["P01", "Washington Tower", shared, "none", 25.0, 7.0, 0],
        ["P02", "AAL123", shared, "private", 100.0, 2.0, 2],
    ]
    (call,) = table(tmp_path / "calls.parquet")
    assert (call["participant"], call["seat"], call["call"]) == ("P02", "AAL123", CALL.call)
    kept = tmp_path / "P01+P02" / "P02" / f"{run.name}.after_trial.json"
    assert json.loads(kept.read_text()) == {"trust": 2}


def test_a_trial_of_a_team_of_which_one_never_sat_is_not_finished(
    recorded_run: Path, tmp_path: Path
) -> None:
    team = led(team_plan(), tmp_path, "P01")
    trial = team[0].trials[0]
    finished(recorded_run, team[0].folder / f"01-{trial.name}", two_people(seat_time_s=0.0))
    assert [one.finished_run(trial) for one in team] == [None, None]
    finished(recorded_run, team[0].folder / f"01-{trial.name}-2", two_people(seat_time_s=0.5))
    assert [one.finished_run(trial) for one in team] == [f"01-{trial.name}-2"] * 2


def test_a_trial_that_had_other_seats_is_refused(recorded_run: Path, tmp_path: Path) -> None:
    """The plan was changed: who is a pilot in it now had the seat of the controller then."""
    team = led(team_plan(), tmp_path, "P01")
    name = f"01-{team[0].trials[0].name}"
    finished(recorded_run, team[0].folder / name, two_people())
    changed = team_plan(seats=["AAL123", "tower"])
    said = "its seats were Washington Tower, AAL123; expected AAL123, Washington Tower, as the plan"
    with pytest.raises(RunFolderError, match=rf"P01\+P02/{name}: .*{said}"):
        Conductor(led(changed, tmp_path, "P01"))
    with pytest.raises(RunFolderError, match=said):
        write_tables(changed, tmp_path)


def test_the_trials_admit_those_whom_the_page_of_the_experiment_admits(
    airhilt_command: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan = {"participants": ["P01"], "seat": "AAL123", "scenarios": ["s02a_headon"]}
    (tmp_path / "plan.json").write_text(json.dumps(plan))
    given: list[str] = []
    monkeypatch.setattr("airhilt.station.conductor.Conductor", lambda _, page: given.extend(page))
    monkeypatch.setattr("airhilt.station.experiment_app.experiment_app", lambda _: None)
    monkeypatch.setattr("airhilt.station.server.serve", lambda *_, **__: None)
    admitted = reachable(tmp_path)
    done = airhilt_command("experiment", "plan.json", "--participant", "P01", *admitted)
    assert done.returncode == 0, done.stderr
    assert set(admitted) <= set(given)


def test_a_scenario_that_cannot_be_run_is_refused_before_a_participant_comes(
    tmp_path: Path,
) -> None:
    content = json.loads(find("scenarios", "s02a_headon").read_text()) | {"duration_s": 1.0}
    path = tmp_path / "late.json"
    path.write_text(json.dumps(content))
    with pytest.raises(AirhiltError, match="when the run has ended"):
        plan(scenarios=[str(path)]).check()
