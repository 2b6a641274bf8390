"""The checker says in words what is wrong with a worker."""

from __future__ import annotations

import re
import runpy
import threading
from collections.abc import Callable, Sequence
from typing import Any

import pytest

from airhilt.assistant.asr.engine import Recognised
from airhilt.assistant.asr.worker import AsrWorker
from airhilt.assistant.vision.worker import VisionWorker
from airhilt.errors import WorkerError
from airhilt.messages import (
    Advisory,
    Evidence,
    InputSpec,
    Modality,
    Severity,
    Transcript,
    WorkerDescription,
)
from airhilt.workers import Input, LocalWorker, Output, Step, check_worker
from airhilt.workers.samples import sample_inputs
from decisions import reference
from paths import EXAMPLES
from pictures import BlobDetector

Doing = Callable[[int], Any]
"""What a worker returns from a step at a time."""


def output(
    key: str = "asr/118300", more: bytes = b"", t_out_ns: int | None = None, **changes: Any
) -> Output:
    """Return a transcript as the output of a worker."""
    transcript = Transcript(
        id="a", frequency_khz=118_300, t_tx_ns=0, t_end_ns=0, text="", confidence=1.0,
        engine="ears", **changes,
    )  # fmt: skip
    return Output(key, transcript.model_dump_json().encode() + more, t_out_ns)


def warning(name: str, recipient: str = "ATC") -> Output:
    """Return an advisory as the output of a worker."""
    advisory = Advisory(
        id=name, revision=0, recipient=recipient, recipients=(recipient,),
        kind="loss_of_separation", severity=Severity.CAUTION, traffic=("AAL123",),
        message="look out", evidence=Evidence(sources=("adsb",)), t_ready_ns=0,
    )  # fmt: skip
    return Output(f"advisory/{recipient}", advisory.model_dump_json().encode())


class Ears:
    """A worker, by default a recogniser without a fault, that does what the test wants."""

    def __init__(
        self,
        do: Doing = lambda _: Step((output(),)),
        wants: str = "radio/*/tx",
        modality: Modality = "asr",
    ) -> None:
        self._do = do
        self.description = WorkerDescription(
            name="ears", modality=modality, inputs=(InputSpec(key=wants),)
        )

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        result: Step = self._do(t_ns)
        return result


def decider(told: Output) -> Ears:
    return Ears(lambda _: Step((told,)), "adsb/*", "decision")


def failing(error: BaseException) -> Doing:
    def fail(_: int) -> None:
        raise error

    return fail


class NoDescription(Ears):
    def __init__(self) -> None:
        self.description = None  # type: ignore[assignment]


class Unreadable(Ears):
    """Has a description that cannot be read."""

    def __init__(self) -> None:
        pass

    @property
    def description(self) -> WorkerDescription:  # type: ignore[override]
        raise KeyError("model")


class Unable(Ears):
    step = None  # type: ignore[assignment]


class Deaf:
    name = "deaf"

    def recognise(self, audio: object, callsigns: Sequence[str]) -> Recognised:
        return Recognised("", (), 1.0)


def step_of(*parts: Any, **more: Any) -> Step:
    """Return a step whose parts may have any type."""
    return Step(*parts, **more)


def output_of(*parts: Any) -> Output:
    """Return an output whose parts may have any type."""
    return Output(*parts)


def test_workers_without_a_fault_pass() -> None:
    for worker in (Ears(), reference(), AsrWorker(Deaf()), VisionWorker(BlobDetector())):
        check_worker(worker)


@pytest.mark.parametrize(
    ("example", "worker"),
    [
        ("sdk_worker", "SimpleWorker"),
        ("asr_worker", "MyRecogniser"),
        ("vision_worker", "MyDetector"),
    ],
)
def test_the_examples_pass(example: str, worker: str) -> None:
    check_worker(runpy.run_path(str(EXAMPLES / f"{example}.py"))[worker]())


@pytest.mark.parametrize(
    ("worker", "words"),
    [
        (NoDescription(), "NoDescription.description is None; expected an airhilt.messages.Worker"),
        (Unreadable(), "Unreadable.description cannot be read: KeyError: 'model'; expected an"),
        (Unable(), "worker 'ears' has no method step(t_ns, inputs)"),
        (Ears, "Ears is a class; expected a worker made of it: Ears()"),
        (Ears(wants="truth/state/*"), "'ears' asks for 'truth/state/*'; truth never reaches a"),
        (Ears(wants="*/118300"), "'ears' asks for '*/118300'; truth never reaches a worker"),
        (Ears(wants="adbs/*"), "asks for 'adbs/*', where nothing is published; expected adsb/*"),
        (decider(warning("1")), "an advisory with the id '1'; expected an id that begins with"),
        (Ears(lambda _: (output(),)), "from step; expected an airhilt.workers.Step"),
        (Ears(lambda _: None), "'ears' returned None from step; expected an airhilt.workers.Step"),
        (
            Ears(lambda t_ns: Step((output(t_ns=t_ns),))),
            "'ears' set t_ns of what it published on 'asr/118300'; leave it out",
        ),
        (
            Ears(lambda _: Step((output("transcript/118300"),))),
            "published on 'transcript/118300'; expected a key under advisory, asr, enhanced, llm",
        ),
        (
            Ears(lambda _: Step((output("asr/121500"),))),
            "a transcript of 118300 kHz; expected the frequency in the key",
        ),
        (
            Ears(lambda _: Step((Output("asr/118300", b"{}"),))),
            "published on 'asr/118300' something that is no Transcript: id, frequency_khz, ",
        ),
        (
            Ears(lambda _: Step((output(more=b" " * 32_000),))),
            "bytes; expected at most 32,000",
        ),
        (
            Ears(lambda t_ns: Step((output(t_out_ns=t_ns - 1),))),
            "wants 'asr/118300' published at 999999999 ns, before its step at 1000000000 ns",
        ),
        (
            Ears(lambda t_ns: Step((), wake_ns=t_ns)),
            "to be called again at 1000000000 ns; expected a later time",
        ),
        (
            Ears(modality="vision"),
            "of modality vision published on 'asr/118300'; expected vision/...",
        ),
        (
            Ears(failing(ValueError("no model"))),
            "worker 'ears' raised ValueError on radio/118300/tx: no model",
        ),
        (Ears(failing(SystemExit(3))), "worker 'ears' raised SystemExit on radio/118300/tx: 3"),
        (
            Ears(lambda _: threading.Event().wait(60.0)),
            "has not answered for 0.2 s to radio/118300/tx; an attached worker that takes",
        ),
    ],
)
def test_a_fault_is_named(worker: Any, words: str) -> None:
    with pytest.raises(WorkerError) as caught:
        check_worker(worker, patience_s=0.2)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("result", "words"),
    [
        (step_of(5), "returned a Step whose outputs are 5; expected a tuple of"),
        (step_of(("x",)), "returned 'x' among its outputs; expected airhilt.workers.Output"),
        (step_of((output_of(5, b"{}"),)), "returned an Output with the key 5; expected a str"),
        (step_of((output_of("k", "{}"),)), "published on 'k' the payload '{}'; expected bytes"),
        (
            step_of((output_of("k", b"", True),)),
            "on 'k' with t_out_ns True; expected an int, in ns",
        ),
        (step_of((), wake_ns=0.5), "a Step with wake_ns 0.5; expected an int, in ns"),
    ],
)
def test_a_part_of_a_step_with_another_type_is_named_by_the_checker_and_in_a_run(
    result: Step, words: str
) -> None:
    worker = Ears(lambda _: result)
    with pytest.raises(WorkerError, match=re.escape(words)) as told:
        check_worker(worker)
    with pytest.raises(WorkerError) as raised:
        LocalWorker(worker).dispatch(0, 0, ()).result()
    assert str(raised.value) == str(told.value)


def test_a_key_of_a_sensor_of_another_package_is_no_fault() -> None:
    check_worker(Ears(wants="temperature/*"))


@pytest.mark.parametrize(
    ("recipient", "words"),
    [
        ("AAL123", "worker 'ears': its CAUTION to AAL123 has no recommendation: nobody acts on it"),
        ("AAL124", "worker 'ears': its CAUTION to AAL124: nobody has that name"),
    ],
)
def test_a_warning_on_which_nobody_acts_is_no_fault_and_is_warned_of(
    recipient: str, words: str
) -> None:
    with pytest.warns(UserWarning, match=words) as told:
        check_worker(decider(warning("ears-1", recipient)))
    assert len(told) == 1


def test_all_faults_are_named_each_once() -> None:
    worker = Ears(failing(ValueError("no model")), wants="truth/radio/*")
    with pytest.raises(WorkerError) as caught:
        check_worker(worker, list(sample_inputs(1_000_000_000))[:2])
    assert [line.split(" ")[2] for line in str(caught.value).splitlines()] == [
        "asks", "raised", "raised",
    ]  # fmt: skip
