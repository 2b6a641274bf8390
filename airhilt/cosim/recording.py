"""Reads from the folder of an earlier run what its replay cannot compute afresh."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from pydantic import TypeAdapter

from airhilt.audio.pcm import SAMPLE_BYTES
from airhilt.cosim.engines_in_use import is_remote
from airhilt.cosim.recorded import Recorded, UnregisteredMessage
from airhilt.engine_families import VOICES
from airhilt.errors import SpeechError
from airhilt.messages import (
    STALLED,
    UNREGISTERED,
    AdvisoryAudio,
    DroppedMessages,
    EnhancedTransmission,
    Event,
    SeatAudio,
    SeatAudioClosed,
    SpokenTruth,
    Status,
    Transcript,
    Transmission,
    TransmissionAudio,
    TransmissionClosed,
    WorkerDescription,
    worker_output,
)
from airhilt.options import Options
from airhilt.record import Logged, RunFolder, RunInfo
from airhilt.record.audio import recorded_pcm
from airhilt.record.latency import RecordedLatencies
from airhilt.sensors.radio.backends import SoundRequest
from airhilt.sensors.radio.on_air import OnAir
from airhilt.sim import Input, LatencySpec, Output, Reply, WorkerLost
from airhilt.units import SECOND_NS
from airhilt.workers.pool import Participant

UNENDING_S = 86_400.0
"""Length of a call, in s, that its run has cut off: longer than any run."""
_AUDIO = TypeAdapter[TransmissionAudio](TransmissionAudio)
_SEAT_AUDIO = TypeAdapter[SeatAudio](SeatAudio)
Received = tuple[str, str | None]
"""Id of a call, and the owner of the receiver; None: it is the one at the units' site."""


def read_recorded(
    folder: RunFolder, info: RunInfo, latencies: RecordedLatencies, log: Sequence[Logged]
) -> Recorded:
    """Return what a replay takes from the record of a run.

    Raises
    ------
    RunFolderError
        A sound of the run cannot be read.
    """
    breaks_off = info.phase != "finished"
    attached = {worker.description.name for worker in info.workers if worker.where == "attached"}
    programs = tuple(set(info.options.attach) - attached)
    losses = {name: loss for name, loss in latencies.losses.items() if name in programs}
    workers = []
    for description in _elsewhere(info):
        name = description.name
        loss, unfinished = latencies.losses.get(name), latencies.unfinished.get(name)
        failure = None
        if loss is not None and unfinished is not None and unfinished.due_ns == loss.t_ns:
            failure = (unfinished.seq, loss.cause)
        elif loss is not None:
            losses[name] = loss
        given = [_given(folder, logged) for logged in log if logged.publisher == name]
        worker = ReplayedWorker(
            given, latencies.outputs.get(name, {}), latencies.wakes_ns.get(name, {}), failure
        )
        workers.append(Participant(description, worker, where="attached"))
    return Recorded(
        latency=LatencySpec(
            "replay",
            replay_of=str(folder.path),
            recorded=latencies.latencies_ns,
            breaks_off=breaks_off,
        ),
        end_ns=log[-1].t_ns if breaks_off and log else None,
        unavailable_reason=_unavailable_reason(log),
        cameras_lost=_cameras_lost(log),
        has_pictures=any(logged.key.startswith("camera/") for logged in log),
        sound=_sound(folder, log) if _is_spoken_elsewhere(info.options) else None,
        workers=tuple(workers),
        programs=programs,
        losses=losses,
        unregistered=tuple(
            UnregisteredMessage(logged.key, logged.t_ns, logged.data)
            for logged in log
            if logged.publisher == UNREGISTERED
        ),
        dropped=tuple(
            DroppedMessages.model_validate_json(logged.data)
            for logged in log
            if logged.key == "truth/dropped"
        ),
        refused=tuple(event for event in _events(log) if event.kind == "refused"),
        stalls=tuple(event for event in _events(log) if _is_stall(event)),
    )


def _is_stall(event: Event) -> bool:
    return event.kind == "pace" and event.text == STALLED


def depends_on_log(info: RunInfo) -> bool:
    """Return whether a replay takes what other programs or services said from the log."""
    return (
        info.unregistered_programs or bool(_elsewhere(info)) or _is_spoken_elsewhere(info.options)
    )


def _elsewhere(info: RunInfo) -> list[WorkerDescription]:
    """Return the workers whose results cannot be had again by computing them here."""
    options = info.options.model_copy(update={"assistant": info.assistant})
    return [
        worker.description
        for worker in info.workers
        if worker.where != "in process" or is_remote(options, worker.description.modality)
    ]


def _unavailable_reason(log: Sequence[Logged]) -> str:
    """Return why no pictures could be drawn from the start; empty if they could."""
    for logged in log:
        if logged.key == "status/vision":
            status = Status.model_validate_json(logged.data)
            return status.cause if status.state == "not evaluated" else ""
    return ""


def _cameras_lost(log: Sequence[Logged]) -> tuple[int, str] | None:
    """Return when there were no more pictures, and why; None if there were to the end."""
    for event in _events(log):
        if event.kind == "cameras_lost":
            return event.t_ns, event.text
    return None


def _events(log: Sequence[Logged]) -> Iterator[Event]:
    for logged in log:
        if logged.key == "truth/event":
            yield Event.model_validate_json(logged.data)


def _is_spoken_elsewhere(options: Options) -> bool:
    return options.speech and VOICES.choose(options.tts)[0].is_remote


def _sound(folder: RunFolder, log: Sequence[Logged]) -> ReplayedRadio:
    """Return what was on the air, and why that ended."""
    durations_s: dict[tuple[str, str], float] = {}
    received: dict[Received, Transmission | TransmissionClosed] = {}
    lost: Event | None = None
    is_over = False
    for logged in log:
        kind = logged.key.split("/")
        if kind[:2] == ["truth", "radio"]:
            said = SpokenTruth.model_validate_json(logged.data)
            if lost is None or said.t_tx_ns < lost.t_ns:
                duration_s = (said.t_end_ns - said.t_tx_ns) / SECOND_NS
                durations_s.setdefault(
                    (said.speaker, said.text), UNENDING_S if is_over else duration_s
                )
        elif kind[0] == "radio" and kind[-1] == "tx":
            header = Transmission.model_validate_json(logged.data)
            if header.samples:
                received[header.id, None] = header
        elif kind[0] == "radio" and kind[-1] == "audio":
            audio = _AUDIO.validate_json(logged.data)
            if isinstance(audio, TransmissionClosed) and not audio.is_complete:
                received[audio.id, None] = audio
        elif kind[0] == "seat" and kind[-1] == "audio":
            heard = _SEAT_AUDIO.validate_json(logged.data)
            if isinstance(heard, SeatAudioClosed) and heard.samples:
                received[heard.id, heard.seat] = heard
        elif logged.key == "truth/event":
            event = Event.model_validate_json(logged.data)
            is_over = is_over or event.kind in ("finished", "stopped")
            lost = event if event.kind == "radio_lost" else lost
    return ReplayedRadio(folder.audio_path, durations_s, received, lost.text if lost else None)


def _given(folder: RunFolder, logged: Logged) -> Output:
    """Return what a worker gave: the message, or the raw bytes that it is the header of."""
    model = worker_output(logged.key)
    if model not in (AdvisoryAudio, EnhancedTransmission):
        return Output(logged.key, logged.data, logged.t_ns)
    header = model.model_validate_json(logged.data)
    pcm = recorded_pcm(folder.audio_path, header)
    return Output(logged.key, pcm, logged.t_ns, header.model_dump(mode="json"))


class ReplayedWorker:
    """Gives what a worker of another process gave, step by step.

    Parameters
    ----------
    given
        All that it gave, in order.
    outputs
        Number of outputs that each step gave.
    wakes_ns
        Time at which each step asked to be called again.
    failure
        The step in which it was lost, and why; None if it was lost between steps or not at all.
    """

    def __init__(
        self,
        given: Sequence[Output],
        outputs: dict[int, int],
        wakes_ns: dict[int, int | None],
        failure: tuple[int, str] | None,
    ) -> None:
        self._given = deque(given)
        self._outputs = outputs
        self._wakes_ns = wakes_ns
        self._failure = failure

    def dispatch(self, seq: int, t_ns: int, inputs: Sequence[Input]) -> ReplayedStep:  # noqa: ARG002
        """Return the step as it was."""
        if self._failure is not None and self._failure[0] == seq:
            return ReplayedStep(Reply((), 0.0), self._failure[1])
        count = min(self._outputs.get(seq, 0), len(self._given))
        outputs = tuple(self._given.popleft() for _ in range(count))
        return ReplayedStep(Reply(outputs, 0.0, self._wakes_ns.get(seq)), None)


@dataclass(frozen=True)
class ReplayedStep:
    """A step of an earlier run."""

    reply: Reply
    failure: str | None

    def result(self) -> Reply:
        """Return what it gave.

        Raises
        ------
        WorkerLost
            The worker was lost in it.
        """
        if self.failure is not None:
            raise WorkerLost(self.failure)
        return self.reply


class ReplayedRadio:
    """The voices of an earlier run, and what its receivers gave out.

    Parameters
    ----------
    audio
        Folder with the sound of what was received.
    durations_s
        Duration of each spoken text, by speaker and text.
    received
        Headers of the sound that was received, by call and receiver.
    failure
        Reason why the sound was lost; None if it was not.
    """

    has_sound = True

    def __init__(
        self,
        audio: Path,
        durations_s: Mapping[tuple[str, str], float],
        received: Mapping[Received, Transmission | TransmissionClosed],
        failure: str | None,
    ) -> None:
        self._audio = audio
        self._durations_s = durations_s
        self._received = received
        self._failure = failure

    def speak(self, speaker: str, text: str) -> tuple[None, float]:
        """Return how long it took to say a text.

        Raises
        ------
        SpeechError
            It was this text that could not be said.
        """
        duration_s = self._durations_s.get((speaker, text))
        if duration_s is None and self._failure is not None:
            raise SpeechError(self._failure)
        return None, UNENDING_S if duration_s is None else duration_s

    def receive(self, request: SoundRequest) -> bytes:
        """Return the samples as they were received.

        Raises
        ------
        SpeechError
            It was in this transmission that the sound was lost.
        """
        said, first = request.on_air.utterance, SAMPLE_BYTES * request.begin
        header = self._received.get((said.id, request.listener))
        pcm = b"" if header is None else recorded_pcm(self._audio, header)[first:]
        if not pcm:
            raise SpeechError(self._failure or f"{said.id}: not in the recording")
        return pcm

    def transcript(self, on_air: OnAir, mixed_with: tuple[OnAir, ...]) -> Transcript | None:  # noqa: ARG002
        """Return None: a recogniser found the words."""
        return None
