"""Registration of workers and their time grants."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from typing import Any, Literal

from pydantic import Field

from airhilt.messages.base import Nanoseconds, Part
from airhilt.messages.run import Modality


def is_match(key: str, pattern: str) -> bool:
    """Return whether a key is one of a pattern in which ``*`` stands for one chunk."""
    chunks, parts = key.split("/"), pattern.split("/")
    return len(parts) == len(chunks) and all(
        part in ("*", chunk) for part, chunk in zip(parts, chunks, strict=True)
    )


class InputSpec(Part):
    """Key that a worker subscribes to, relative to the run, and the policy of its queue.

    ``fifo``: a step takes the oldest input. ``latest``: the queue keeps only the newest input and
    counts those that it drops. ``batch``: a step takes all inputs that wait.
    """

    key: str = Field(examples=["adsb/*"])
    policy: Literal["fifo", "latest", "batch"] = "fifo"


class DeclaredLatency(Part):
    """Latency that a worker declares, for `--latency fixed` and `lognormal`."""

    median_s: float = Field(ge=0.0)
    sigma: float = Field(default=0.25, ge=0.0, description="of the logarithm, for lognormal")


WORKER_NAME = r"^[a-z0-9_-]+$"
RUN = "run"
"""Publisher of the messages of the run itself."""
UNREGISTERED = "unregistered"
"""Publisher of the messages of programs that take no grants."""


class WorkerDescription(Part):
    """Answer to a query on ``worker/<name>/describe``."""

    name: str = Field(pattern=WORKER_NAME)
    modality: Modality
    inputs: tuple[InputSpec, ...] = Field(min_length=1)
    latency: DeclaredLatency = DeclaredLatency(median_s=0.1)
    engine: str = Field(
        "",
        description="name of the decision engine in AIRHILT's decision worker, such as reference; "
        "empty for other workers",
    )
    configuration: dict[str, Any] = Field(
        default_factory=dict,
        description="rules and thresholds of that engine, whole; empty if it has none",
    )


class GrantInput(Part):
    """Input of a grant. Its bytes are in the payload, in the order of the inputs."""

    key: str
    t_in_ns: Nanoseconds
    size: int = Field(ge=0, description="bytes of the payload that are this input's")
    attachment: Any = Field(default=None, description="JSON header of raw inputs, else null")


class Grant(Part):
    """Attachment of a query on ``worker/<name>/step``: the worker computes at time ``t_ns``."""

    t_ns: Nanoseconds
    seq: int = Field(ge=0)
    inputs: tuple[GrantInput, ...]


class StepOutput(Part):
    """Output of a step. Its bytes are in the payload of the reply, in the order of the outputs."""

    key: str
    size: int = Field(ge=0)
    t_out_ns: Nanoseconds | None = Field(
        default=None,
        description="time at which it leaves the worker, not before the grant's t_ns; null: when "
        "the latency has passed",
    )
    attachment: Any = None


class StepReply(Part):
    """Attachment of the reply to a grant."""

    seq: int = Field(ge=0)
    compute_s: float = Field(ge=0.0, description="wall time that the step took")
    outputs: tuple[StepOutput, ...] = ()
    wake_ns: Nanoseconds | None = Field(
        default=None, description="call again at this time even without inputs"
    )
    missed: str = Field(default="", description="why an input has no result; empty if all have one")


def parts_of(payload: bytes, sizes: Sequence[int]) -> list[bytes]:
    """Return the bytes of each input or output of a payload, by their sizes.

    Raises
    ------
    ValueError
        The sizes do not add up to the payload's.
    """
    if sum(sizes) != len(payload):
        raise ValueError(f"{len(payload)} bytes of payload, but sizes {list(sizes)}")
    ends = accumulate(sizes)
    return [payload[end - size : end] for size, end in zip(sizes, ends, strict=True)]
