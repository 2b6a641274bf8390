"""Runs whose radio is noisy, blocked or read: people adapt, and a run is the same every time."""

from __future__ import annotations

import dataclasses
from collections import Counter
from pathlib import Path

from airhilt import load
from airhilt.cosim import Options, run
from airhilt.messages import HearingTruth, SpokenTruth, Transcript
from airhilt.record import read_log
from airhilt.replay import replay
from airhilt.scenario.models import StuckMicrophone

DURATION_S = 75.0
QUIET = Options(latency="fixed", assistant="none", speech=False)


def ran(name: str, out: Path, failures: tuple[StuckMicrophone, ...] = (), **options: object):
    scenario = load(name)
    failures = (*scenario.failures, *failures)
    scenario = scenario.model_copy(update={"failures": failures, "duration_s": DURATION_S})
    run(scenario, dataclasses.replace(QUIET, out=out, **options))
    return Radio(out)


class Radio:
    """What was said and heard in a run."""

    def __init__(self, out: Path) -> None:
        log = list(read_log(out / "log.mcap"))

        def all_of(prefix, model):
            return [
                model.model_validate_json(one.data) for one in log if one.key.startswith(prefix)
            ]

        self.said = all_of("truth/radio/", SpokenTruth)
        self.heard = all_of("truth/hearing/", HearingTruth)
        self.transcripts = all_of("asr/", Transcript)
        self.everything = [(one.key, one.t_ns, one.data) for one in log]


def test_without_noise_every_call_is_said_once_and_understood(tmp_path: Path) -> None:
    radio = ran("s02a_nominal", tmp_path / "run")
    assert [one.id for one in radio.said] == ["clearance", "readback"]
    assert {one.outcome for one in radio.heard} == {"understood"}


def test_in_noise_calls_are_made_again_until_they_are_understood(tmp_path: Path) -> None:
    counts: Counter[str] = Counter()
    for seed in range(3):
        radio = ran("s02a_nominal", tmp_path / f"run{seed}", snr_db=-3.0, seed=seed)
        counts.update(one.outcome for one in radio.heard)
        assert {one.snr_db for one in radio.said} == {-3.0}
    assert counts["missed"] + counts["unsure"] > 0
    assert counts.total() > 6


def test_a_run_in_noise_is_the_same_every_time_and_replays(tmp_path: Path) -> None:
    first = ran("s02a_nominal", tmp_path / "first", snr_db=0.0, seed=3)
    again = ran("s02a_nominal", tmp_path / "again", snr_db=0.0, seed=3)
    assert first.everything == again.everything
    assert replay(tmp_path / "first").identical


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


def test_with_text_a_crew_that_reads_gets_what_one_that_hears_does(tmp_path: Path) -> None:
    hears = ran("s01a_nominal", tmp_path / "hears")
    reads = ran("s01a_nominal", tmp_path / "reads", topology="asr_first")
    assert hears.said == reads.said
    crews = {one.source for one in reads.heard if one.actor in ("AAL123", "DAL456")}
    assert crews == {"transcript"}
    assert [(one.id, one.outcome) for one in hears.heard if one.outcome != "understood"] == []
    assert {one.outcome for one in reads.heard} == {"understood"}
