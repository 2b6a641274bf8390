"""Answers the grants of a run in another process, over Zenoh."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import zenoh
from pydantic import ValidationError

from airhilt.bus.session import (
    ROOT,
    close_session,
    connect_client,
    find_run,
    wait_until_over,
)
from airhilt.errors import BusError
from airhilt.messages import Grant, StepOutput, StepReply, parts_of
from airhilt.sim.worker import Input
from airhilt.workers.protocol import Worker, checked, described, timed_step


def answer_grants(
    worker: Worker, connect: str | None, run: str | None, patience_s: float, tls: Path | None
) -> None:
    """Attach a worker to a run, and return when the run is over; see `airhilt.workers.serve`."""
    session = connect_client(connect, patience_s, tls)
    try:
        prefix = f"{ROOT}/{run}" if run else find_run(session, patience_s)
        _serve(session, worker, prefix)
    finally:
        close_session(session)


def _serve(session: zenoh.Session, worker: Worker, prefix: str) -> None:
    description = described(worker)
    name = description.name
    key = f"{prefix}/worker/{name}"

    def describe(query: zenoh.Query) -> None:
        with query:
            query.reply(f"{key}/describe", description.model_dump_json().encode())

    answers: dict[int, tuple[bytes, bytes]] = {}
    """The last answer, by its number: a run that a cut has kept from it asks again."""

    def step(query: zenoh.Query) -> None:
        with query:
            try:
                grant = _grant(query)
                if grant.seq not in answers:
                    answer = _answer(name, worker, grant, query)
                    answers.clear()
                    answers[grant.seq] = answer
                payload, attachment = answers[grant.seq]
            except (Exception, SystemExit) as error:
                query.reply_err(f"{type(error).__name__}: {error}".encode())
                raise
            query.reply(f"{key}/step", payload, attachment=attachment)

    kept: list[Any] = [
        session.declare_queryable(f"{key}/describe", describe),
        session.declare_queryable(f"{key}/step", step),
        session.liveliness().declare_token(key),
    ]
    wait_until_over(session, prefix)
    for entity in kept:
        entity.undeclare()


def _grant(query: zenoh.Query) -> Grant:
    if query.attachment is None:
        raise BusError("a grant without an attachment")
    try:
        return Grant.model_validate_json(query.attachment.to_bytes())
    except ValidationError as error:
        raise BusError(f"not a grant: {error}") from None


def _answer(name: str, worker: Worker, grant: Grant, query: zenoh.Query) -> tuple[bytes, bytes]:
    payload = query.payload.to_bytes() if query.payload is not None else b""
    parts = parts_of(payload, [item.size for item in grant.inputs])
    inputs = [
        Input(item.key, item.t_in_ns, part, item.attachment)
        for item, part in zip(grant.inputs, parts, strict=True)
    ]
    result, compute_s = timed_step(worker, grant.t_ns, inputs)
    step = checked(name, result)
    header = StepReply(
        seq=grant.seq,
        compute_s=compute_s,
        outputs=tuple(
            StepOutput(
                key=output.key,
                size=len(output.payload),
                t_out_ns=output.t_out_ns,
                attachment=output.attachment,
            )
            for output in step.outputs
        ),
        wake_ns=step.wake_ns,
        missed=step.missed,
    )
    return b"".join(output.payload for output in step.outputs), header.model_dump_json().encode()
