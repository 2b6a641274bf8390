"""Workers get what they asked for and may publish only what is theirs."""

from dataclasses import dataclass, field

import pytest

from airhilt.errors import WorkerError
from airhilt.messages import InputSpec, Transcript, WorkerDescription
from airhilt.sim import Director, Input, Output, Priority, Virtual, parse_latency
from airhilt.workers.pool import Participant, WorkerPool, parse_output, policy_of
from airhilt.workers.protocol import LocalWorker, Step

SAID = Transcript(
    id="1", frequency_khz=134325, t_tx_ns=0, t_end_ns=5, text="hello", confidence=1.0, engine="text"
)


@dataclass
class Listener:
    """A worker that answers each input with one output, or raises."""

    key: str
    name: str = "listener"
    policy: str = "fifo"
    output: Output | None = None
    failure: Exception | None = None
    heard: list = field(default_factory=list)

    @property
    def description(self):
        inputs = (InputSpec(key=self.key, policy=self.policy),)
        return WorkerDescription(name=self.name, modality="decision", inputs=inputs)

    def step(self, t_ns, inputs):
        if self.failure is not None:
            raise self.failure
        self.heard += [(t_ns, item.key) for item in inputs]
        return Step(() if self.output is None else (self.output,))


@dataclass
class Run:
    workers: list
    latency: str = "fixed:1"

    def __post_init__(self):
        self.director = Director(Virtual())
        self.published, self.steps, self.losses = [], [], []
        self.pool = WorkerPool(
            self.director,
            [Participant(w.description, LocalWorker(w), attached=False) for w in self.workers],
            parse_latency(self.latency),
            1,
            publish=lambda key, message, worker: self.published.append((key, message, worker)),
            done=self.steps.append,
            lost=lambda description, cause: self.losses.append((description.name, cause)),
        )

    def say(self, key, t_ns=0):
        message = SAID.model_copy(update={"t_ns": t_ns})
        data = message.model_dump_json().encode()
        self.director.at(t_ns, lambda: self.pool.offer(key, message, data), Priority.SENSOR)


@pytest.mark.parametrize(
    ("key", "pattern", "wanted"),
    [
        ("adsb/a1b2c3", "adsb/*", True),
        ("adsb/a1b2c3", "adsb/a1b2c3", True),
        ("adsb/a1b2c3", "adsb/a1b2c4", False),
        ("adsb/a1b2c3", "asr/*", False),
        ("radio/134325/tx", "radio/*/tx", True),
        ("radio/134325/tx", "radio/*", False),
        ("adsb", "adsb/*", False),
    ],
)
def test_a_star_stands_for_one_chunk(key, pattern, wanted):
    assert (policy_of(key, {pattern: "batch"}) is not None) == wanted


def test_a_message_reaches_those_who_want_it_and_nobody_else():
    one, two = Listener("asr/*", "one"), Listener("adsb/*", "two")
    run = Run([one, two])
    run.say("asr/134325", 7)
    run.director.run()
    assert one.heard == [(7, "asr/134325")]
    assert two.heard == []


def test_what_a_worker_says_is_stamped_when_its_latency_has_passed():
    data = SAID.model_copy(update={"t_ns": 3}).model_dump_json().encode()
    run = Run([Listener("asr/1", output=Output("asr/134325", data))])
    run.say("asr/1", 500)
    run.director.run()
    ((key, message, worker),) = run.published
    assert (key, worker) == ("asr/134325", "listener")
    assert message == SAID.model_copy(update={"t_ns": 1_000_000_500})


@pytest.mark.parametrize("key", ["truth/state/AAL123", "**", "*", "*/state/AAL123"])
def test_nobody_may_ask_for_truth(key):
    with pytest.raises(WorkerError, match="truth never reaches a worker"):
        Run([Listener(key)])


@pytest.mark.parametrize("key", ["truth/state/AAL123", "adsb/a1b2c3", "clock", "worker/x/step"])
def test_a_worker_may_not_publish_truth_or_what_sensors_give(key):
    with pytest.raises(WorkerError, match="expected a key under advisory, asr"):
        parse_output("w", key, b"{}", 0)


@pytest.mark.parametrize("payload", [b"", b"\xff", b"[]", b"{}", b'{"id": 5}'])
def test_a_worker_that_publishes_nonsense_is_told_what_is_wrong(payload):
    with pytest.raises(WorkerError, match=r"no Transcript.*airhilt schema"):
        parse_output("w", "asr/134325", payload, 0)


def test_a_worker_that_raises_is_lost_and_the_others_go_on():
    bad = Listener("asr/*", "bad", failure=ZeroDivisionError("by zero"))
    good = Listener("asr/*", "good")
    run = Run([bad, good])
    run.say("asr/1", 0)
    run.say("asr/1", 2_000_000_000)
    run.director.run()
    assert run.losses == [("bad", "worker 'bad' failed: ZeroDivisionError: by zero")]
    assert len(good.heard) == 2


def test_dropped_inputs_are_counted_by_worker_and_key():
    run = Run([Listener("asr/*", "one", policy="latest")])
    for t_ns in range(4):
        run.say("asr/1", t_ns)
    run.director.run()
    assert run.pool.inputs_dropped() == {"one: asr/1": 2}


def test_a_step_that_the_end_of_the_run_cuts_off_is_told():
    run = Run([Listener("asr/*", "one")])
    run.say("asr/1", 5)
    run.director.at(6, run.director.stop, Priority.OBSERVE)
    run.director.run()
    (step,) = run.pool.unfinished()
    assert (step.worker, step.t_start_ns, step.finished) == ("one", 5, False)


def test_an_input_carries_the_time_at_which_it_came():
    seen = []
    listener = Listener("asr/*", "one")
    listener.step = lambda t_ns, inputs: seen.extend(inputs) or Step()
    run = Run([listener])
    run.say("asr/1", 5)
    run.director.run()
    (item,) = seen
    assert isinstance(item, Input)
    assert (item.key, item.t_in_ns) == ("asr/1", 5)
    assert Transcript.model_validate_json(item.payload).text == "hello"
