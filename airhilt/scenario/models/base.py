"""Base class of the models of a scenario file, and the names that they share."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Callsign = Annotated[str, Field(pattern=r"^[A-Z0-9]{2,8}$", examples=["AAL123"])]
Identifier = Annotated[str, Field(pattern=r"^[A-Za-z0-9_.-]{1,40}$")]

MOST_COMMANDS = 50
"""Greatest number of commands that one call, or a start, gives."""


class Model(BaseModel):
    """Part of a scenario file. It is immutable and refuses fields that it does not know."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)
