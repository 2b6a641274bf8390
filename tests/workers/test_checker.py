"""The checker says in words what is wrong with a worker."""

from __future__ import annotations

import re
import runpy
import threading
from collections.abc import Sequence
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


class Ears:
    """A recogniser without a fault."""

    wants = "radio/*/tx"
    modality: Modality = "asr"

    def __init__(self) -> None:
        self.description = WorkerDescription(
            name="ears", modality=self.modality, inputs=(InputSpec(key=self.wants),)
        )

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        return Step(tuple(self.heard(t_ns, item) for item in inputs))

    def heard(self, t_ns: int, item: Input) -> Output:
        return Output("asr/118300", self.transcript(t_ns).model_dump_json().encode())

    def transcript(self, t_ns: int) -> Transcript:
        return Transcript(
            id="a", frequency_khz=118_300, t_tx_ns=0, t_end_ns=0, text="", confidence=1.0,
            engine="ears",
        )  # fmt: skip


class NoDescription(Ears):
    def __init__(self) -> None:
        self.description = None  # type: ignore[assignment]


class Cheat(Ears):
    wants = "truth/state/*"


class AllEars(Ears):
    wants = "*/118300"


class Misspelt(Ears):
    wants = "adbs/*"


class Nameless(Ears):
    """A decision worker whose ids another one may have too."""

    modality: Modality = "decision"
    wants = "adsb/*"

    def heard(self, t_ns: int, item: Input) -> Output:
        advisory = Advisory(
            id="1", revision=0, recipient="ATC", recipients=("ATC",), kind="loss_of_separation",
            severity=Severity.CAUTION, traffic=("AAL123",), message="look out",
            evidence=Evidence(sources=("adsb",)), t_ready_ns=t_ns,
        )  # fmt: skip
        return Output("advisory/ATC", advisory.model_dump_json().encode())


class Talkative(Ears):
    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        return super().step(t_ns, inputs).outputs  # type: ignore[return-value]


class Forgetful(Ears):
    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        super().step(t_ns, inputs)
        return None  # type: ignore[return-value]


def step_of(*parts: Any, **more: Any) -> Step:
    """Return a step whose parts may have any type."""
    return Step(*parts, **more)


def output_of(*parts: Any) -> Output:
    """Return an output whose parts may have any type."""
    return Output(*parts)


class Odd(Ears):
    """Returns what the test puts in its class."""

    result: object = None

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        return self.result  # type: ignore[return-value]


class Unreadable(Ears):
    """Has a description that cannot be read."""

    def __init__(self) -> None:
        pass

    @property
    def description(self) -> WorkerDescription:  # type: ignore[override]
        raise KeyError("model")


class Unable(Ears):
    step = None  # type: ignore[assignment]


class Quitting(Ears):
    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        raise SystemExit(3)


class Stamping(Ears):
    def transcript(self, t_ns: int) -> Transcript:
        return super().transcript(t_ns).model_copy(update={"t_ns": t_ns})


class WrongKey(Ears):
    def heard(self, t_ns: int, item: Input) -> Output:
        return Output("transcript/118300", super().heard(t_ns, item).payload)


class WrongFrequency(Ears):
    def heard(self, t_ns: int, item: Input) -> Output:
        return Output("asr/121500", super().heard(t_ns, item).payload)


class Garbage(Ears):
    def heard(self, t_ns: int, item: Input) -> Output:
        return Output("asr/118300", b"{}")


class Large(Ears):
    def heard(self, t_ns: int, item: Input) -> Output:
        return Output("asr/118300", super().heard(t_ns, item).payload + b" " * 32_000)


class Early(Ears):
    def heard(self, t_ns: int, item: Input) -> Output:
        return Output("asr/118300", super().heard(t_ns, item).payload, t_out_ns=t_ns - 1)


class Restless(Ears):
    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        return Step((), wake_ns=t_ns)


class Eyes(Ears):
    modality: Modality = "vision"


class Raising(Ears):
    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        raise ValueError("no model")


class Hanging(Ears):
    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        threading.Event().wait(60.0)
        return Step()


class Deaf:
    name = "deaf"

    def recognise(self, audio: object, callsigns: Sequence[str]) -> Recognised:
        return Recognised("", (), 1.0)


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
        (NoDescription, "NoDescription.description is None; expected an airhilt.messages.Worker"),
        (Cheat, "'ears' asks for 'truth/state/*'; truth never reaches a worker"),
        (AllEars, "'ears' asks for '*/118300'; truth never reaches a worker"),
        (Misspelt, "asks for 'adbs/*', where nothing is published; expected adsb/*"),
        (Nameless, "an advisory with the id '1'; expected an id that begins with its name"),
        (Talkative, "from step; expected an airhilt.workers.Step"),
        (Forgetful, "worker 'ears' returned None from step; expected an airhilt.workers.Step"),
        (Stamping, "'ears' set t_ns of what it published on 'asr/118300'; leave it out"),
        (
            WrongKey,
            "published on 'transcript/118300'; expected a key under advisory, asr, enhanced, llm",
        ),
        (WrongFrequency, "a transcript of 118300 kHz; expected the frequency in the key"),
        (Garbage, "published on 'asr/118300' something that is no Transcript: id: Field required"),
        (Large, "bytes; expected at most 32,000"),
        (Early, "wants 'asr/118300' published at 999999999 ns, before its step at 1000000000 ns"),
        (Restless, "to be called again at 1000000000 ns; expected a later time"),
        (Eyes, "of modality vision published on 'asr/118300'; expected vision/..."),
        (Raising, "worker 'ears' raised ValueError on radio/118300/tx: no model"),
        (Quitting, "worker 'ears' raised SystemExit on radio/118300/tx: 3"),
        (Unreadable, "Unreadable.description cannot be read: KeyError: 'model'; expected an"),
        (Unable, "worker 'ears' has no method step(t_ns, inputs)"),
        (Hanging, "has not answered for 0.2 s to radio/118300/tx; an attached worker that takes"),
    ],
)
def test_a_fault_is_named(worker: type[Ears], words: str) -> None:
    with pytest.raises(WorkerError) as caught:
        check_worker(worker(), patience_s=0.2)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("result", "words"),
    [
        (step_of(5), "returned a Step whose outputs are 5; expected a tuple of"),
        (step_of(("x",)), "returned 'x' among its outputs; expected airhilt.workers.Output"),
        (step_of((output_of(5, b"{}"),)), "returned an Output with the key 5; expected a str"),
        (step_of((output_of("k", "{}"),)), "published on 'k' the payload '{}'; expected bytes"),
        (step_of((output_of("k", b"", "x"),)), "on 'k' with t_out_ns 'x'; expected an int, in ns"),
        (
            step_of((output_of("k", b"", True),)),
            "on 'k' with t_out_ns True; expected an int, in ns",
        ),
        (step_of((), wake_ns="x"), "a Step with wake_ns 'x'; expected an int, in ns"),
        (step_of((), wake_ns=0.5), "a Step with wake_ns 0.5; expected an int, in ns"),
    ],
)
def test_a_part_of_a_step_with_another_type_is_named_by_the_checker_and_in_a_run(
    result: Step, words: str
) -> None:
    class Returning(Odd):
        pass

    Returning.result = result
    with pytest.raises(WorkerError, match=re.escape(words)) as told:
        check_worker(Returning())
    with pytest.raises(WorkerError) as raised:
        LocalWorker(Returning()).dispatch(0, 0, ()).result()
    assert str(raised.value) == str(told.value)


def test_a_class_in_the_place_of_a_worker_is_refused() -> None:
    with pytest.raises(WorkerError, match=r"Ears is a class; expected .*: Ears\(\)"):
        check_worker(Ears)  # type: ignore[arg-type]


def test_a_key_of_a_sensor_of_another_package_is_no_fault() -> None:
    class Thermometer(Ears):
        wants = "temperature/*"

    check_worker(Thermometer())


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
    class WarnsOnly(Nameless):
        def heard(self, t_ns: int, item: Input) -> Output:
            told = Advisory.model_validate_json(super().heard(t_ns, item).payload)
            told = told.model_copy(update={"id": "ears-1", "recipient": recipient})
            return Output(f"advisory/{recipient}", told.model_dump_json().encode())

    with pytest.warns(UserWarning, match=words) as told:
        check_worker(WarnsOnly())
    assert len(told) == 1


def test_all_faults_are_named_each_once() -> None:
    class Both(Cheat):
        wants = "truth/radio/*"

        def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
            raise ValueError("no model")

    with pytest.raises(WorkerError) as caught:
        check_worker(Both(), list(sample_inputs(1_000_000_000))[:2])
    assert [line.split(" ")[2] for line in str(caught.value).splitlines()] == [
        "asks", "raised", "raised",
    ]  # fmt: skip
