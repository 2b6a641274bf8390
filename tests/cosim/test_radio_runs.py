"""Runs whose radio is noisy, blocked or read: people adapt, and a run is the same every time."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from airhilt.audio.pcm import SAMPLE_RATE_HZ
from airhilt.audio.wav import read_wav
from airhilt.cosim.observer import Observer, Snapshot
from airhilt.cosim.replay import replay
from airhilt.cosim.simulation import run
from airhilt.messages import HearingTruth, SpokenTruth, Status, Transcript, Transmission
from airhilt.options import Options
from airhilt.record import RunFolder, read_log
from airhilt.record.audio import audio_file
from airhilt.scenario.models import Scenario, StuckMicrophone
from airhilt.units import SECOND_NS
from nominal import nominal

DURATION_S = 75.0
QUIET = Options(latency="fixed", assistant="none", speech=False)


def ran(name: str, out: Path, failures: tuple[StuckMicrophone, ...] = (), **options: Any) -> Any:
    scenario = nominal(name)
    both = (*scenario.failures, *failures)
    scenario = scenario.model_copy(update={"failures": both, "duration_s": DURATION_S})
    run(scenario, QUIET.model_copy(update={"out": out, **options}))
    return Radio(out)


class Radio:
    """What was said and heard in a run."""

    def __init__(self, out: Path) -> None:
        log = list(read_log(out / "log.mcap"))

        def all_of(prefix: Any, model: Any) -> Any:
            return [
                model.model_validate_json(one.data) for one in log if one.key.startswith(prefix)
            ]

        self.said = all_of("truth/radio/", SpokenTruth)
        self.heard = all_of("truth/hearing/", HearingTruth)
        self.transcripts = all_of("asr/", Transcript)
        self.received = [
            Transmission.model_validate_json(one.data)
            for one in log
            if one.key.startswith("radio/") and one.key.endswith("/tx")
        ]
        self.states = [
            (one.t_ns / SECOND_NS, one.state, one.cause) for one in all_of("status/radio", Status)
        ]
        self.everything = [(one.key, one.t_ns, one.data) for one in log]


def test_without_noise_every_call_is_said_once_and_understood(tmp_path: Path) -> None:
    radio = ran("s02a_nominal", tmp_path / "run")
    assert [one.id for one in radio.said] == ["clearance", "readback"]
    assert {one.outcome for one in radio.heard} == {"understood"}


@pytest.mark.slow
def test_in_noise_calls_are_made_again_until_they_are_understood(tmp_path: Path) -> None:
    counts: Counter[str] = Counter()
    for seed in range(3):
        radio = ran("s02a_nominal", tmp_path / f"run{seed}", snr_db=-3.0, seed=seed)
        counts.update(one.outcome for one in radio.heard)
        assert {one.snr_db for one in radio.said} == {-3.0}
    assert counts["missed"] + counts["unsure"] > 0
    assert counts.total() > 6


def test_a_microphone_stuck_for_ten_minutes_blocks_the_frequency_and_breaks_nothing(
    tmp_path: Path,
) -> None:
    stuck = StuckMicrophone(type="stuck_microphone", actor="AAL123", at_s=1.0, for_s=600.0)
    radio = ran("s02a_nominal", tmp_path / "run", (stuck,))
    said = [one for one in radio.said if not one.id.startswith("stuck")]
    assert said
    assert all(one.blocked_by for one in said)
    assert {one.outcome for one in radio.heard} == {"missed"}
    assert radio.transcripts == []


class Listening(Observer):
    """Keeps what it is told, and interrupts the run if it is asked to."""

    def __init__(self, interrupt_at_s: float = float("inf")) -> None:
        self.notices: list[str] = []
        self._interrupt_at_s = interrupt_at_s

    def snapshot(self, snapshot: Snapshot) -> None:
        if snapshot.t_s >= self._interrupt_at_s:
            raise KeyboardInterrupt

    def notice(self, text: str) -> None:
        self.notices.append(text)


def stuck_at_1_s(for_s: float, duration_s: float) -> Scenario:
    stuck = StuckMicrophone(type="stuck_microphone", actor="AAL123", at_s=1.0, for_s=for_s)
    scenario = nominal("s02a_nominal")
    return scenario.model_copy(update={"failures": (stuck,), "duration_s": duration_s})


SQUELCH_TAIL_S = 0.5
"""No channel adds more than that to a call."""
CARRIER = "stuck-microphone.AAL123.1.134325"


def test_a_microphone_that_is_still_stuck_at_the_end_is_in_the_log_and_the_sounds(
    tmp_path: Path,
) -> None:
    scenario = stuck_at_1_s(600.0, duration_s=22.0)
    result = run(scenario, QUIET.model_copy(update={"out": tmp_path / "run", "speech": True}))
    radio = Radio(tmp_path / "run")
    assert {one.id for one in radio.said} == {CARRIER, "clearance"}
    assert {one.t_end_ns for one in (*radio.said, *radio.received)} == {22 * SECOND_NS}
    for one in radio.received:
        sound = read_wav(audio_file(RunFolder(tmp_path / "run").audio_path, one))
        lasts_s = (one.t_end_ns - one.t_tx_ns) / SECOND_NS
        assert len(sound) / SAMPLE_RATE_HZ == pytest.approx(lasts_s, abs=SQUELCH_TAIL_S)
    assert result.summary.radio.stuck_microphone == 1
    assert replay(tmp_path / "run").identical


def test_that_the_radio_is_blocked_is_told_and_that_it_is_free_again(tmp_path: Path) -> None:
    observer = Listening()
    options = QUIET.model_copy(update={"out": tmp_path / "run"})
    result = run(stuck_at_1_s(4.0, duration_s=8.0), options, observer)
    cause = "AAL123: its microphone is stuck for 4 s"
    assert Radio(tmp_path / "run").states == [
        (0.0, "on", ""), (1.0, "lost", cause), (5.0, "on", ""),
    ]  # fmt: skip
    assert observer.notices == [
        "radio blocked at 1.0 s by AAL123: its microphone is stuck for 4 s",
        "radio free again at 5.0 s",
    ]
    assert result.summary.modalities["radio"] == "on"


def test_a_run_that_is_interrupted_under_a_stuck_microphone_replays(tmp_path: Path) -> None:
    options = QUIET.model_copy(update={"out": tmp_path / "run"})
    with pytest.raises(KeyboardInterrupt):
        run(stuck_at_1_s(600.0, duration_s=60.0), options, Listening(interrupt_at_s=5.0))
    assert [(one.id, one.t_end_ns) for one in Radio(tmp_path / "run").said] == [
        (CARRIER, 5 * SECOND_NS)
    ]
    assert replay(tmp_path / "run").identical


def test_with_text_a_crew_that_reads_gets_what_one_that_hears_does(tmp_path: Path) -> None:
    hears = ran("s01a_nominal", tmp_path / "hears")
    reads = ran("s01a_nominal", tmp_path / "reads", topology="asr_first")
    assert hears.said == reads.said
    crews = {one.source for one in reads.heard if one.actor in ("AAL123", "DAL456")}
    assert crews == {"transcript"}
    assert [(one.id, one.outcome) for one in hears.heard if one.outcome != "understood"] == []
    assert {one.outcome for one in reads.heard} == {"understood"}
