"""The headers that tell a service what a request is about, the same for all services."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any
from urllib.parse import quote, unquote

from pydantic import BaseModel, ConfigDict, Field, PlainSerializer

SAFE = " !#$&'()*+/:;<=>?@[]^`{|}"
"""Characters of a value that are sent as they are, besides letters, digits and ``_.-~``."""


def _encoded(text: str) -> str:
    return quote(text, SAFE)


def _joined(texts: tuple[str, ...]) -> str:
    return ",".join(map(_encoded, texts))


Text = Annotated[str, PlainSerializer(_encoded)]
Texts = Annotated[tuple[str, ...], PlainSerializer(_joined)]


class ServiceHeaders(BaseModel):
    """Headers of a request. One whose value is not known, or that means nothing there, is left out.

    Other text than ASCII is percent-encoded.
    """

    model_config = ConfigDict(frozen=True, populate_by_name=True, extra="ignore")
    run_id: Text | None = Field(
        default=None,
        alias="X-Run-Id",
        description="the same in all requests of one run to an assistant",
    )
    ts_ms: int | None = Field(
        default=None,
        alias="X-Ts-Ms",
        ge=0,
        description="milliseconds since the start of the run: of the start of a call, of the end "
        "of an exposure, or of the request to an assistant",
    )
    turn_id: Text | None = Field(
        default=None, alias="X-Turn-Id", description="id of the transmission"
    )
    frequency_khz: int | None = Field(default=None, alias="X-Frequency-Khz", ge=0)
    speaker: Text | None = Field(
        default=None,
        alias="X-Speaker",
        description="who speaks: of a call, the unit whose transmitter was keyed, as far as a "
        "receiver can know",
    )
    callsigns: Texts | None = Field(
        default=None,
        alias="X-Callsigns",
        description="callsigns of the roster, with commas between them",
    )
    camera_id: Text | None = Field(default=None, alias="X-Camera-Id")
    offset_px: Annotated[str, Field(pattern=r"^\d+,\d+$")] | None = Field(
        default=None,
        alias="X-Offset-Px",
        description="left and top of the picture in that of the camera",
    )
    mask: str | None = Field(
        default=None,
        alias="X-Mask",
        description="PNG in base64, white where the camera's own aircraft may be",
    )

    @classmethod
    def decoded(cls, headers: Mapping[str, str]) -> ServiceHeaders:
        """Return the headers of a request that has come.

        Raises
        ------
        pydantic.ValidationError
            A value is none.
        """
        sent = {name.lower(): value for name, value in headers.items()}
        values: dict[str, object] = {}
        for name, field in cls.model_fields.items():
            if (value := sent.get(str(field.alias).lower())) is not None:
                values[name] = (
                    tuple(map(unquote, filter(None, value.split(","))))
                    if name == "callsigns"
                    else unquote(value)
                )
        return cls.model_validate(values)

    def encoded(self) -> dict[str, str]:
        """Return the headers of a request."""
        values: dict[str, Any] = self.model_dump(by_alias=True, exclude_none=True)
        return {name: str(value) for name, value in values.items()}
