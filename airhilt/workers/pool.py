"""The workers of a run: their inputs are routed, and their outputs checked."""

from __future__ import annotations

import hashlib
import re
import statistics
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal, Protocol

from pydantic import ValidationError

from airhilt.audio.pcm import SAMPLE_RATE_HZ
from airhilt.errors import WorkerError, all_problems, shown
from airhilt.messages import (
    UNREGISTERED,
    WORKER_OUTPUTS,
    Advisory,
    AdvisoryAudio,
    Detections,
    EnhancedTransmission,
    EquipmentAlert,
    Header,
    Message,
    ModelExchange,
    PartialTranscript,
    Transcript,
    Transmission,
    TransmissionChunk,
    WorkerDescription,
    is_match,
    worker_output,
)
from airhilt.sim import Director, Endpoint, Input, LatencySpec, Output, Policy, Server, StepRecord
from airhilt.sim.payload import Payload
from airhilt.units import SECOND_NS

NAMED = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
"""First chunk of a key that stands for itself only; a wildcard there would take in truth."""


DROPPED_SHARE = 0.1
"""Share of dropped inputs above which measured times are doubted. An assumption."""
TIMES_DECLARED = 3.0
"""Ratio of the measured median to the declared one above which they are doubted. An assumption."""
EQUIPMENT = "equipment"
"""Modality of the workers that are equipment of the world."""
Where = Literal["in process", "attached", "caller"]
"""Place where a worker runs: made by the run, in another process, or given by the run's caller."""


@dataclass(frozen=True)
class Participant:
    """A worker that takes part, wherever it runs."""

    description: WorkerDescription
    endpoint: Endpoint
    where: Where
    is_of_user: bool = False
    """The user brings the worker, or the engine that it is made of."""


class Publish(Protocol):
    """Publishes what a worker gave; ``raw`` is the payload of a key whose message is a header."""

    def __call__(  # noqa: D102
        self, key: str, message: Message, publisher: str, raw: bytes | None = None
    ) -> None: ...


class WorkerPool:
    """Routes messages to workers and checks what they give back.

    Parameters
    ----------
    publish
        Called with key, checked message and worker when an output leaves a worker.
    done
        Called with the record of each finished step.
    lost
        Called when a worker is lost, with its description, the cause, and true if that is of the
        machine.

    Raises
    ------
    WorkerError
        A worker asks for truth.
    """

    def __init__(
        self,
        director: Director,
        participants: Sequence[Participant],
        latency: LatencySpec,
        seed: int,
        *,
        publish: Publish,
        done: Callable[[StepRecord], None],
        lost: Callable[[WorkerDescription, str, bool], None],
    ) -> None:
        self._inputs: list[tuple[Server, dict[str, Policy]]] = []
        self._routes: dict[str, list[tuple[Server, Policy]]] = {}
        self.servers: dict[str, Server] = {}
        self._sources: dict[str, set[str]] = {}
        self._declared_s: dict[str, float] = {}
        """Median that each measured worker declares, in s."""
        self._recognisers = {
            each.description.name for each in participants if each.description.modality == "asr"
        }
        """Workers to which a piece of a call is a part of it, not news of one instant."""
        for participant in participants:
            description = participant.description
            declared = description.latency
            spec = latency.of(description.modality, participant.is_of_user)
            server = Server(
                description.name,
                director,
                participant.endpoint,
                spec.source(description.name, seed, declared.median_s, declared.sigma),
                deliver=partial(_deliver, director, publish, description),
                done=done,
                lost=partial(lost, description),
            )
            policies: dict[str, Policy] = {}
            for wanted in description.inputs:
                require_open_key(description.name, wanted.key)
                policies[wanted.key] = wanted.policy
            self.servers[description.name] = server
            self._sources.setdefault(description.modality, set()).add(spec.own_text)
            if spec.kind == "measured":
                self._declared_s[description.name] = declared.median_s
            self._inputs.append((server, policies))

    def offer(self, key: str, message: Message, data: Payload) -> None:
        """Give a message to the workers that want its key.

        ``data`` is its JSON, or the raw bytes that it is the header of.
        """
        routes = self._routes.get(key)
        if routes is None:
            routes = self._routes[key] = [
                (server, policy)
                for server, policies in self._inputs
                if (policy := policy_of(key, policies)) is not None
            ]
        is_header = routes and isinstance(message, Header)
        attachment = message.model_dump(mode="json") if is_header else None
        begun_ns = _begun_ns(message)
        for server, policy in routes:
            is_whole = isinstance(message, Transmission | EnhancedTransmission)
            is_of_call = is_whole or server.name in self._recognisers
            begun = begun_ns if is_of_call else None
            server.offer(Input.of(key, message.t_ns, data, attachment, begun), policy)

    def inputs_dropped(self) -> dict[str, int]:
        """Return how many inputs were dropped as out of date, by worker and key."""
        return {
            f"{name}: {key}": count
            for name, server in self.servers.items()
            for key, count in sorted(server.dropped.items())
        }

    def steps_missed(self) -> dict[str, int]:
        """Return how many steps had no result for an input, by worker."""
        return {name: server.missed for name, server in self.servers.items() if server.missed}

    def latency_sources(self) -> dict[str, str]:
        """Return the latency sources of the workers, by modality."""
        return {stage: " and ".join(sorted(texts)) for stage, texts in self._sources.items()}

    def too_slow(self) -> list[str]:
        """Return a sentence for each measured worker whose times tell of a busy machine.

        It dropped more than `DROPPED_SHARE` of the inputs of a key as out of date, and the median
        of its steps is more than `TIMES_DECLARED` times the one that it declares.
        """
        found = []
        for name, declared_s in self._declared_s.items():
            server = self.servers[name]
            dropped, offered = (
                server.dropped.total(),
                sum(server.offered[key] for key in server.dropped),
            )
            if dropped <= DROPPED_SHARE * offered:
                continue
            median_s = statistics.median(server.latencies_ns or [0]) / SECOND_NS
            if median_s > TIMES_DECLARED * declared_s:
                found.append(
                    f"The machine was too slow for the times of {name!r}: it dropped {dropped} of "
                    f"{offered} inputs, and its median step took {median_s:.2g} s, where it "
                    f"declares {declared_s:.2g} s."
                )
        return found

    def unfinished(self) -> list[StepRecord]:
        """Return the steps in hand."""
        steps = [server.in_hand for server in self.servers.values()]
        return [step for step in steps if step is not None]


def _deliver(
    director: Director, publish: Publish, worker: WorkerDescription, output: Output
) -> None:
    """Publish an output that leaves a worker, after a check."""
    message = parse_output(
        worker.name, output.key, output.payload, director.now_ns, output.attachment
    )
    if isinstance(message, EquipmentAlert) and worker.modality != EQUIPMENT:
        raise WorkerError(
            f"worker {worker.name!r} published on {output.key!r}; expected a key under advisory: "
            "only equipment of the world publishes there"
        )
    stamped = message.model_copy(update={"t_ns": director.now_ns})
    raw = output.payload if isinstance(message, Header) else None
    publish(output.key, stamped, worker.name, raw)


def _begun_ns(message: Message) -> int | None:
    """Return when the call began of which a message has audio; None for other messages."""
    match message:
        case Transmission() | EnhancedTransmission():
            return message.t_tx_ns
        case TransmissionChunk():
            samples = message.first_sample + message.samples
            return max(message.t_ns - samples * SECOND_NS // SAMPLE_RATE_HZ, 0)
    return None


def require_open_key(worker: str, key: str) -> None:
    """Complain about an input key that takes in truth, or may, or what only people know.

    Raises
    ------
    WorkerError
        The key is below ``truth``, its first chunk is no plain name, or it is a key of commands or
        of seats.
    """
    first = key.split("/")[0]
    if first == "truth" or not NAMED.fullmatch(first):
        raise WorkerError(
            f"worker {worker!r} asks for {key!r}; truth never reaches a worker, so the first part "
            "of a key must be named: adsb/*"
        )
    if first in ("command", "seat"):
        raise WorkerError(
            f"worker {worker!r} asks for {key!r}; the script, and what single people enter and "
            "hear, reach no worker: it gets what is heard and seen by all: radio/*/tx, asr/*"
        )


def policy_of(key: str, policies: Mapping[str, Policy]) -> Policy | None:
    """Return the policy for ``key`` among patterns in which ``*`` stands for one chunk."""
    return next((policy for pattern, policy in policies.items() if is_match(key, pattern)), None)


def parse_output(
    worker: str, key: str, payload: bytes, now_ns: int, attachment: Any = None
) -> Message:
    """Return the message that a worker put on a key: the payload, or the header of its bytes.

    Parameters
    ----------
    worker
        Name of the worker, or that of programs that take no grants.

    Raises
    ------
    WorkerError
        It may not publish there, or the payload is not what belongs there.
    """
    who = "a program" if worker == UNREGISTERED else f"worker {worker!r}"
    model = worker_output(key)
    if model is None:
        own = ", ".join(sorted(WORKER_OUTPUTS.keys() - {EQUIPMENT}))
        raise WorkerError(f"{who} published on {key!r}; expected a key under {own}")
    message: Message
    try:
        if issubclass(model, Header):
            message = model.model_validate(attachment)
        else:
            message = model.model_validate_json(payload)
    except ValidationError as error:
        raise WorkerError(
            f"{who} published on {key!r} something that is no {model.__name__}: "
            f"{all_problems(error)}; see `airhilt schema --message "
            f"{model.__name__}`"
        ) from None
    if isinstance(message, Advisory) and message.t_ready_ns > now_ns:
        raise WorkerError(
            f"{who} published an advisory with t_ready_ns {message.t_ready_ns} at {now_ns} ns; "
            "expected a time that has come"
        )
    if isinstance(message, AdvisoryAudio | EnhancedTransmission):
        _check_audio(who, key, message, payload)
    _check_key(who, worker, key, message)
    if isinstance(message, Advisory) and worker != UNREGISTERED:
        _check_id(worker, message.id)
    return message


def _check_id(worker: str, advisory: str) -> None:
    """Complain about an advisory that another worker may have published."""
    if not advisory.startswith(f"{worker}-"):
        raise WorkerError(
            f"worker {worker!r} published an advisory with the id {advisory!r}; expected an id "
            f"that begins with its name, such as '{worker}-1'"
        )


def _check_key(who: str, worker: str, key: str, message: Message) -> None:
    """Complain about a message that is not that of its key.

    A key names the frequency, the camera, the recipient, or the worker itself.
    """
    match message:
        case Transcript() if key != f"asr/{message.frequency_khz}":
            what, part = f"a transcript of {message.frequency_khz} kHz", "frequency"
        case EnhancedTransmission() if key != f"enhanced/{message.frequency_khz}":
            what, part = f"a transmission on {message.frequency_khz} kHz", "frequency"
        case AdvisoryAudio() if key != f"tts/{message.id}":
            what, part = f"the voice of advisory {message.id!r}", "advisory's id"
        case PartialTranscript() if key != f"asr/{message.frequency_khz}/partial":
            what, part = f"a partial transcript of {message.frequency_khz} kHz", "frequency"
        case Detections() if key != f"vision/{message.camera}":
            what, part = f"what is in a picture of camera {shown(message.camera)}", "camera"
        case Advisory() if key != f"advisory/{message.recipient}":
            what, part = f"an advisory for {message.recipient!r}", "recipient"
        case EquipmentAlert() if (
            key != f"equipment/{message.equipment}/{message.advisory.recipient}"
        ):
            what = f"an alert of {message.equipment!r} for {message.advisory.recipient!r}"
            part = "equipment and the recipient"
        case ModelExchange() if key != f"llm/{worker}":
            what, part = "answers of a language model", "worker's own name"
        case _:
            return
    raise WorkerError(f"{who} published on {key!r} {what}; expected the {part} in the key")


def _check_audio(
    who: str, key: str, header: AdvisoryAudio | EnhancedTransmission, pcm: bytes
) -> None:
    if header.sample_rate_hz != SAMPLE_RATE_HZ:
        raise WorkerError(
            f"{who} published on {key!r} audio at {header.sample_rate_hz} Hz; expected "
            f"{SAMPLE_RATE_HZ} Hz"
        )
    if len(pcm) != 2 * header.samples or hashlib.sha256(pcm).hexdigest() != header.sha256:
        raise WorkerError(
            f"{who} published on {key!r} {len(pcm)} bytes that are not what their "
            f"header says; expected {header.samples} samples of 16 bits with the SHA-256 "
            f"{header.sha256}"
        )
