"""Parts of an earlier run that its replay cannot compute afresh, and takes from the record."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from airhilt.audio.pcm import SAMPLE_BYTES
from airhilt.cosim.engines_in_use import is_remote
from airhilt.engine_families import VOICES
from airhilt.errors import SpeechError
from airhilt.messages import (
    STALLED,
    UNREGISTERED,
    AdvisoryAudio,
    DroppedMessages,
    EnhancedTransmission,
    Event,
    SeatAudioClosed,
    SpokenTruth,
    Status,
    Transcript,
    Transmission,
    TransmissionClosed,
    WorkerDescription,
    decode,
    worker_output,
)
from airhilt.options import Options
from airhilt.record import Logged, Loss, RunFolder, RunInfo
from airhilt.record.audio import recorded_pcm
from airhilt.record.latency import RecordedLatencies
from airhilt.sensors.radio.backends import RadioBackend, SoundRequest
from airhilt.sensors.radio.on_air import OnAir
from airhilt.sim import Input, LatencySpec, Output, Reply, StepDone, WorkerLost
from airhilt.units import SECOND_NS
from airhilt.workers.pool import Participant

UNENDING_S = 86_400.0
"""Length of a call, in s, that its run has cut off: longer than any run."""
Received = tuple[str, str | None]
"""Id of a call, and the owner of the receiver; None: it is the one at the units' site."""


@dataclass(frozen=True)
class UnregisteredMessage:
    """A message that an unregistered program published in the earlier run."""

    key: str
    t_ns: int
    data: bytes


@dataclass(frozen=True)
class Recorded:
    """Parts of an earlier run that a replay takes from its record.

    Attributes
    ----------
    latency
        Replaces the latency source of the options.
    end_ns
        Time at which the earlier run broke off; None if it came to its end.
    sound
        Replaces voices and channel; None where those of the options speak again.
    workers
        Workers whose results come from the record.
    programs
        Names of the attached programs that took no grants.
    losses
        Losses of these programs, by name.
    unregistered
        Messages of unregistered programs.
    refused
        Events of messages that the earlier run refused: they have key and cause of each.
    stalls
        Events of stalls, in which the earlier run lost time.
    dropped
        Numbers of messages that the earlier run dropped.
    unavailable_reason
        Why no pictures could be drawn from the start; empty if they could.
    cameras_lost
        Time from which there were no more pictures (ns), and why.
    has_pictures
        True if there were pictures, even if no worker looks at them in the replay.
    """

    latency: LatencySpec | None = None
    end_ns: int | None = None
    sound: RadioBackend | None = None
    workers: tuple[Participant, ...] = ()
    programs: tuple[str, ...] = ()
    losses: Mapping[str, Loss] = field(default_factory=dict)
    unregistered: tuple[UnregisteredMessage, ...] = ()
    refused: tuple[Event, ...] = ()
    stalls: tuple[Event, ...] = ()
    dropped: tuple[DroppedMessages, ...] = ()
    unavailable_reason: str = ""
    cameras_lost: tuple[int, str] | None = None
    has_pictures: bool = False

    @property
    def is_replay(self) -> bool:
        """True if the run repeats an earlier one, whose latencies it then has."""
        return self.latency is not None


def read_recorded(
    folder: RunFolder,
    info: RunInfo,
    latencies: RecordedLatencies,
    log: Sequence[Logged],
    *,
    every_worker: bool = False,
) -> Recorded:
    """Return what a replay takes from the record of a run; if asked for, of every worker.

    Raises
    ------
    RunFolderError
        A sound of the run cannot be read.
    """
    breaks_off = info.phase != "finished"
    taken = [one.description for one in info.workers] if every_worker else _elsewhere(info)
    workers = {each.name: each for each in taken}
    takes_sound = _is_spoken_elsewhere(info.options) or (every_worker and info.options.speech)
    attached = {worker.description.name for worker in info.workers if worker.where == "attached"}
    programs = tuple(set(info.options.attach) - attached)
    events = [
        Event.model_validate_json(logged.data) for logged in log if logged.key == "truth/event"
    ]
    cameras_lost = [(each.t_ns, each.text) for each in events if each.kind == "cameras_lost"]
    spec = LatencySpec(
        "replay",
        replay_of=str(folder.path),
        recorded=latencies.latencies_ns,
        breaks_off=breaks_off,
    )
    return Recorded(
        latency=spec,
        end_ns=log[-1].t_ns if breaks_off and log else None,
        unavailable_reason=_unavailable_reason(log),
        cameras_lost=next(iter(cameras_lost), None),
        has_pictures=any(logged.key.startswith("camera/") for logged in log),
        sound=_sound(folder, log) if takes_sound else None,
        workers=tuple(
            Participant(each, _worker(name, folder, latencies, log), where="attached")
            for name, each in workers.items()
        ),
        programs=programs,
        losses=_losses_between_steps(latencies, programs, workers),
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
        refused=tuple(event for event in events if event.kind == "refused"),
        stalls=tuple(event for event in events if (event.kind, event.text) == ("pace", STALLED)),
    )


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


def _is_spoken_elsewhere(options: Options) -> bool:
    return options.speech and VOICES.choose(options.tts)[0].is_remote


def _losses_between_steps(
    latencies: RecordedLatencies, programs: Collection[str], workers: Collection[str]
) -> dict[str, Loss]:
    return {
        name: loss
        for name, loss in latencies.losses.items()
        if name in programs or (name in workers and not _is_lost_in_step(name, latencies))
    }


def _is_lost_in_step(name: str, latencies: RecordedLatencies) -> bool:
    """Return whether a worker was lost in a step, and not between two."""
    loss, unfinished = latencies.losses.get(name), latencies.unfinished.get(name)
    return loss is not None and unfinished is not None and unfinished.due_ns == loss.t_ns


def _worker(
    name: str, folder: RunFolder, latencies: RecordedLatencies, log: Sequence[Logged]
) -> ReplayedWorker:
    failure = None
    if _is_lost_in_step(name, latencies):
        failure = latencies.unfinished[name].seq, latencies.losses[name].cause
    given = [_given(folder, logged) for logged in log if logged.publisher == name]
    outputs, wakes_ns = latencies.outputs.get(name, {}), latencies.wakes_ns.get(name, {})
    return ReplayedWorker(given, outputs, wakes_ns, latencies.missed.get(name, {}), failure)


def _given(folder: RunFolder, logged: Logged) -> Output:
    """Return what a worker gave: the message, or the raw bytes that it is the header of."""
    model = worker_output(logged.key)
    if model not in (AdvisoryAudio, EnhancedTransmission):
        return Output(logged.key, logged.data, logged.t_ns)
    header = model.model_validate_json(logged.data)
    pcm = recorded_pcm(folder.audio_path, header)
    return Output(logged.key, pcm, logged.t_ns, header.model_dump(mode="json"))


def _unavailable_reason(log: Sequence[Logged]) -> str:
    """Return why no pictures could be drawn from the start; empty if they could."""
    for logged in log:
        if logged.key == "status/vision":
            status = Status.model_validate_json(logged.data)
            return status.cause if status.state == "not evaluated" else ""
    return ""


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
            audio = decode(logged.key, logged.data)
            if isinstance(audio, TransmissionClosed) and not audio.is_complete:
                received[audio.id, None] = audio
        elif kind[0] == "seat" and kind[-1] == "audio":
            heard = decode(logged.key, logged.data)
            if isinstance(heard, SeatAudioClosed) and heard.samples:
                received[heard.id, heard.seat] = heard
        elif logged.key == "truth/event":
            event = Event.model_validate_json(logged.data)
            is_over = is_over or event.kind in ("finished", "stopped")
            lost = event if event.kind == "radio_lost" else lost
    return ReplayedRadio(folder.audio_path, durations_s, received, lost.text if lost else None)


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
    missed
        Why steps had no result for an input, of those that had not all.
    failure
        The step in which it was lost, and why; None if it was lost between steps or not at all.
    """

    def __init__(
        self,
        given: Sequence[Output],
        outputs: dict[int, int],
        wakes_ns: dict[int, int | None],
        missed: dict[int, str],
        failure: tuple[int, str] | None,
    ) -> None:
        self._given = deque(given)
        self._outputs = outputs
        self._wakes_ns = wakes_ns
        self._missed = missed
        self._failure = failure

    def dispatch(self, seq: int, t_ns: int, inputs: Sequence[Input]) -> StepDone:  # noqa: ARG002
        """Return the step as it was."""
        if self._failure is not None and self._failure[0] == seq:
            return StepDone(failure=WorkerLost(self._failure[1]))
        count = min(self._outputs.get(seq, 0), len(self._given))
        outputs = tuple(self._given.popleft() for _ in range(count))
        return StepDone(Reply(outputs, 0.0, self._wakes_ns.get(seq), self._missed.get(seq, "")))


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
