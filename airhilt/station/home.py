"""The application of the first page: choose a scenario, start a run, open a debrief."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI
from pydantic import BaseModel, ConfigDict, Field

from airhilt.errors import AirhiltError
from airhilt.host.text import readable
from airhilt.options import Options, options_of
from airhilt.station.app import page_app
from airhilt.station.debriefs import Debriefs
from airhilt.station.scenario_choices import ScenarioChoices
from airhilt.station.started_runs import StartedRuns

OFFERED = (
    "seed", "seat", "assistant", "snr_db", "visibility_m", "cameras", "speech", "isa_minutes",
    "nasa_tlx", "voice_recording", "radar", "equipment", "crews",
)  # fmt: skip
"""Options of a run that the page offers."""
Name = Field(min_length=1, max_length=200)


class RunWish(BaseModel):
    """A run that a page asks for."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    scenario: str = Name
    options: dict[str, Any] = Field(default_factory=dict, max_length=len(OFFERED))


class DebriefWish(BaseModel):
    """A debrief that a page asks for: of one run, or of two side by side."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    runs: tuple[str, ...] = Field(min_length=1, max_length=2)


def home_app(
    choices: ScenarioChoices, started: StartedRuns, debriefs: Debriefs, assistants: list[str]
) -> FastAPI:
    """Return the application on whose page everything is chosen."""
    app = page_app("home.html")

    @app.get("/api/station")
    def station() -> dict[str, Any]:
        return {
            "folder": str(started.folder),
            "scenarios": choices.rows(),
            "assistants": assistants,
        }

    @app.get("/api/runs")
    def runs() -> dict[str, Any]:
        return {"started": started.rows(), "recorded": debriefs.rows()}

    @app.post("/api/runs")
    def start(wish: RunWish) -> dict[str, str]:
        return {"name": started.start(choices.path(wish.scenario), options_of_page(wish.options))}

    @app.post("/api/runs/{name}/stop")
    def stop(name: str) -> dict[str, str]:
        started.stop(name)
        return {"name": name}

    @app.post("/api/debriefs")
    async def debrief(wish: DebriefWish) -> dict[str, str]:
        return {"url": f"debriefs{await debriefs.open(wish.runs)}"}

    app.mount("/debriefs", debriefs.router)
    return app


def options_of_page(given: dict[str, Any]) -> Options:
    """Return the options that a page gives.

    Raises
    ------
    AirhiltError
        The page does not offer one of them, or a value is not what the option takes.
    """
    for name in given:
        if name not in OFFERED:
            raise AirhiltError(f"option {readable(name)!r}: the page does not offer it")
    return options_of(given)
