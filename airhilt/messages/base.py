"""Shared parts of the messages: base classes, times, limits and severities."""

from __future__ import annotations

import re
from enum import StrEnum
from typing import Annotated, ClassVar, NamedTuple

from pydantic import BaseModel, ConfigDict, Field

LAST_NS = 2**63 - 1
"""Latest time that a message may name, in ns: the greatest integer of 64 bits, 292 years."""
Nanoseconds = Annotated[
    int, Field(ge=0, le=LAST_NS, description="nanoseconds since the start of the run")
]
Confidence = Annotated[float, Field(ge=0.0, le=1.0)]
VisibleClass = Annotated[
    str,
    Field(
        pattern=r"^[a-z][a-z0-9_-]{0,39}$",
        description="class of what cameras see, by COCO's name where COCO has one",
        examples=["airplane", "truck", "bird", "deer", "coyote"],
    ),
]
"""Class of what cameras see. Each kind of actor has its own; a detector knows those on its card."""


class Part(BaseModel):
    """Part of a message. It is immutable and refuses fields that it does not know."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class Limit(NamedTuple):
    """Most that a run takes of the messages that come from outside on the keys of a class.

    Attributes
    ----------
    size_bytes
        Greatest size of one message; of raw bytes with a header, that of the bytes.
    rate_hz
        Greatest number in a second of wall time from all programs that take no grants, together.
    """

    size_bytes: int
    rate_hz: int


class Message(Part):
    """Base class of the messages.

    Attributes
    ----------
    limit
        What a run takes of them from outside; None: they never come from outside. The numbers are
        assumptions: at least ten times what AIRHILT's own workers need.
    """

    limit: ClassVar[Limit | None] = None
    t_ns: Nanoseconds = Field(default=0, description="time of publication, set by the run")


class Header(Message):
    """Message that is the attachment to raw bytes, the payload of the key."""


class Severity(StrEnum):
    """Urgency of an advisory, in rising order."""

    INFO = "INFO"
    ADVISORY = "ADVISORY"
    CAUTION = "CAUTION"
    WARNING = "WARNING"

    @property
    def rank(self) -> int:
        """Rank of the severity: 0 for INFO to 3 for WARNING."""
        return _SEVERITY_ORDER.index(self)


_SEVERITY_ORDER = tuple(Severity)
SPEAK_MIN_LEVEL = Severity.CAUTION
"""Least severity that is spoken and counts as a warning (AIRHILT, arXiv 2511.18718); advisories
below it are only shown."""


def key_chunk(name: str) -> str:
    """Return the name of a unit or an actor as a part of keys."""
    return re.sub("[^A-Za-z0-9]+", "_", name)
