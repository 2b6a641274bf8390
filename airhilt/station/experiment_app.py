"""The application of the page of a participant in an experiment."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI

from airhilt.messages import NasaTlx
from airhilt.station.app import page_app, refuse_in_words
from airhilt.station.experiment import Conductor


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
    def answer(answers: NasaTlx) -> dict[str, Any]:
        conductor.answer(answers)
        return conductor.state()

    refuse_in_words(app)
    return app
