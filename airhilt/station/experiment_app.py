"""The application of the page of the participants in the trials of an experiment."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import FastAPI, Query
from pydantic import BaseModel, ConfigDict, Field

from airhilt.station.app import page_app
from airhilt.station.conductor import Conductor
from airhilt.station.questionnaires import Answers

Participant = Annotated[str, Query(max_length=20)]
"""Identifier of who looks at the page; empty: who alone is led, or nobody yet."""


class GivenAnswers(BaseModel):
    """Answers of a page to the questionnaire of a name."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    questionnaire: str = Field(max_length=40)
    answers: Answers = Field(max_length=100)


def experiment_app(conductor: Conductor) -> FastAPI:
    """Return the application that leads participants through the trials."""
    app = page_app("experiment.html")

    @app.get("/api/experiment")
    def state(participant: Participant = "") -> dict[str, Any]:
        return conductor.state(participant)

    @app.post("/api/begin")
    def begin(participant: Participant = "") -> dict[str, Any]:
        conductor.begin(participant)
        return conductor.state(participant)

    @app.post("/api/answers")
    def answer(given: GivenAnswers, participant: Participant = "") -> dict[str, Any]:
        conductor.answer(given.questionnaire, given.answers, participant)
        return conductor.state(participant)

    return app
