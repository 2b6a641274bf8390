"""Workers in other processes, which the run calls by grants over the bus."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

import zenoh
from pydantic import ValidationError

from airhilt.bus.session import RETRY_S, Bus
from airhilt.errors import RendererError, WorkerError, all_problems, shown
from airhilt.messages import (
    Grant,
    GrantInput,
    StepReply,
    WorkerDescription,
    parts_of,
    worker_output,
)
from airhilt.sim.worker import Input, Output, Pending, Reply, StepDone, WorkerLost

MAXIMUM_REPLY_BYTES = 64_000_000
"""Greatest size of a reply to a grant, in bytes."""


class RemoteWorker:
    """Calls a registered worker over the bus.

    Parameters
    ----------
    timeout_s
        Wall time after which a step that has not answered counts as hung.
    """

    def __init__(self, bus: Bus, name: str, timeout_s: float) -> None:
        self.name = name
        self._returns_s = bus.returns_s
        self._zenoh_id: str | None = None
        self._bus = bus
        self._key = f"{bus.prefix}/worker/{name}"
        self._timeout_s = timeout_s

    def describe(self, timeout_s: float = 10.0) -> WorkerDescription | None:
        """Return the worker's description of itself, None if it takes no grants.

        From now on its answers are those of the program that gave this one.

        Raises
        ------
        WorkerError
            It does not answer in time, its answer is not a description, or another program answers
            in its name as well.
        """
        answers: dict[str | None, zenoh.Sample] = {}
        failed = False
        for reply in self._ask("describe", timeout_s):
            if reply.ok is None:
                failed = True
            else:
                answers.setdefault(_zenoh_id(reply), reply.ok)
        if not answers:
            if failed:
                raise WorkerError(
                    f"worker {self.name!r} is there, but did not describe itself within "
                    f"{timeout_s:g} s; expected an answer to {self._key}/describe"
                )
            return None
        if len(answers) > 1:
            raise WorkerError(
                f"{len(answers)} programs answer as worker {self.name!r} (Zenoh ids "
                f"{', '.join(sorted(map(str, answers)))}); expected one: end the others"
            )
        ((self._zenoh_id, answer),) = answers.items()
        try:
            described = WorkerDescription.model_validate_json(answer.payload.to_bytes())
        except ValidationError as error:
            raise self._broken("answered describe with", error) from None
        if described.name != self.name:
            raise WorkerError(
                f"worker {self.name!r} describes itself as {described.name!r}; expected the "
                "name in its key"
            )
        return described

    def _ask(
        self, what: str, timeout_s: float, payload: bytes | None = None, header: bytes | None = None
    ) -> zenoh.Handler[zenoh.Reply]:
        """Ask all who answer as this worker: Zenoh alone might choose another than it.

        The question waits for no data that somebody among them does not read.
        """
        return self._bus.session.get(
            f"{self._key}/{what}",
            payload=payload,
            attachment=header,
            timeout=timeout_s,
            target=zenoh.QueryTarget.ALL,
            consolidation=zenoh.ConsolidationMode.NONE,
            priority=zenoh.Priority.INTERACTIVE_HIGH,
        )

    def dispatch(self, seq: int, t_ns: int, inputs: Sequence[Input]) -> Pending:
        """Send a grant; a picture that cannot be drawn any more counts as the worker's loss."""
        try:
            payload = b"".join(item.payload for item in inputs)
        except RendererError as error:
            failure = WorkerLost(f"worker {self.name!r} cannot be called: {error}")
            return StepDone(failure=failure)
        grant = Grant(
            t_ns=t_ns,
            seq=seq,
            inputs=tuple(
                GrantInput(
                    key=item.key,
                    t_in_ns=item.t_in_ns,
                    size=item.size,
                    attachment=item.attachment,
                )
                for item in inputs
            ),
        )
        header = grant.model_dump_json().encode()
        replies = self._ask("step", self._timeout_s, payload, header)
        return RemoteStep(self, seq, replies, payload, header)

    def receive(self, step: RemoteStep) -> Reply:
        """Wait for the reply to a grant, and check it; those of other programs are ignored.

        A worker that comes back to a router within `RETURNS_S` is asked again.

        Raises
        ------
        WorkerLost
            None came, or it says that the step failed.
        WorkerError
            It is not a reply to that grant.
        """
        replies = step.replies
        until_s = time.monotonic() + self._returns_s
        while True:
            for reply in replies:
                if not self._is_own(reply):
                    self._ignore(reply)
                    continue
                if reply.err is not None:
                    raise self._lost(reply.err.payload.to_bytes())
                if reply.ok is not None:
                    return self._parse(step.seq, reply.ok)
            while time.monotonic() < until_s and not self._bus.is_alive(f"worker/{self.name}"):
                time.sleep(RETRY_S)
            if time.monotonic() >= until_s:
                break
            replies = self._ask("step", self._timeout_s, step.payload, step.header)
        gone = f"worker {self.name!r} is gone: nothing answers {self._key}/step"
        raise WorkerLost(gone, is_of_machine=True)

    def _is_own(self, reply: zenoh.Reply) -> bool:
        """Return true for what the worker answers, and for what Zenoh says in its stead."""
        zenoh_id = _zenoh_id(reply)
        return zenoh_id == self._zenoh_id or (zenoh_id is None and reply.ok is None)

    def _ignore(self, reply: zenoh.Reply) -> None:
        self._bus.refused(
            f"worker/{self.name}/step",
            f"an answer in the name of worker {self.name!r} was ignored: it came from another "
            f"program (Zenoh id {_zenoh_id(reply)})",
        )

    def _lost(self, payload: bytes) -> WorkerLost:
        text = payload[:400].decode("utf-8", "replace")
        if text == "Timeout":
            slow = f"worker {self.name!r} did not answer within {self._timeout_s:g} s"
            return WorkerLost(slow, is_of_machine=True)
        return WorkerLost(f"worker {self.name!r} failed: {text}")

    def _parse(self, seq: int, sample: zenoh.Sample) -> Reply:
        payload = sample.payload.to_bytes()
        attachment = sample.attachment.to_bytes() if sample.attachment is not None else b""
        if len(payload) + len(attachment) > MAXIMUM_REPLY_BYTES:
            raise WorkerError(
                f"worker {self.name!r} answered with {len(payload)} bytes; expected at most "
                f"{MAXIMUM_REPLY_BYTES}"
            )
        try:
            header = StepReply.model_validate_json(attachment)
            payloads = parts_of(payload, [output.size for output in header.outputs])
        except ValueError as error:
            raise self._broken(f"answered step {seq} with", error) from None
        if header.seq != seq:
            raise WorkerError(
                f"worker {self.name!r} answered step {seq} as step {header.seq}; expected the "
                "seq of the grant"
            )
        self._require_sizes(header)
        outputs = tuple(
            Output(output.key, part, output.t_out_ns, output.attachment)
            for output, part in zip(header.outputs, payloads, strict=True)
        )
        return Reply(outputs, header.compute_s, header.wake_ns, header.missed)

    def _require_sizes(self, header: StepReply) -> None:
        """Complain about an output that is larger than what a run takes on its key."""
        for output in header.outputs:
            model = worker_output(output.key)
            limit = None if model is None else model.limit
            if limit is not None and output.size > limit.size_bytes:
                raise WorkerError(
                    f"worker {self.name!r} published on {shown(output.key)} {output.size:,} bytes; "
                    f"expected at most {limit.size_bytes:,}"
                )

    def _broken(self, what: str, error: ValueError) -> WorkerError:
        text = all_problems(error) if isinstance(error, ValidationError) else str(error)
        return WorkerError(
            f"worker {self.name!r} {what} something else than the schema says: {text}; see "
            "`airhilt schema`"
        )


def _zenoh_id(reply: zenoh.Reply) -> str | None:
    """Return the id of the session that answered, None if Zenoh itself did."""
    return None if reply.replier_id is None else str(reply.replier_id.zid)


@dataclass(frozen=True, slots=True)
class RemoteStep:
    """A grant whose reply has not come yet."""

    worker: RemoteWorker
    seq: int
    replies: zenoh.Handler[zenoh.Reply]
    payload: bytes
    header: bytes

    def result(self) -> Reply:
        """Wait for the reply; see `RemoteWorker.receive`."""
        return self.worker.receive(self)
