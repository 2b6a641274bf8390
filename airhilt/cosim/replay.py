"""Runs a run again from its folder, and tells where the two diverge."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import takewhile, zip_longest
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from airhilt.cosim.differences import first_difference
from airhilt.cosim.observer import Observer
from airhilt.cosim.recorded import depends_on_log, read_recorded
from airhilt.cosim.simulation import run
from airhilt.errors import RunFolderError, first_problem
from airhilt.host.files import content_sha256
from airhilt.messages import Event
from airhilt.metrics.result import Result
from airhilt.metrics.summary import Summary
from airhilt.record import Logged, Run, RunInfo, open_run, read_log
from airhilt.record.damage import untold
from airhilt.record.folder import machine, versions
from airhilt.scenario import Scenario
from airhilt.units import SECOND_NS

AS_RECORDED = {
    "overwrite": False,
    "pace": None,
    "latency": None,
    "endpoint": None,
    "tls": None,
    "insecure": False,
    "share_truth": False,
    "attach": (),
    "video": False,
    "report": False,
    "strict": False,
}
"""Options that a replay does not repeat: they change nothing in the log, or the record has what
came of them."""


@dataclass(frozen=True)
class Verdict:
    """The result of comparing a replay with its recording."""

    identical: bool
    messages: int
    """Number of messages that were compared."""
    difference: str
    notes: tuple[str, ...]
    cause: str = ""
    """Why the replay differs, as far as it is known: other software or another machine."""

    def as_dict(self) -> dict[str, Any]:
        """Return it for JSON."""
        return {
            "identical": self.identical,
            "messages": self.messages,
            "cause": self.cause or None,
            "difference": self.difference or None,
            "notes": list(self.notes),
        }

    def __str__(self) -> str:
        head = [f"identical: {self.messages} messages"] if self.identical else [self.difference]
        if self.cause:
            head.insert(0, f"cause: {self.cause}")
        return "\n".join([*head, *(f"note: {note}" for note in self.notes)])


def replay(path: Path, observer: Observer | None = None) -> Verdict:
    """Run a run again with the seed and the latencies that it had, and compare.

    Workers of this process compute afresh; what came from other processes, and from services,
    comes from the record.

    Raises
    ------
    RunFolderError
        There is no run, it cannot be read, or what its replay needs is damaged.
    """
    original = open_run(path, untold)
    _, verdict = _repeat(original, observer)
    return verdict


def rescore(path: Path, observer: Observer | None = None) -> tuple[Summary, Verdict]:
    """Make the scores of a run again from its folder alone, and compare the flight with its log.

    No worker computes anything: all that any of them said comes from the record.

    Raises
    ------
    RunFolderError
        As of `replay`.
    """
    result, verdict = _repeat(open_run(path, untold), observer, is_rescored=True)
    return result.summary, verdict


def _repeat(
    original: Run, observer: Observer | None, *, is_rescored: bool = False
) -> tuple[Result, Verdict]:
    """Return what came of a run that was run again, and how its log compares."""
    folder, info = original.paths, original.info
    if not info.options.voice_recording:
        raise RunFolderError(
            f"{folder.path}: made with --no-voice-recording, so that what people said is not in "
            "it; expected a run with their voices"
        )
    _require_inputs(original, is_rescored)
    latencies = original.steps()
    recorded_log = list(original.log())
    try:
        scenario = Scenario.model_validate(info.scenario)
    except ValidationError as error:
        raise RunFolderError(
            f"{folder.info_path}: its scenario is not valid here: {first_problem(error)}; "
            f"expected AIRHILT {info.versions.get('airhilt')}"
        ) from None
    with tempfile.TemporaryDirectory(prefix="airhilt-replay-") as scratch:
        options = info.options.model_copy(
            update={
                "out": Path(scratch) / "run",
                "assistant": info.assistant,
                "assistant_config": _configuration(info),
                "renderer": info.renderer or info.options.renderer,
                "run_name": info.run,
                **AS_RECORDED,
            }
        )
        try:
            recorded = read_recorded(
                folder, info, latencies, recorded_log, every_worker=is_rescored
            )
        except ValidationError as error:
            raise RunFolderError(
                f"{folder.log_path}: {first_problem(error)}; expected a log of this version"
            ) from None
        result = run(scenario, options, observer, recorded)
        repeated = list(read_log(result.paths.log_path))
    return result, _compare(recorded_log, repeated, original)


def _configuration(info: RunInfo) -> dict[str, Any] | None:
    """Return the configuration that the assistant had, whole; None if it had none."""
    for worker in info.workers:
        if worker.description.modality == "decision" and worker.where == "in process":
            return worker.description.configuration or None
    return None


def _require_inputs(original: Run, is_rescored: bool) -> None:
    """Refuse a recording that is damaged where what is taken from it may have been."""
    if original.log_damage and (is_rescored or depends_on_log(original.info)):
        raise RunFolderError(
            f"{original.folder}: {original.log_damage}; it is needed here, because what "
            "workers, other programs or services said is taken from it"
        )


def _compare(recorded: Sequence[Logged], repeated: Sequence[Logged], original: Run) -> Verdict:
    info = original.info
    notes = list(original.damage)
    changed = _changes(info.versions, versions())
    if changed:
        notes.append(f"versions differ from the recording: {', '.join(changed)}")
    notes += [
        f"{name} is not the file of the recording any more"
        for name, was_sha256 in info.models.items()
        if not Path(name).exists() or content_sha256(Path(name)) != was_sha256
    ]
    if info.phase != "finished":
        recorded = list(takewhile(lambda logged: not _is_stop(logged), recorded))
        repeated = repeated[: recorded[-1].sequence if recorded else 0]
        notes.append("the recording breaks off; compared up to there")
    if original.log_damage:
        left = {logged.sequence for logged in recorded}
        repeated = [logged for logged in repeated if logged.sequence in left]
    for index, (was, now_is) in enumerate(zip_longest(recorded, repeated)):
        if was != now_is:
            cause = _cause([*changed, *_changes(info.platform, machine(), ("machine",))])
            return Verdict(False, index, _difference(index, was, now_is), tuple(notes), cause)
    return Verdict(True, len(recorded), "", tuple(notes))


def _changes(
    was: Mapping[str, str], now: Mapping[str, str], names: Iterable[str] | None = None
) -> list[str]:
    """Return what is not as it was, in words."""
    return [
        f"{name} {was[name]} -> {now.get(name)}"
        for name in (was if names is None else names)
        if name in was and now.get(name) != was[name]
    ]


def _cause(changed: Sequence[str]) -> str:
    """Return why a replay differs; empty if nothing is known that could be why."""
    if not changed:
        return ""
    return (
        f"other software or another machine than the run had ({', '.join(changed)}); the same "
        "bytes need the same versions, as constraints.txt has them, and the same kind of processor"
    )


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
    try:
        field = first_difference(json.loads(was.data), json.loads(now_is.data), was.key)
    except (ValueError, RecursionError):
        field = f"{was.key}: recorded something that is no JSON"
    return f"{head}: {field}"
