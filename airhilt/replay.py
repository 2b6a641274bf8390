"""Runs a run again from its folder, and tells where the two diverge."""

from __future__ import annotations

import json
import tempfile
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from airhilt.bus.exchange import FOREIGN
from airhilt.cosim import Foreign, Observer, Options, Recorded, run
from airhilt.errors import RunFolderError, first_problem
from airhilt.messages import HEADERS, WORKER_OUTPUTS, Event
from airhilt.record import Logged, RunFolder, RunInfo, read_latencies, read_log
from airhilt.record.audio import recorded_pcm
from airhilt.record.folder import versions
from airhilt.record.latency import RecordedLatencies
from airhilt.scenario import Scenario
from airhilt.sim import Input, LatencySpec, Output, Reply, WorkerLost
from airhilt.units import SECOND_NS
from airhilt.workers.pool import Participant


@dataclass(frozen=True)
class Verdict:
    """How a replay compares with its recording."""

    identical: bool
    messages: int
    """Compared."""
    difference: str
    notes: tuple[str, ...]

    def as_dict(self) -> dict[str, Any]:
        """Return it for JSON."""
        return {
            "identical": self.identical,
            "messages": self.messages,
            "difference": self.difference or None,
            "notes": list(self.notes),
        }

    def __str__(self) -> str:
        head = f"identical: {self.messages} messages" if self.identical else self.difference
        return "\n".join([head, *(f"note: {note}" for note in self.notes)])


def replay(path: Path, observer: Observer | None = None) -> Verdict:
    """Run a run again with the seed and the latencies that it had, and compare.

    Workers of this process compute afresh; what came from other processes comes from the record.

    Raises
    ------
    RunFolderError
        There is no run, or it cannot be read.
    """
    folder = RunFolder.open(path)
    info = folder.info()
    latencies = read_latencies(folder.latency_path)
    recorded_log = list(read_log(folder.log_path))
    try:
        scenario = Scenario.model_validate(info.scenario)
    except ValidationError as error:
        raise RunFolderError(
            f"{folder.info_path}: its scenario is not valid here: {first_problem(error)}; "
            f"expected AIRHILT {info.versions.get('airhilt')}"
        ) from None
    with tempfile.TemporaryDirectory(prefix="airhilt-replay-") as scratch:
        options = Options(
            seed=info.options.seed,
            out=Path(scratch) / "run",
            assistant=info.options.assistant,
            cameras=info.options.cameras,
            speech=info.options.speech,
            snr_db=info.options.snr_db,
            radio_profile=info.options.radio_profile,
            topology=info.options.topology,
            asr=info.options.asr,
            tts=info.options.tts,
            run_name=info.run,
        )
        recorded = _recorded(folder, info, latencies, recorded_log)
        result = run(scenario, options, observer, recorded)
        repeated = list(read_log(RunFolder(result.folder).log_path))
    return _compare(recorded_log, repeated, info)


def _recorded(
    folder: RunFolder, info: RunInfo, latencies: RecordedLatencies, log: Sequence[Logged]
) -> Recorded:
    breaks_off = info.phase != "finished"
    attached = [worker.description for worker in info.workers if worker.where == "attached"]
    programs = tuple(set(info.options.attached) - {described.name for described in attached})
    losses = {name: loss for name, loss in latencies.losses.items() if name in programs}
    workers = []
    for description in attached:
        name = description.name
        loss, unfinished = latencies.losses.get(name), latencies.unfinished.get(name)
        failure = None
        if loss is not None and unfinished is not None and unfinished.due_ns == loss.t_ns:
            failure = (unfinished.seq, loss.cause)
        elif loss is not None:
            losses[name] = loss
        given = [_given(folder, logged) for logged in log if logged.publisher == name]
        worker = RecordedWorker(
            given, latencies.outputs.get(name, {}), latencies.wakes_ns.get(name, {}), failure
        )
        workers.append(Participant(description, worker, attached=True))
    return Recorded(
        latency=LatencySpec(
            "replay",
            replay_of=str(folder.path),
            recorded=latencies.latencies_ns,
            breaks_off=breaks_off,
        ),
        end_ns=log[-1].t_ns if breaks_off and log else None,
        workers=tuple(workers),
        programs=programs,
        losses=losses,
        foreign=tuple(
            Foreign(logged.key, logged.t_ns, logged.data)
            for logged in log
            if logged.publisher == FOREIGN
        ),
    )


def _given(folder: RunFolder, logged: Logged) -> Output:
    """Return what a worker gave: the message, or the raw bytes that it is the header of."""
    model = WORKER_OUTPUTS[logged.key.split("/")[0]]
    if not issubclass(model, HEADERS):
        return Output(logged.key, logged.data, logged.t_ns)
    header = model.model_validate_json(logged.data)
    pcm = recorded_pcm(folder.audio_path, header)
    return Output(logged.key, pcm, logged.t_ns, header.model_dump(mode="json"))


class RecordedWorker:
    """Gives what a worker of another process gave, step by step.

    Parameters
    ----------
    given
        All that it gave, in order.
    outputs
        How many of them each step gave.
    wakes_ns
        When each step asked to be called again.
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

    def dispatch(self, seq: int, t_ns: int, inputs: Sequence[Input]) -> RecordedStep:  # noqa: ARG002
        """Return the step as it was."""
        if self._failure is not None and self._failure[0] == seq:
            return RecordedStep(Reply((), 0.0), self._failure[1])
        count = min(self._outputs.get(seq, 0), len(self._given))
        outputs = tuple(self._given.popleft() for _ in range(count))
        return RecordedStep(Reply(outputs, 0.0, self._wakes_ns.get(seq)), None)


@dataclass(frozen=True)
class RecordedStep:
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


def _compare(recorded: Sequence[Logged], repeated: Sequence[Logged], info: RunInfo) -> Verdict:
    notes = []
    now = versions()
    changed = [
        f"{name} {was} -> {now.get(name)}"
        for name, was in info.versions.items()
        if now.get(name) != was
    ]
    if changed:
        notes.append(f"versions differ from the recording: {', '.join(changed)}")
    if info.phase != "finished":
        recorded = [logged for logged in recorded if not _is_stop(logged)]
        repeated = repeated[: len(recorded)]
        notes.append("the recording breaks off; compared up to there")
    for index, (was, now_is) in enumerate(zip_longest(recorded, repeated)):
        if was != now_is:
            return Verdict(False, index, _difference(index, was, now_is), tuple(notes))
    return Verdict(True, len(recorded), "", tuple(notes))


def _is_stop(logged: Logged) -> bool:
    return logged.key == "truth/event" and Event.model_validate_json(logged.data).kind == "stopped"


def _difference(index: int, was: Logged | None, now_is: Logged | None) -> str:
    first = was or now_is
    t_s = first.t_ns / SECOND_NS if first else 0.0
    head = f"differs first at message {index}, {t_s:.3f} s"
    if was is None or now_is is None:
        longer, found = ("replay", now_is) if was is None else ("recording", was)
        return f"{head}: only the {longer} has {found.key if found else ''}"
    if was[:3] != now_is[:3]:
        return (
            f"{head}: recorded {was.key} by {was.publisher} at {was.t_ns} ns, "
            f"now {now_is.key} by {now_is.publisher} at {now_is.t_ns} ns"
        )
    fields = _first_field(json.loads(was.data), json.loads(now_is.data), "")
    return f"{head}: {was.key}{fields}"


def _first_field(was: Any, now_is: Any, path: str) -> str:
    if isinstance(was, dict) and isinstance(now_is, dict):
        for key in sorted({*was, *now_is}):
            if was.get(key) != now_is.get(key):
                return _first_field(was.get(key), now_is.get(key), f"{path}/{key}")
    return f"{path}: recorded {was!r}, now {now_is!r}"
