"""Requests for speech to a service. The answer is a WAV file."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field


class SpeechRequest(BaseModel):
    """A text to speak, as OpenAI's API takes it (Create speech, 2024-11)."""

    model_config = ConfigDict(allow_inf_nan=False)
    model: str = ""
    input: str
    voice: str = Field(description="one of the voices of the address, or the name of the speaker")
    response_format: Literal["wav"] = "wav"
    speed: float = Field(default=1.0, ge=0.25, le=4.0)


class LineRequest(BaseModel):
    """A text to speak, as services of other paths take it."""

    text: str
    voice: str = Field(description="as in the `SpeechRequest`")
    rate: float = Field(default=1.0, description="of speaking; 1 is the service's own")
    pitch: float = Field(default=1.0, description="of the voice; 1 is the service's own")
