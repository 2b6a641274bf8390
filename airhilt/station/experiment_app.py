"""The application of the page of a participant in an experiment."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI
from pydantic import BaseModel, ConfigDict, Field

from airhilt.station.app import page_app, refuse_in_words
from airhilt.station.experiment import Conductor
from airhilt.station.questionnaires import Answers


class GivenAnswers(BaseModel):
    """Answers of a page to the questionnaire of a name."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    questionnaire: str = Field(max_length=40)
    answers: Answers = Field(max_length=100)


def experiment_app(conductor: Conductor) -> FastAPI:
    """Return the application that leads a participant through the trials."""
    app = page_app("experiment.html")

    @app.get("/api/experiment")
    def state() -> dict[str, Any]:
        return conductor.state()

    @app.post("/api/begin")
    def begin() -> dict[str, Any]:
        conductor.begin()
        return conductor.state()

    @app.post("/api/answers")
    def answer(given: GivenAnswers) -> dict[str, Any]:
        conductor.answer(given.questionnaire, given.answers)
        return conductor.state()

    refuse_in_words(app)
    return app
