"""The messages of a page: what it watches, and what its person does at a seat."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field, model_validator

from airhilt.messages import SeatAct


class PageMessage(BaseModel):
    """Message of a page: exactly one of ``watch``, ``act`` and ``echo``.

    Acts are answered in their order with ``{"answer": reason}``, which is empty if the run has
    accepted the act. The voice comes in binary messages of PCM while the button is held.
    """

    model_config = ConfigDict(extra="forbid")
    watch: str | None = Field(
        default=None,
        max_length=80,
        pattern=r"^[A-Za-z0-9_.-]+$",
        description="the camera whose pictures are shown, null for none",
    )
    act: SeatAct | None = Field(default=None, description="an act at a seat")
    seat: str = Field(default="", max_length=80, description="the seat to take, with that act")
    echo: float | None = Field(
        default=None, allow_inf_nan=False, description="a number that is sent back"
    )

    @model_validator(mode="after")
    def _is_one(self) -> PageMessage:
        if len({"watch", "act", "echo"} & self.model_fields_set) != 1:
            raise ValueError("expected exactly one of watch, act, echo")
        return self
