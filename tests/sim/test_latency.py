"""Where latencies come from, and that what is drawn can be drawn again."""

from __future__ import annotations

import statistics
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.errors import AirhiltError
from airhilt.sim import LatencySpec, parse_latency
from airhilt.sim.latency import LEAST_NS
from airhilt.units import seconds_to_ns


def drawn(
    text: str,
    worker: str = "asr",
    seed: int = 1,
    steps: int = 5,
    median_s: float = 0.4,
    sigma: float = 0.25,
) -> list[Any]:
    source = parse_latency(text).source(worker, seed, median_s, sigma)
    return [source.known_ns(seq) for seq in range(steps)]


def test_a_latency_source_is_written_as_it_was_typed(subtests: pytest.Subtests) -> None:
    table = [
        "measured",
        "fixed",
        "fixed:0.25",
        "lognormal",
        "lognormal:5.9",
        "replay:runs/a,b",
        "fixed,asr=lognormal:5.9,tts=fixed:0.9",
        "fixed,asr=since_start:5.88,decision=on_output:0.4",
    ]
    for text in table:
        with subtests.test(text):
            assert parse_latency(text).text == text


def test_any_other_is_refused_and_the_message_says_what_is_expected(
    subtests: pytest.Subtests,
) -> None:
    table = ["", "slow", "fixed:", "fixed:x", "fixed:-1", "fixed:nan", "fixed:3601", "fixed:inf",
     "replay", "replay:", "lognormal:x", "measured:2", "Fixed", "fixed,measured", "fixed,",
     "since_start", "on_output", "paper", "asr=", "=fixed",
     "asr=slow", "asr=fixed,asr=fixed", "fixed,asr=replay:runs/a"]  # fmt: skip
    for text in table:
        with subtests.test(text):
            with pytest.raises(AirhiltError) as caught:
                parse_latency(text)
            message = str(caught.value)
            assert repr(text) in message
            for form in ("measured", "fixed", "fixed:SECONDS", "lognormal:MEDIAN", "replay:RUN"):
                assert form in message


def test_a_stage_has_its_own_source_and_the_others_have_that_of_the_run() -> None:
    spec = parse_latency("asr=fixed:5.9,fixed:0.1,tts=measured")
    known = [
        spec.of(stage).source("a", 1, 0.4, 0.2).known_ns(0) for stage in ("asr", "vision", "tts")
    ]
    assert known == [5_900_000_000, 100_000_000, None]
    assert parse_latency("asr=fixed:5.9").of("vision", is_of_user=True).kind == "measured"


@pytest.mark.parametrize("text", [None, "asr=fixed:5.9"])
def test_without_a_source_only_what_the_user_brings_is_measured(text: str | None) -> None:
    spec = parse_latency(text)
    assert (spec.of("vision").kind, spec.of("vision", is_of_user=True).kind) == (
        "fixed", "measured",
    )  # fmt: skip


def test_a_source_that_is_given_is_for_what_the_user_brings_too() -> None:
    assert parse_latency("lognormal").of("vision", is_of_user=True).kind == "lognormal"


def test_a_lognormal_latency_has_the_median_that_is_given() -> None:
    latencies = drawn("lognormal:5.9", steps=1000)
    assert statistics.median(latencies) == pytest.approx(5.9e9, rel=0.05)


def test_fixed_is_what_was_given_or_else_what_the_worker_declares() -> None:
    assert drawn("fixed:0.25", steps=2) == [250_000_000] * 2
    assert drawn("fixed", steps=2) == [400_000_000] * 2
    assert drawn("fixed:0", steps=2) == [0, 0]


@settings(deadline=None, max_examples=30)
@given(seed=st.integers(0, 2**63), step=st.integers(0, 10_000))
def test_a_lognormal_latency_depends_on_seed_worker_and_step_alone(seed: int, step: int) -> None:
    def latency(worker: str, run_seed: int) -> int:
        source = parse_latency("lognormal").source(worker, run_seed, 0.4, 0.25)
        known = source.known_ns(step)
        assert known is not None
        return known

    alone = latency("asr", seed)
    latency("vision", seed)
    assert latency("asr", seed) == alone
    assert latency("asr", seed + 1) != alone
    assert latency("vision", seed) != alone
    assert alone > 0


def test_lognormal_latencies_differ_from_step_to_step_about_the_declared_median() -> None:
    latencies = drawn("lognormal", steps=1000)
    assert len(set(latencies)) > 990
    assert statistics.median(latencies) == pytest.approx(0.4e9, rel=0.05)


def test_a_replay_gives_what_the_earlier_run_had() -> None:
    spec = LatencySpec("replay", replay_of="runs/a", recorded={"asr": {0: 7, 1: 9}})
    source = spec.source("asr", 1, 0.4, 0.25)
    assert [source.known_ns(0), source.known_ns(1)] == [7, 9]


@pytest.mark.parametrize("worker", ["asr", "vision"])
def test_a_step_that_the_earlier_run_did_not_have_is_an_error_that_names_it(worker: str) -> None:
    spec = LatencySpec("replay", replay_of="runs/a", recorded={"asr": {0: 7, 1: 9}})
    with pytest.raises(AirhiltError) as caught:
        spec.source(worker, 1, 0.4, 0.25).known_ns(2)
    message = str(caught.value)
    assert repr(worker) in message
    assert "step 2" in message
    assert "same scenario, seed and workers" in message


# --- counted from the start, or for outputs only --------------------------------------------


def test_a_time_since_the_start_leaves_what_has_not_passed_yet() -> None:
    source = parse_latency("since_start:6").source("asr", 1, 0.4, 0.25)
    whole = source.known_ns(3, 0)
    assert whole is not None
    assert source.known_ns(3, seconds_to_ns(2.0)) == whole - seconds_to_ns(2.0)
    assert source.known_ns(3, seconds_to_ns(60.0)) == LEAST_NS
    assert source.known_ns(3) == 0


def test_times_since_the_start_have_the_mean_that_was_given() -> None:
    source = parse_latency("since_start:6").source("asr", 1, 0.4, 0.25)
    times = [known for seq in range(8000) if (known := source.known_ns(seq, 0)) is not None]
    assert statistics.mean(times) / 1e9 == pytest.approx(6.0, rel=0.002)


def test_only_steps_with_outputs_take_time_where_that_is_said() -> None:
    source = parse_latency("on_output:0.4").source("decision", 1, 0.1, 0.25)
    assert source.known_ns(0) is None
    assert [source.settled_ns(7.0, outputs) for outputs in (0, 1, 3)] == [
        0, 400_000_000, 400_000_000,
    ]  # fmt: skip


def test_a_name_stands_for_a_text_and_single_stages_may_differ() -> None:
    presets = {"published": "fixed,asr=since_start:5.88,tts=fixed:0.9"}
    assert parse_latency("published", presets).text == presets["published"]
    assert parse_latency("tts=fixed:0.2,published", presets).of("tts").given_s == 0.2
    assert parse_latency("tts=fixed:0.2,published", presets).of("asr").given_s == 5.88
    with pytest.raises(AirhiltError):
        parse_latency("published,fixed", presets)
