"""The numbers of a run, and what they mean."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.cli.progress import print_summary
from airhilt.commands import AltitudeCommand
from airhilt.geodesy.relative_motion import VerticalProfile
from airhilt.messages import (
    AdsbReport,
    Advisory,
    AdvisoryAudio,
    ConflictTruth,
    Evidence,
    HearingTruth,
    Severity,
    SpokenTruth,
    Transcript,
    Transmission,
)
from airhilt.metrics.collector import Collector
from airhilt.metrics.derived import DERIVED
from airhilt.metrics.plans import Plans, Start
from airhilt.metrics.summary import Summary
from airhilt.phraseology.say import speak_callsign
from airhilt.scenario.failures import EffectiveLine
from airhilt.scenario.models import RadioLine, ScriptedCommand
from airhilt.scenario.models.scenario import Scenario
from airhilt.sensors.radio.backends import TextRadio
from airhilt.sensors.radio.script import planned_ends_ns
from airhilt.sim import StepRecord
from airhilt.units import FOOT, FOOT_PER_MINUTE, SECOND_NS
from airhilt.world.flight import load_aircraft_type
from airhilt.world.loading import load
from airhilt.world.truth.conflicts import PairTruth
from straight import Straight, Watch

SCENARIO = load("s02a_headon")
FIRST, SECOND = (actor.callsign for actor in SCENARIO.actors[:2])
PHASES = ("loss_of_separation", "nmac", "collision")
RUN = {"seed": 1, "assistant": "reference", "outcome": "finished", "inputs_dropped": {},
       "real_time_factor": 1.0, "cpu_s": 1.0}  # fmt: skip


def advisory(
    t_s: float,
    severity: str = "CAUTION",
    traffic: tuple[Any, ...] = (FIRST, SECOND),
    revision: int = 0,
    name: str = "a",
    active: bool = True,
) -> Advisory:
    return Advisory(
        t_ns=round(t_s * SECOND_NS), id=name, revision=revision, recipient="ATC",
        recipients=("ATC",), kind="loss_of_separation", severity=Severity(severity),
        active=active, traffic=traffic, message="", evidence=Evidence(sources=("adsb",)),
        t_ready_ns=max(round((t_s - 0.5) * SECOND_NS), 0),
    )  # fmt: skip


def conflict(t_s: float, phase: str) -> ConflictTruth:
    return ConflictTruth.model_validate(
        {"t_ns": round(t_s * SECOND_NS), "phase": phase, "actors": (FIRST, SECOND)}
    )


def report(number: int) -> AdsbReport:
    """Return the first report of an actor: who warns must have been told of both."""
    icao24 = SCENARIO.actors[number].icao24
    return AdsbReport.model_construct(**cast(Any, {"icao24": icao24, "t_adsb_in_ns": 0}))


class FollowedRun:
    """A collector over a head-on encounter that meets after 60 s."""

    def __init__(self, scenario: Scenario = SCENARIO) -> None:
        self.watch = Watch(
            Straight(-15_000.0, east_m_s=250.0),
            Straight(15_000.0, east_m_s=-250.0),
            always=False,
            names=(FIRST, SECOND),
        )
        self.collector = Collector(scenario, 0.0, self.watch.monitor, None, Plans([], {}, {}))
        self.take(report(0)).take(report(1))

    def take(self, message: Any) -> FollowedRun:
        self.collector.take("", message, b"")
        return self

    def open_window(self) -> FollowedRun:
        self.watch.monitor.open_window((FIRST, SECOND), self.watch.now_ns)
        self.collector.window.opened_ns = self.watch.now_ns
        return self

    def close_window(self) -> FollowedRun:
        self.watch.monitor.close_window((FIRST, SECOND))
        self.collector.window.closed_ns = self.watch.now_ns
        return self

    def summary(self, now_s: float = 70.0) -> Summary:
        return self.collector.summary(RUN, round(now_s * SECOND_NS))


def test_the_first_warning_is_the_first_that_is_severe_enough_to_be_spoken() -> None:
    followed = FollowedRun().take(conflict(3.0, "begun"))
    followed.take(advisory(5.0, "ADVISORY")).take(advisory(9.0, "CAUTION", revision=1))
    followed.take(advisory(20.0, "WARNING", revision=2))
    summary = followed.summary()
    assert summary.t_first_warning_s == 9.0
    assert summary.time_to_first_warning_s == 6.0
    (one,) = summary.advisories
    assert (one.severity, one.revisions, one.t_first_s) == ("WARNING", 3, 5.0)


def test_a_warning_before_the_conflict_begins_has_a_negative_time() -> None:
    followed = FollowedRun().take(advisory(9.0)).take(conflict(10.0, "begun"))
    assert followed.summary().time_to_first_warning_s == -1.0


def test_the_time_counts_from_the_begin_of_the_conflict_and_not_from_its_window() -> None:
    followed = FollowedRun().take(conflict(2.0, "begun")).take(conflict(5.0, "opened"))
    summary = followed.take(advisory(9.0)).summary()
    assert (summary.t_conflict_s, summary.t_window_s) == (2.0, 5.0)
    assert summary.time_to_first_warning_s == 7.0
    assert summary.time_to_first_warning_after_call_s is None


def test_a_conflict_is_avoided_if_somebody_was_warned_and_separation_was_kept() -> None:
    followed = FollowedRun()
    assert followed.summary().avoided is None
    followed.open_window()
    assert followed.summary().avoided is None
    followed.take(advisory(9.0))
    assert followed.summary().avoided is True
    followed.watch.fly(70.0)
    summary = followed.summary()
    assert summary.avoided is False
    assert (summary.loss_of_separation, summary.nmac, summary.collision) == (True, True, True)
    assert summary.closest_approach.t_s == pytest.approx(60.0, abs=0.1)
    assert summary.closest_approach.horizontal_m < 1.0


def test_the_closest_approach_is_the_closest_in_the_conflict_window() -> None:
    """The two meet at 60 s, and fly apart with 500 m/s; the window opens at 65 s."""
    followed = FollowedRun().take(advisory(1.0))
    followed.watch.fly(65.0)
    assert followed.summary().closest_approach is None
    assert followed.summary().lead_before_closest_approach_s is None
    followed.open_window().watch.fly(5.0)
    summary = followed.summary()
    assert summary.closest_approach.t_s == pytest.approx(65.0)
    assert summary.closest_approach.horizontal_m == pytest.approx(2_500.0, rel=0.01)
    assert summary.lead_before_closest_approach_s == pytest.approx(64.0)


def test_who_is_warned_after_the_conflict_window_has_not_avoided_the_conflict() -> None:
    followed = FollowedRun()
    followed.open_window().watch.fly(2.0)
    followed.close_window().take(advisory(3.0))
    summary = followed.summary()
    assert summary.t_first_warning_s == 3.0
    assert summary.lead_before_closest_approach_s is None
    assert summary.avoided is None


TIMES = st.none() | st.integers(0, 90)


@settings(max_examples=3000, deadline=None)
@given(warned_s=TIMES, opens_s=TIMES, lasts_s=TIMES, harm=st.sets(st.sampled_from(PHASES)))
def test_avoided_lost_missed_and_no_conflict_exclude_each_other_and_cover_all(
    warned_s: int | None, opens_s: int | None, lasts_s: int | None, harm: set[Any]
) -> None:
    truth = PairTruth(first_ns=dict.fromkeys(harm, 1))
    monitor = SimpleNamespace(
        pairs={(FIRST, SECOND): truth}, time_to_loss_s=lambda _: 60.0,
        flying=lambda _: True, is_seen_by_tcas=lambda _: False,
    )  # fmt: skip
    collector = Collector(SCENARIO, 0.0, cast(Any, monitor), None, Plans([], {}, {}))
    messages: list[AdsbReport | ConflictTruth | Advisory] = [report(0), report(1)]
    if opens_s is not None:
        messages.append(conflict(opens_s, "opened"))
        messages += [] if lasts_s is None else [conflict(opens_s + lasts_s, "closed")]
    if warned_s is not None:
        messages.append(advisory(warned_s))
    for message in sorted(messages, key=lambda one: one.t_ns):
        collector.take("", message, b"")
    summary = collector.summary(RUN, 181 * SECOND_NS)
    row = {each.name: each.value(summary.model_dump()) for each in DERIVED}
    has_opened = opens_s is not None
    expected = {
        "avoided": row["warned"] and not harm,
        "lost": row["warned"] and bool(harm),
        "missed": not row["warned"] and (bool(harm) or has_opened),
        "no_conflict": not row["warned"] and not harm and not has_opened,
    }
    conflict_less = summary.conflict_outcome == "no_conflict"
    assert [name for name, holds in expected.items() if holds] == [summary.conflict_outcome]
    assert (summary.avoided is True) is (summary.conflict_outcome == "avoided")
    assert row["missed"] is (None if conflict_less else summary.conflict_outcome == "missed")


def unassisted(followed: FollowedRun, assistant: str = "none") -> bool | None:
    run = RUN | {"assistant": assistant}
    return followed.collector.summary(run, 70 * SECOND_NS).unassisted_as_declared


def test_a_run_without_an_assistant_tells_whether_the_declared_outcome_came_about() -> None:
    assert unassisted(FollowedRun()) is False
    followed = FollowedRun().open_window()
    assert unassisted(followed) is False
    followed.watch.fly(70.0)
    assert unassisted(followed) is True


@pytest.mark.parametrize(
    ("declared", "phase", "as_declared"),
    [("loss_of_separation", "nmac", True), ("loss_of_separation", "collision", True),
     ("nmac", "collision", True), ("runway_incursion", "collision", True),
     ("nmac", "loss_of_separation", False), ("collision", "nmac", False)],
)  # fmt: skip
def test_the_declared_outcome_or_a_more_severe_one_is_as_declared(
    declared: str, phase: str, as_declared: bool
) -> None:
    assert SCENARIO.conflict is not None
    conflict = SCENARIO.conflict.model_copy(update={"unassisted": declared})
    followed = FollowedRun(SCENARIO.model_copy(update={"conflict": conflict})).open_window()
    followed.watch.fly(1.0)
    followed.watch.monitor.pairs[FIRST, SECOND].first_ns[cast(Any, phase)] = 0
    assert unassisted(followed) is as_declared


def test_the_declared_outcome_is_not_asked_for_with_an_assistant_or_without_a_conflict() -> None:
    assert unassisted(FollowedRun().open_window(), "reference") is None
    assert unassisted(FollowedRun(SCENARIO.model_copy(update={"conflict": None}))) is None


def test_latencies_are_given_by_stage() -> None:
    followed = FollowedRun().take(advisory(9.0)).take(advisory(9.0))
    followed.collector.step(StepRecord("decision", 0, 0, SECOND_NS, 2 * SECOND_NS, 0.0, 1))
    for engine, t_ns in (("text", 9), ("whisper", 3 * SECOND_NS)):
        followed.take(
            Transcript(t_ns=t_ns, id="a", frequency_khz=134325, t_tx_ns=0, t_end_ns=2 * SECOND_NS,
                       text="x", confidence=1.0, engine=engine)
        )  # fmt: skip
    latencies = followed.summary().latencies
    assert (latencies["decision"].n, latencies["decision"].p50_s) == (1, 0.5)
    assert latencies["decision_step"].p50_s == 3.0
    assert (latencies["asr"].n, latencies["asr"].max_s) == (1, 3.0)
    assert (latencies["asr_after_end"].n, latencies["asr_after_end"].max_s) == (1, 1.0)
    assert latencies["tts"].n == 0
    assert latencies["adsb"].n == 0


# --- what the script still has in store -----------------------------------------------------


def plans(*climbs: tuple[float, int], rate_fpm: int | None = 1_500) -> Plans:
    """Plans of a script in which AA, a Cessna 172, is given levels (ft) at times (s)."""
    lines = [
        RadioLine(
            id=f"line{number}", at_s=at_s, speaker="Center", frequency_khz=134325 + number,
            text="one two three four five six seven eight",
            commands=(
                ScriptedCommand(
                    actor="AA", delay_s=2.0,
                    command=AltitudeCommand(
                        action="altitude", altitude_ft=level_ft, vertical_rate_fpm=rate_fpm
                    ),
                ),
            ),
        )
        for number, (at_s, level_ft) in enumerate(climbs)
    ]  # fmt: skip
    effective = [EffectiveLine(line, line, 0.0, (), frozenset()) for line in lines]
    usual_m_s = load_aircraft_type("c172p").speeds.climb_rate_fpm * FOOT_PER_MINUTE
    return Plans(effective, planned_ends_ns(effective, TextRadio(160.0)), {"AA": Start(usual_m_s)})


LEVEL = VerticalProfile(31_000 * FOOT, 0.0)


def feet(altitude_at: Callable[..., Any], *times_s: int) -> list[int]:
    return [round(altitude_at(time_s) / FOOT) for time_s in times_s]


def test_a_climb_that_is_planned_begins_after_its_line_and_its_delay() -> None:
    """A line of eight words at 20 s ends at 23 s; two seconds later it is carried out."""
    at = plans((20.0, 33_000)).altitude_at("AA", 0, LEVEL)
    assert feet(at, 0, 25, 65, 105, 500) == [31_000, 31_000, 32_000, 33_000, 33_000]


def test_a_climb_without_a_rate_is_planned_with_the_usual_one_of_the_type() -> None:
    """A Cessna 172 climbs with 500 ft/min."""
    at = plans((20.0, 33_000), rate_fpm=None).altitude_at("AA", 0, LEVEL)
    assert feet(at, 25, 145, 265, 500) == [31_000, 32_000, 33_000, 33_000]


# --- with a voice ---------------------------------------------------------------------------


def voice(
    t_s: float, revision: int = 0, recipient: str = "ATC", name: str = "a", t_dec_s: float = 9.0
) -> AdvisoryAudio:
    return AdvisoryAudio(
        t_ns=round(t_s * SECOND_NS), id=name, revision=revision, recipient=recipient, text="",
        t_dec_ns=round(t_dec_s * SECOND_NS), engine="espeak", samples=1, sha256="",
    )  # fmt: skip


def told_aloud() -> FollowedRun:
    followed = FollowedRun()
    followed.collector.modalities["tts"] = "on"
    return followed


def test_a_warning_that_is_spoken_counts_from_when_its_voice_begins() -> None:
    followed = told_aloud().take(advisory(9.0)).take(voice(9.8))
    summary = followed.summary()
    assert summary.t_first_warning_s == 9.8
    assert (summary.latencies["tts"].n, summary.latencies["tts"].p50_s) == (1, pytest.approx(0.8))
    (one,) = summary.advisories
    assert (one.t_first_s, one.t_spoken_s) == (9.0, 9.8)


@pytest.mark.parametrize(("outcome", "spoken_s"), [("understood", 9.8), ("misheard", None)])
def test_an_advisory_on_the_frequency_is_spoken_from_when_the_call_begins_that_is_understood(
    outcome: str, spoken_s: float | None
) -> None:
    """The worker has the voice ready at 9.2 s; the frequency is free at 9.8 s."""
    watch = FollowedRun().watch
    collector = Collector(
        SCENARIO, 0.0, watch.monitor, None, Plans([], {}, {}), is_on_frequency=True
    )
    name = f"advisory.a.0.{FIRST}"
    of_call = {"id": name, "t_ns": 12 * SECOND_NS}
    for message in (
        report(0),
        report(1),
        advisory(9.0).model_copy(update={"recipient": FIRST}),
        voice(9.2, recipient=FIRST),
        SpokenTruth(
            **of_call, speaker="assistant", addressed=FIRST, frequency_khz=134_325, text="traffic",
            t_tx_ns=round(9.8 * SECOND_NS), t_end_ns=12 * SECOND_NS,
        ),
        HearingTruth(
            **of_call, actor=FIRST, outcome=cast(Any, outcome), text="traffic", source="ear"
        ),
    ):  # fmt: skip
        collector.take("", message, b"")
    summary = collector.summary(RUN, 70 * SECOND_NS)
    assert summary.t_first_warning_s == spoken_s
    assert summary.advisories[0].t_spoken_s == spoken_s


# --- with a radio ---------------------------------------------------------------------------


def call(
    heard: str | None = None, snr_db: float | None = None, said: str | None = None
) -> list[Any]:
    times = {"id": "a", "frequency_khz": 134_325, "t_tx_ns": 0, "t_end_ns": SECOND_NS}
    text = said or f"{SPOKEN}, maintain flight level three five zero"
    truth = SpokenTruth(**times, speaker="Center", addressed=FIRST, text=text, snr_db=snr_db)
    messages = [truth, Transmission(**times, samples=16_000, snr_db=snr_db)]
    if heard is not None:
        transcript = Transcript(
            t_ns=round(1.25 * SECOND_NS), **times, text=heard, confidence=0.9, engine="embedded"
        )
        messages.append(transcript)
    return messages


SPOKEN = speak_callsign(FIRST, "faa")


def test_the_radio_is_measured_with_the_callsigns_of_the_roster() -> None:
    followed = FollowedRun()
    for message in call(f"{SPOKEN} maintain flight level three four zero", snr_db=10.0):
        followed.take(message)
    radio = followed.summary().radio
    assert (radio.transmissions, radio.calls, radio.snr_db) == (1, 1, 10.0)
    assert (radio.callsign_accuracy, radio.slot_accuracy, radio.false_slots) == (1.0, 0.5, 1)


@pytest.mark.parametrize(("state", "missing"), [("on", 1), ("lost", 1), ("off", None)])
def test_transcripts_are_missing_only_where_somebody_was_to_make_them(
    state: str, missing: int | None
) -> None:
    followed = FollowedRun()
    followed.collector.modalities["asr"] = cast(Any, state)
    for message in call():
        followed.take(message)
    assert followed.summary().radio.transcripts_missing == missing


def test_the_terminal_says_that_a_declared_outcome_did_not_come_about(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    run = RUN | {"assistant": "none"}
    print_summary(FollowedRun().collector.summary(run, 70 * SECOND_NS), tmp_path)
    shown = " ".join(capsys.readouterr().out.split())
    assert "the declared outcome did not come about" in shown


def test_the_terminal_tells_how_well_speech_was_recognised(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    followed = FollowedRun()
    for message in call(f"{SPOKEN} maintain flight level three five zero"):
        followed.take(message)
    print_summary(followed.summary(), tmp_path)
    shown = " ".join(capsys.readouterr().out.split())
    assert "radio 1 transmission" in shown
    assert "word error rate 0.0 %, callsigns 100.0 %, slots 100.0 %, p95 250 ms after" in shown
