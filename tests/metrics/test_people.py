"""Reactions of people at seats to advisories, and how soon they came."""

from __future__ import annotations

import csv
import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from airhilt.commands import GoAroundCommand
from airhilt.errors import RunFolderError
from airhilt.messages import (
    Advisory,
    AdvisoryAudio,
    AgreeToUses,
    AnswerQuestion,
    Event,
    Evidence,
    FlyCommand,
    GoAround,
    HearCall,
    LeaveSeat,
    Message,
    NasaTlx,
    PerceiveAdvisory,
    PressToTalk,
    ReleaseToTalk,
    SayText,
    SeatAct,
    SeatAction,
    Severity,
    SpokenTruth,
    TakeSeat,
    Transcript,
    Use,
    WorkloadQuestion,
)
from airhilt.metrics.people import PeopleRecords
from airhilt.metrics.summary import PersonReaction, PersonSummary
from airhilt.record import Run, RunFolder, open_run
from airhilt.report.people_csv import write_people_csv
from seats import state_of

SECOND = 1_000_000_000
VOICE = AdvisoryAudio(
    id="a-1", revision=1, recipient="AAL1", text="", t_dec_ns=0, engine="", samples=0, sha256=""
)


def done(act: SeatAct) -> SeatAction:
    return SeatAction(holder="somebody", act=act)


GO_AROUND = done(FlyCommand(command=GoAroundCommand(action="go_around")))
TAKEN, LEFT = done(TakeSeat()), done(LeaveSeat())


def advisory(recommendation: GoAround | None = None) -> Advisory:
    return Advisory(
        id="a-1", revision=1, kind="runway_conflict", severity=Severity.WARNING, traffic=("AAL1",),
        recipient="AAL1", recipients=("AAL1",), message="go around",
        evidence=Evidence(sources=("adsb",)), recommendation=recommendation, t_ready_ns=0,
        active=True,
    )  # fmt: skip


def perceived(way: Any, after_s: float = 0.0, revision: int = 1) -> SeatAction:
    return done(
        PerceiveAdvisory(id="a-1", revision=revision, recipient="AAL1", way=way, after_s=after_s)
    )


def pressed(delay_s: float = 0.0) -> SeatAction:
    return done(PressToTalk(delay_s=delay_s))


def typed(text: str) -> SeatAction:
    return done(SayText(text=text))


def is_take(message: Message) -> bool:
    return isinstance(message, SeatAction) and isinstance(message.act, TakeSeat)


def person(*messages: tuple[float, str, Message], pace: str = "realtime") -> PersonSummary:
    """Return what is known of people in AAL1 after messages at times in s, with keys.

    A person is there all the while if no message tells who is.
    """
    records = PeopleRecords(["AAL1"], pace=pace)
    if not any(is_take(message) for _, _, message in messages):
        records.take("seat/AAL1/do", TAKEN)
    for t_s, key, message in messages:
        records.take(key, message.model_copy(update={"t_ns": round(t_s * SECOND)}))
    return records.summaries(100 * SECOND)[0]


def reaction(*messages: tuple[float, str, Message]) -> PersonReaction:
    return person(*messages).reactions[0]


def test_the_reaction_time_begins_with_the_first_audible_sample() -> None:
    found = reaction(
        (10.0, "advisory/AAL1", advisory(GoAround(runway="01"))),
        (10.1, "seat/AAL1/do", perceived("seen")),
        (10.8, "tts/a-1", VOICE),
        (10.9, "seat/AAL1/do", perceived("heard", after_s=0.1)),
        (12.5, "seat/AAL1/do", GO_AROUND),
    )
    assert found.reaction_time_s == pytest.approx(1.5)
    assert found.voice_to_loudspeaker_s == pytest.approx(0.2)
    assert (found.first_action, found.followed) == ("go_around", True)
    assert found.kind == "runway_conflict"


@pytest.mark.parametrize("is_voiced", [False, True])
def test_what_is_not_heard_is_reacted_to_from_its_display(is_voiced: bool) -> None:
    """A voice that was made is not heard where the page has no sound."""
    found = reaction(
        (10.0, "advisory/AAL1", advisory()),
        (10.1, "seat/AAL1/do", perceived("seen")),
        *([(10.4, "tts/a-1", VOICE)] if is_voiced else []),
        (11.1, "seat/AAL1/do", pressed(0.02)),
    )
    assert found.reaction_time_s == pytest.approx(0.98)  # The press took 0.02 s to the station.
    assert (found.t_heard_s, found.voice_to_loudspeaker_s) == (None, None)
    assert (found.first_action, found.followed) == ("spoken call", None)


@pytest.mark.parametrize("severity", [Severity.CAUTION, Severity.WARNING])
def test_the_first_warning_is_answered_by_the_next_press_of_the_button(severity: Severity) -> None:
    found = person(
        (5.0, "seat/AAL1/do", pressed()),
        (10.0, "advisory/AAL1", advisory().model_copy(update={"severity": severity})),
        (10.5, "seat/AAL1/do", perceived("seen")),
        (11.0, "seat/AAL1/do", perceived("heard")),
        (11.5, "seat/AAL1/do", typed("say again")),
        (12.6, "seat/AAL1/do", pressed(0.1)),
        (20.0, "seat/AAL1/do", pressed()),
    )
    assert found.warning_to_press_s == pytest.approx(2.0)


def test_who_acts_on_what_is_drawn_before_it_is_audible_has_reacted_to_that() -> None:
    found = reaction(
        (10.0, "advisory/AAL1", advisory(GoAround(runway="01"))),
        (10.1, "seat/AAL1/do", perceived("seen")),
        (11.1, "seat/AAL1/do", GO_AROUND),
        (11.5, "seat/AAL1/do", perceived("heard")),
        (40.0, "seat/AAL1/do", pressed()),
    )
    assert (found.counted_from, found.first_action) == ("seen", "go_around")
    assert found.reaction_time_s == pytest.approx(1.0)
    assert found.followed


def test_a_button_pressed_before_the_sound_is_no_reaction_to_it() -> None:
    """The message of the press comes after that of the sound, and says how late it is."""
    found = reaction(
        (10.0, "advisory/AAL1", advisory()),
        (10.5, "seat/AAL1/do", perceived("heard")),
        (10.6, "seat/AAL1/do", pressed(0.3)),
    )
    assert (found.first_action, found.reaction_time_s) == (None, None)


def test_one_action_after_two_advisories_is_the_reaction_to_the_first_alone() -> None:
    second = advisory().model_copy(update={"revision": 2})
    found = person(
        (10.0, "advisory/AAL1", advisory()),
        (10.0, "seat/AAL1/do", perceived("seen")),
        (12.9, "advisory/AAL1", second),
        (12.9, "seat/AAL1/do", perceived("seen", revision=2)),
        (13.0, "seat/AAL1/do", GO_AROUND),
    )
    assert [(one.reaction_time_s, one.is_shared) for one in found.reactions] == [
        (3.0, False), (None, True),
    ]  # fmt: skip
    assert found.reaction_time_s == 3.0


def test_an_action_that_only_the_second_advisory_advises_is_the_reaction_to_that() -> None:
    second = advisory(GoAround(runway="01")).model_copy(update={"revision": 2})
    found = person(
        (10.0, "advisory/AAL1", advisory()),
        (10.0, "seat/AAL1/do", perceived("seen")),
        (11.0, "advisory/AAL1", second),
        (11.0, "seat/AAL1/do", perceived("seen", revision=2)),
        (13.0, "seat/AAL1/do", GO_AROUND),
    )
    assert [one.reaction_time_s for one in found.reactions] == [None, 2.0]


@pytest.mark.parametrize(
    ("paces", "reaction_time_s"),
    [
        ([(1.0, "paused"), (1.0, "realtime")], 2.0),
        ([(1.0, "0.5x")], None),
        ([(11.0, "paused"), (11.0, "realtime")], None),
        ([(13.0, "paused")], 2.0),
        ([(11.0, "stalled")], None),
        ([(9.0, "stalled")], None),  # What was perceived in the stall may be told after it.
        ([(1.0, "stalled")], 2.0),
        ([(12.5, "stalled")], 2.0),
    ],
)
def test_no_reaction_is_measured_while_time_does_not_pass_as_on_the_clock(
    paces: list[tuple[float, str]], reaction_time_s: float | None
) -> None:
    changes = [
        (t_s, "truth/event", Event(kind="pace", subject="run", text=text)) for t_s, text in paces
    ]
    acting = [
        (10.0, "advisory/AAL1", advisory()),
        (10.0, "seat/AAL1/do", perceived("seen")),
        (12.0, "seat/AAL1/do", GO_AROUND),
    ]
    found = reaction(*sorted([*changes, *acting], key=lambda one: one[0]))
    assert found.reaction_time_s == reaction_time_s
    assert found.is_real_time == (reaction_time_s is not None)


def test_advisories_that_reach_nobody_at_the_seat_are_counted() -> None:
    state = state_of("AAL1", recipients=("AAL1", "a1b2c3"))
    to_others = advisory().model_copy(update={"recipient": "DAL2", "id": "a-2"})
    by_address = advisory().model_copy(update={"recipient": "a1b2c3", "id": "a-3"})
    found = person(
        (0.0, "seat/AAL1", state),
        (1.0, "advisory/AAL1", advisory().model_copy(update={"id": "a-0"})),
        (2.0, "seat/AAL1/do", TAKEN),
        (3.0, "advisory/AAL1", advisory()),
        (3.1, "seat/AAL1/do", perceived("seen")),
        (4.0, "advisory/DAL2", to_others),
        (5.0, "advisory/a1b2c3", by_address),
        (6.0, "seat/AAL1/do", LEFT),
        (7.0, "advisory/AAL1", advisory().model_copy(update={"id": "a-4"})),
    )
    assert found.unperceived == 1


@pytest.mark.parametrize("is_unable", [False, True])
def test_advice_that_the_aircraft_is_unable_to_do_is_not_followed(is_unable: bool) -> None:
    unable = Event(kind="unable", subject="AAL1", text="unable to go around")
    found = reaction(
        (10.0, "advisory/AAL1", advisory(GoAround(runway="01"))),
        (10.0, "seat/AAL1/do", perceived("seen")),
        (12.0, "seat/AAL1/do", GO_AROUND),
        *([(12.0, "truth/event", unable)] if is_unable else []),
        (13.0, "truth/event", unable),  # What it cannot do later is no answer to the command.
    )
    assert found.followed is not is_unable
    assert found.reaction_time_s == 2.0


def at_seat(t_s: float, *, is_taken: bool) -> tuple[float, str, Message]:
    return t_s, "seat/AAL1/do", TAKEN if is_taken else LEFT


def test_what_the_next_person_does_is_no_reaction_of_the_one_who_has_left() -> None:
    """Each has a reaction to the advisory, which is in force when the second one comes."""
    found = person(
        at_seat(1.0, is_taken=True),
        (10.0, "advisory/AAL1", advisory(GoAround(runway="01"))),
        (10.0, "seat/AAL1/do", perceived("seen")),
        at_seat(11.0, is_taken=False),
        at_seat(20.0, is_taken=True),
        (20.5, "seat/AAL1/do", perceived("seen")),
        (22.0, "seat/AAL1/do", GO_AROUND),
    )
    assert [(one.t_seen_s, one.reaction_time_s, one.followed) for one in found.reactions] == [
        (10.0, None, False), (20.5, 1.5, True),
    ]  # fmt: skip


def call(
    speaker: str, text: str, t_s: float, addressed: str | None = None, **more: Any
) -> tuple[float, str, Message]:
    t_ns = round(t_s * SECOND)
    said = SpokenTruth(
        id=f"{speaker} {t_s}", speaker=speaker, addressed=addressed, frequency_khz=119_100,
        text=text, t_tx_ns=t_ns, t_end_ns=t_ns, **more,
    )  # fmt: skip
    return t_s, "truth/radio/x", said


CLEARED = call("Tower", "American one two three, runway zero one, cleared to land", 1.0, "AAL123")
RIGHT = "Cleared to land runway zero one, American one two three"
WRONG = "Cleared to land runway one niner, American one two three"


@pytest.mark.parametrize(
    ("text", "t_s", "errors"), [(RIGHT, 5.0, 0), (WRONG, 5.0, 1), (WRONG, 50.0, 0)]
)
def test_a_readback_with_another_runway_is_an_error_of_who_reads_it_back(
    text: str, t_s: float, errors: int
) -> None:
    records = PeopleRecords(["Tower", "AAL123"], ["AAL123"])
    for _, key, message in (CLEARED, call("AAL123", text, t_s)):
        records.take(key, message)
    tower, pilot = records.summaries(100 * SECOND)
    assert (tower.readback_errors, tower.readback_errors_heard) == (0, errors)
    assert (pilot.readback_errors, pilot.readback_errors_heard) == (errors, 0)


def test_a_spoken_readback_counts_as_it_was_recognised() -> None:
    records = PeopleRecords(["AAL123"], ["AAL123"])
    _, _, spoken = call("AAL123", "", 5.0, is_from_microphone=True)
    heard = Transcript(
        id="AAL123 5.0", frequency_khz=119_100, text=WRONG, confidence=0.9, engine="ctc",
        t_tx_ns=5 * SECOND, t_end_ns=5 * SECOND,
    )  # fmt: skip
    for message in (CLEARED[2], spoken, heard):
        records.take("", message)
    assert records.summaries(100 * SECOND)[0].readback_errors == 1


def test_the_workload_is_what_was_answered_and_what_was_not() -> None:
    def asked(t_s: float, number: int, scale: Any) -> tuple[float, str, Message]:
        question = WorkloadQuestion(number=number, scale=scale, asked_ns=round(t_s * SECOND))
        return t_s, "seat/AAL1", state_of("AAL1", question=question)

    ratings = dict.fromkeys(NasaTlx.model_fields, 50)
    found = person(
        asked(60.0, 1, "isa"),
        (64.0, "seat/AAL1/do", done(AnswerQuestion(question=1, isa=4))),
        asked(120.0, 2, "isa"),
        asked(150.0, 3, "nasa_tlx"),
        (150.0, "seat/AAL1/do", done(AnswerQuestion(question=3, nasa_tlx=NasaTlx(**ratings)))),
    ).workload
    assert found is not None
    assert [(one.rating, one.answered_after_s) for one in found.isa] == [(4, 4.0), (None, None)]
    assert (found.isa_mean, found.raw_tlx) == (4.0, 50.0)


def test_the_time_at_the_seat_is_that_for_which_somebody_had_it() -> None:
    """The run ends at 100 s."""
    times = [(10.0, True), (12.0, True), (15.0, False), (16.0, False), (98.0, True)]
    assert person(*(at_seat(t_s, is_taken=taken) for t_s, taken in times)).seat_time_s == 7.0


@pytest.mark.parametrize(
    ("agreed", "consent"),
    [([], None), ([("voice", "words")], "voice"), ([("words",), ()], "none")],
)
def test_consent_is_what_was_agreed_to_last(
    agreed: list[tuple[Use, ...]], consent: str | None
) -> None:
    told = [done(AgreeToUses(uses=uses)) for uses in agreed]
    assert person(*((float(t_s), "seat/AAL1/do", one) for t_s, one in enumerate(told))).consent == (
        consent
    )


def test_consent_is_that_of_the_last_person_at_the_seat_who_has_answered() -> None:
    voice, words = (done(AgreeToUses(uses=uses)) for uses in (("voice",), ("words",)))
    first = [
        at_seat(0.0, is_taken=True),
        (1.0, "seat/AAL1/do", voice),
        at_seat(2.0, is_taken=False),
    ]
    assert person(*first, at_seat(3.0, is_taken=True)).consent == "voice"
    assert person(*first, at_seat(3.0, is_taken=True), (4.0, "seat/AAL1/do", words)).consent == (
        "words"
    )


def on_air(name: str, t_s: float, to_s: float, **more: Any) -> tuple[float, str, SpokenTruth]:
    """Return a call on the air, of AAL1 unless told otherwise, as it is told at its end."""
    said = {"speaker": "AAL1", "addressed": "TOWER", "frequency_khz": 118_300, "text": ""}
    times = {"t_tx_ns": round(t_s * SECOND), "t_end_ns": round(to_s * SECOND)}
    return (
        to_s,
        f"truth/radio/{name}",
        SpokenTruth.model_validate({"id": name} | said | times | more),
    )


def recognised(name: str, text: str, confidence: float = 0.9, engine: str = "ctc") -> Transcript:
    return Transcript(
        id=name, frequency_khz=118_300, t_tx_ns=0, t_end_ns=0, text=text, confidence=confidence,
        engine=engine,
    )  # fmt: skip


def test_a_typed_call_has_a_row_from_the_words_to_the_answer() -> None:
    answer = {"speaker": "TOWER", "addressed": "AAL1", "in_reply_to": "seat.AAL1.1"}
    (row,) = person(
        (10.0, "seat/AAL1/do", typed("ready")),
        on_air("seat.AAL1.1", 12.5, 14.0, text="ready"),
        (14.5, "asr/118300", recognised("seat.AAL1.1", "ready", engine="text")),
        on_air("answer", 15.0, 16.0, text="line up", **answer),
        on_air("again", 18.0, 19.0, text="line up", **answer),
    ).calls
    assert (row.call, row.way, row.said, row.frequency_khz) == (
        "seat.AAL1.1", "typed", "ready", 118_300,
    )  # fmt: skip
    assert (row.t_s, row.t_tx_s, row.to_air_s, row.length_s) == (10.0, 12.5, 2.5, 1.5)
    assert (row.answer, row.answered_after_s, row.blocked) == ("line up", 1.0, False)
    assert (row.recognised, row.confidence) == (None, None)  # Nobody recognised the text.


def test_a_spoken_call_has_a_row_from_the_button_to_what_was_recognised() -> None:
    (row,) = person(
        (10.0, "seat/AAL1/do", pressed(0.25)),
        (12.0, "seat/AAL1/do", done(ReleaseToTalk())),
        on_air("microphone.AAL1.1", 10.0, 12.0, is_from_microphone=True),
        (12.5, "asr/118300", recognised("microphone.AAL1.1", "going around", 0.7)),
        (12.9, "asr/118300", recognised("microphone.AAL1.1", "another opinion")),
    ).calls
    assert (row.way, row.t_s, row.to_air_s, row.length_s) == ("spoken", 9.75, 0.25, 2.0)
    assert (row.said, row.recognised, row.confidence) == (None, "going around", 0.7)
    assert (row.answer, row.answered_after_s) == (None, None)


TALK = (
    (10.0, "seat/AAL1/do", pressed(0.25)),
    on_air("microphone.AAL1.1", 10.0, 12.0, is_from_microphone=True),
)
"""A call that AAL1 began to speak at 9.75 s."""


def of_three(*messages: tuple[float, str, Message]) -> PersonSummary:
    """Return the summary of AAL1, who speaks, beside people at the tower and in DAL2."""
    records = PeopleRecords(["AAL1", "Tower", "DAL2"])
    for seat in ("AAL1", "Tower", "DAL2"):
        records.take(f"seat/{seat}/do", TAKEN)
    for t_s, key, message in messages:
        records.take(key, message.model_copy(update={"t_ns": round(t_s * SECOND)}))
    return records.summaries(100 * SECOND)[0]


def heard(after_s: float = 0.0, call: str = "microphone.AAL1.1") -> SeatAction:
    return done(HearCall(id=call, after_s=after_s))


def test_the_delay_to_several_people_is_the_median() -> None:
    """Each is told of once: by the first that a page says of a call."""
    (row,) = of_three(
        *TALK, (10.25, "seat/Tower/do", heard()), (10.75, "seat/DAL2/do", heard(after_s=0.5)),
        (11.5, "seat/Tower/do", heard()),
    ).calls  # fmt: skip
    assert (row.to_loudspeaker_s, row.heard_at) == (1.0, 2)


@pytest.mark.parametrize(
    ("others", "heard_at"),
    [
        ([(10.5, "seat/AAL1/do", heard())], 0),
        ([(10.5, "seat/Tower/do", heard(call="another"))], 0),
        ([(9.0, "seat/Tower/do", LEFT), (10.5, "seat/Tower/do", heard())], 0),
        ([(10.1, "truth/event", Event(kind="pace", subject="", text="0.5x")),
          (10.5, "seat/Tower/do", heard())], 1),
    ],
    ids=["the speaker", "another call", "nobody at the seat", "slow motion"],
)  # fmt: skip
def test_no_delay_is_measured_of(others: list[tuple[float, str, Message]], heard_at: int) -> None:
    found = of_three(*TALK, *others)
    (row,) = found.calls
    assert (row.to_loudspeaker_s, row.heard_at) == (None, heard_at)
    assert found.press_to_loudspeaker_s is None


def reply(t_s: float, **more: Any) -> list[tuple[float, str, Message]]:
    """Return a call that somebody at the tower types, and as it is on the air."""
    given = {"speaker": "Tower", "addressed": "AAL1", "text": "roger"} | more
    return [
        (t_s, "seat/Tower/do", typed("roger")),
        on_air("seat.Tower.1", t_s, t_s + 1.0, **given),
    ]


def test_a_call_names_the_call_of_another_person_that_came_next() -> None:
    (row,) = of_three(*TALK, *reply(13.5)).calls
    assert (row.next_call, row.next_call_after_s) == ("seat.Tower.1", 1.5)
    assert (row.answer, row.answered_after_s) == (None, None)  # Nobody knows if it is one.


@pytest.mark.parametrize(
    "then",
    [
        reply(42.5),
        reply(13.5, frequency_khz=121_700),
        reply(11.5),
        [on_air("readback", 12.5, 13.0, speaker="UAL9"), *reply(13.5)],
        [on_air("landing", 13.5, 14.5, speaker="Tower")],
        [(13.0, "seat/AAL1/do", typed("x")), on_air("seat.AAL1.1", 13.0, 14.0, text="x")],
    ],
    ids=["late", "elsewhere", "at the same time", "somebody between", "the script", "the same"],
)
def test_no_other_call_may_be_the_answer_of_another_person(
    then: list[tuple[float, str, Message]],
) -> None:
    assert of_three(*TALK, *then).calls[0].next_call is None


def test_a_call_that_was_blocked_and_one_that_never_came_on_the_air_say_so() -> None:
    never, blocked = person(
        (10.0, "seat/AAL1/do", pressed()),
        (20.0, "seat/AAL1/do", pressed()),
        on_air("microphone.AAL1.1", 20.0, 22.0, is_from_microphone=True, blocked_by=("other",)),
        (22.5, "asr/118300", recognised("microphone.AAL1.1", "going around")),
    ).calls
    assert (never.t_s, never.call, never.blocked) == (10.0, None, None)
    assert (blocked.t_s, blocked.blocked) == (20.0, True)
    assert (never.recognised, blocked.recognised) == (None, "going around")


def test_calls_are_written_as_a_table(recorded_run: Path, tmp_path: Path) -> None:
    summary = person(
        (10.0, "seat/AAL1/do", typed("ready")),
        on_air("seat.AAL1.1", 12.5, 14.0, text="ready"),
    ).model_dump(mode="json")
    earlier = {name: value for name, value in summary.items() if name != "calls"}
    table = tmp_path / "people.csv"
    write_people_csv(of_people(recorded_run, tmp_path / "run", [summary, earlier]), table)
    total, row, without = csv.DictReader(table.read_text().splitlines())
    assert (total["row"], row["row"], without["row"]) == ("total", "call", "total")
    assert (row["seat"], row["t_s"], row["said"], row["to_air_s"]) == (
        "AAL1",
        "10.0",
        "ready",
        "2.5",
    )


def of_people(recorded_run: Path, folder: Path, people: Any) -> Run:
    """Return a run with other people in its summary, in a folder of its own."""
    paths = RunFolder(Path(shutil.copytree(recorded_run, folder)))
    paths.summary_path.write_text(json.dumps({"people": people}))
    paths.write_info(paths.info().model_copy(update={"files": paths.manifest()}))
    return open_run(folder)


@pytest.mark.parametrize("people", [[1], [{}], {"a": 1}, 5, [{"seat": "a", "reactions": [0]}]])
def test_people_that_no_run_writes_are_named(
    recorded_run: Path, tmp_path: Path, people: Any
) -> None:
    run = of_people(recorded_run, tmp_path / "run", people)
    with pytest.raises(RunFolderError, match=r"summary\.json: its people cannot be read"):
        write_people_csv(run, tmp_path / "people.csv")
    assert not (tmp_path / "people.csv").exists()
