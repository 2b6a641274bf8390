"""Base class of the models of a scenario file, and the names that they share."""

from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field
from pydantic_core import PydanticCustomError


def _without_hyphen(value: Any) -> Any:
    """Return a callsign unchanged; one with a hyphen, as registrations are painted, is refused."""
    if isinstance(value, str) and "-" in value:
        raise PydanticCustomError(
            "callsign_hyphen",
            "expected it without a hyphen, {plain}, as in flight plans (ICAO Doc 4444, appendix 2, "
            "item 7)",
            {"plain": value.replace("-", "")},
        )
    return value


Callsign = Annotated[
    str,
    Field(pattern=r"^[A-Z0-9]{2,8}$", examples=["AAL123"]),
    BeforeValidator(_without_hyphen),
]
Identifier = Annotated[str, Field(pattern=r"^[A-Za-z0-9_.-]{1,40}$")]

MOST_COMMANDS = 50
"""Greatest number of commands that one call, or a start, gives."""


class Model(BaseModel):
    """Part of a scenario file. It is immutable and refuses fields that it does not know."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)
