"""Workers get what they asked for and may publish only what is theirs."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import pytest

from airhilt.errors import SpeechError, VisionError, WorkerError
from airhilt.host.services import HttpService
from airhilt.messages import (
    AdvisoryAudio,
    InputSpec,
    Message,
    Transcript,
    Transmission,
    WorkerDescription,
)
from airhilt.sim import Director, Input, Output, Priority, Virtual, WorkerLost, parse_latency
from airhilt.workers.pool import Participant, WorkerPool, parse_output, policy_of
from airhilt.workers.protocol import LocalWorker, Step

SAID = Transcript(
    id="1", frequency_khz=134325, t_tx_ns=0, t_end_ns=5, text="hello", confidence=1.0, engine="text"
)
PCM = bytes(range(200)) * 16
RECEIVED = Transmission(
    t_ns=7,
    id="1",
    frequency_khz=134325,
    t_tx_ns=2,
    t_end_ns=7,
    samples=len(PCM) // 2,
    sha256=hashlib.sha256(PCM).hexdigest(),
)
VOICE = AdvisoryAudio(
    id="decision-1",
    revision=0,
    recipient="AAL123",
    text="Traffic",
    t_dec_ns=4,
    engine="tone",
    samples=len(PCM) // 2,
    sha256=hashlib.sha256(PCM).hexdigest(),
)


@dataclass
class Listener:
    """A worker that answers each input with one output, or raises."""

    key: str
    name: str = "listener"
    policy: str = "fifo"
    output: Output | None = None
    failure: BaseException | None = None
    heard: list[Any] = field(default_factory=list)
    inputs: list[Any] = field(default_factory=list)

    @property
    def description(self) -> WorkerDescription:
        inputs = (InputSpec(key=self.key, policy=self.policy),)
        return WorkerDescription(name=self.name, modality="decision", inputs=inputs)

    def step(self, t_ns: int, inputs: tuple[Input]) -> Step | None:
        if self.failure is not None:
            raise self.failure
        self.heard += [(t_ns, item.key) for item in inputs]
        self.inputs += inputs
        return Step(() if self.output is None else (self.output,))


@dataclass
class Run:
    workers: list[Any]
    latency: str = "fixed:1"

    def __post_init__(self) -> None:
        self.director = Director(Virtual())
        self.published: list[Any] = []
        self.raw: list[bytes | None] = []
        self.steps: list[Any] = []
        self.losses: list[tuple[str, Any]] = []
        self.losses_of_machine = 0
        self.pool = WorkerPool(
            self.director,
            [Participant(w.description, LocalWorker(w), where="in process") for w in self.workers],
            parse_latency(self.latency),
            1,
            publish=self.publish,
            done=self.steps.append,
            lost=self.lost,
        )

    def lost(self, description: WorkerDescription, cause: str, is_of_machine: bool) -> None:
        self.losses.append((description.name, cause))
        self.losses_of_machine += is_of_machine

    def publish(
        self,
        key: str,
        message: Message,
        publisher: str,
        raw: bytes | None = None,
    ) -> None:
        self.published.append((key, message, publisher))
        self.raw.append(raw)

    def say(self, key: str, t_ns: int = 0) -> None:
        message = SAID.model_copy(update={"t_ns": t_ns})
        self.offer(key, message, message.model_dump_json().encode())

    def offer(self, key: str, message: Transcript | Transmission, data: bytes) -> None:
        give = partial(self.pool.offer, key, message, data)
        self.director.at(message.t_ns, give, Priority.SENSOR)


@pytest.mark.parametrize(
    ("key", "pattern", "wanted"),
    [
        ("adsb/a1b2c3", "adsb/*", True),
        ("adsb/a1b2c3", "adsb/a1b2c3", True),
        ("adsb/a1b2c3", "asr/*", False),
        ("radio/134325/tx", "radio/*/tx", True),
        ("radio/134325/tx", "radio/*", False),
        ("adsb", "adsb/*", False),
    ],
)
def test_a_star_stands_for_one_chunk(key: str, pattern: str, wanted: bool) -> None:
    assert (policy_of(key, {pattern: "batch"}) is not None) == wanted


def test_a_message_reaches_those_who_want_it_and_nobody_else() -> None:
    one, two = Listener("asr/*", "one"), Listener("adsb/*", "two")
    run = Run([one, two])
    run.say("asr/134325", 7)
    run.director.run()
    assert one.heard == [(7, "asr/134325")]
    assert two.heard == []


def test_what_a_worker_says_is_stamped_when_its_latency_has_passed() -> None:
    data = SAID.model_copy(update={"t_ns": 3}).model_dump_json().encode()
    run = Run([Listener("asr/1", output=Output("asr/134325", data))])
    run.say("asr/1", 500)
    run.director.run()
    ((key, message, worker),) = run.published
    assert (key, worker) == ("asr/134325", "listener")
    assert message == SAID.model_copy(update={"t_ns": 1_000_000_500})


@pytest.mark.parametrize("key", ["truth/state/*", "*/118300", "$*/state", "command/*", "seat/**"])
def test_nobody_may_ask_for_truth_or_what_single_people_enter(key: str) -> None:
    with pytest.raises(WorkerError, match=r"truth never reaches a worker|reach no worker"):
        Run([Listener(key)])


@pytest.mark.parametrize("key", ["truth/state/AAL123", "adsb/a1b2c3", "radio/134325/tx"])
def test_a_worker_may_not_publish_truth_or_what_sensors_give(key: str) -> None:
    with pytest.raises(WorkerError, match="expected a key under advisory, asr"):
        parse_output("w", key, b"{}", 0)


@pytest.mark.parametrize("payload", [b"\xff", b"{}"])
def test_a_worker_that_publishes_nonsense_is_told_what_is_wrong(payload: bytes) -> None:
    with pytest.raises(WorkerError, match=r"no Transcript.*airhilt schema"):
        parse_output("w", "asr/134325", payload, 0)


def test_a_worker_that_raises_is_lost_and_the_others_go_on() -> None:
    bad = Listener("asr/*", "bad", failure=ZeroDivisionError("by zero"))
    good = Listener("asr/*", "good")
    run = Run([bad, good])
    run.say("asr/1", 0)
    run.say("asr/1", 2_000_000_000)
    run.director.run()
    assert run.losses == [("bad", "worker 'bad' failed: ZeroDivisionError: by zero")]
    assert len(good.heard) == 2


@pytest.mark.parametrize(
    ("failure", "is_of_machine"),
    [
        (ZeroDivisionError("by zero"), False),
        (SystemExit("bye"), False),
        (VisionError("a model that is none"), False),
        (MemoryError(), True),
        (HttpService("asr", "http://h/", 1.0, 1, SpeechError).error("is slow", "haste"), True),
    ],
)
def test_a_worker_that_another_machine_would_have_kept_is_told_apart(
    failure: BaseException, is_of_machine: bool
) -> None:
    run = Run([Listener("asr/*", "bad", failure=failure)])
    run.say("asr/1")
    run.director.run()
    assert len(run.losses) == 1
    assert run.losses_of_machine == is_of_machine


def test_the_description_of_a_worker_is_read_once() -> None:
    class Changing(Listener):
        reads = 0

        @property
        def description(self) -> WorkerDescription:
            self.reads += 1
            if self.reads > 1:
                raise ValueError("read again")
            return super().description

    worker = Changing("asr/*", failure=ValueError("no model"))
    step = LocalWorker(worker).dispatch(0, 0, ())  # type: ignore[arg-type]
    with pytest.raises(WorkerLost, match="worker 'listener' failed: ValueError: no model"):
        step.result()


def test_dropped_inputs_are_counted_by_worker_and_key() -> None:
    run = Run([Listener("asr/*", "one", policy="latest")])
    for t_ns in range(4):
        run.say("asr/1", t_ns)
    run.director.run()
    assert run.pool.inputs_dropped() == {"one: asr/1": 2}


def test_a_step_that_the_end_of_the_run_cuts_off_is_told() -> None:
    run = Run([Listener("asr/*", "one")])
    run.say("asr/1", 5)
    run.director.at(6, run.director.stop, Priority.OBSERVE)
    run.director.run()
    (step,) = run.pool.unfinished()
    assert (step.worker, step.t_start_ns, step.finished) == ("one", 5, False)


def test_audio_comes_as_raw_bytes_with_its_header_beside_it() -> None:
    listener = Listener("radio/*/tx")
    run = Run([listener])
    run.offer("radio/134325/tx", RECEIVED, PCM)
    run.director.run()
    (item,) = listener.inputs
    assert (item.key, item.t_in_ns, item.payload) == ("radio/134325/tx", 7, PCM)
    assert Transmission.model_validate(item.attachment) == RECEIVED


def test_a_voice_is_published_as_raw_bytes_with_its_header() -> None:
    voice = Output("tts/decision-1", PCM, attachment=VOICE.model_dump(mode="json"))
    run = Run([Listener("asr/*", "tts", output=voice)])
    run.say("asr/1", 500)
    run.director.run()
    stamped = VOICE.model_copy(update={"t_ns": 1_000_000_500})
    assert run.published == [("tts/decision-1", stamped, "tts")]
    assert run.raw == [PCM]


@pytest.mark.parametrize(
    ("key", "pcm", "said"),
    [
        ("tts/decision-2", PCM, "voice of advisory 'decision-1'; expected the advisory's id"),
        ("tts/decision-1", PCM[:-2], "3198 bytes .* expected 1600 samples of 16 bits"),
        ("tts/decision-1", PCM[::-1], f"SHA-256 {VOICE.sha256}"),
    ],
    ids=["another key", "too short", "other samples"],
)
def test_a_voice_that_is_not_what_its_header_says_is_refused(
    key: str, pcm: bytes, said: str
) -> None:
    with pytest.raises(WorkerError, match=f"worker 'w' published on '{key}' .*{said}"):
        parse_output("w", key, pcm, 10, VOICE.model_dump(mode="json"))


@pytest.mark.parametrize(
    ("header", "said"),
    [
        (None, "worker 'w' .* no AdvisoryAudio.*airhilt schema"),
        (VOICE.model_dump(mode="json") | {"sample_rate_hz": 22_050}, "at 22050 Hz; expected 16000"),
    ],
    ids=["none", "another rate"],
)
def test_a_voice_without_its_header_is_refused(header: dict[str, Any] | None, said: str) -> None:
    with pytest.raises(WorkerError, match=said):
        parse_output("w", "tts/decision-1", PCM, 10, header)
