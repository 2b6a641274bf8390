"""The application of a station: what each address of the server answers."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Sequence
from typing import Annotated, Any

from fastapi import FastAPI, Query, Request, Response, WebSocket
from fastapi.exceptions import RequestValidationError
from fastapi.responses import FileResponse, JSONResponse

from airhilt.audio.pcm import from_pcm
from airhilt.audio.wav import encode_wav
from airhilt.errors import AirhiltError
from airhilt.host.text import LONGEST_LINE, readable
from airhilt.station.browsers import Browsers
from airhilt.station.debrief import Debrief
from airhilt.station.page_files import media_type, page_files
from airhilt.station.phrases import Situation, offered
from airhilt.station.pictures import jpeg
from airhilt.station.questionnaires import NASA_TLX
from airhilt.station.subscription import Subscription

Identity = Annotated[str, Query(max_length=64)]
"""Name of an open page, which only it and the server know."""
NOT_FOR_YOU = "airhilt: refused: this is not for the seat of your browser\n"


def debrief_app(debrief: Debrief) -> FastAPI:
    """Return the application that shows a recorded run."""
    app = page_app()
    document = _json(debrief.document)

    @app.get("/api/run")
    def run() -> Response:
        return Response(document, media_type="application/json")

    @app.get("/api/cameras/{name}")
    def camera(name: str) -> Response:
        return Response(_json(debrief.camera(name)), media_type="application/json")

    @app.get("/api/cameras/{name}/{seq}.jpg")
    def picture(name: str, seq: int) -> Response:
        return Response(debrief.picture(name, seq), media_type="image/jpeg")

    @app.get("/api/sounds/{name}.wav")
    def sound(name: str) -> FileResponse:
        return FileResponse(debrief.sounds.wav(name), media_type="audio/wav")

    return app


def recorded_app(debriefs: Sequence[Debrief]) -> FastAPI:
    """Return the application that shows a recorded run, or two side by side on one clock."""
    if len(debriefs) == 1:
        return debrief_app(debriefs[0])
    app = page_app("together.html")
    for number, debrief in enumerate(debriefs):
        app.mount(f"/{number}", debrief_app(debrief))
    return app


def live_app(subscription: Subscription, browsers: Browsers) -> FastAPI:
    """Return the application that shows a run while it goes on."""
    app = page_app()

    @app.get("/api/run")
    def run() -> Response:
        own = {
            "run": subscription.run,
            "seats": browsers.seats,
            "version": browsers.version,
            "nasa_tlx": NASA_TLX.document(),
        }
        return Response(_json(LIVE | own), media_type="application/json")

    @app.get("/api/cameras/{name}/{seq}.jpg")
    async def picture(name: str, seq: int, browser: Identity = "") -> Response:
        found = subscription.picture(name, seq)
        if found is None or not browsers.admits(browser, found.audience):
            return _nothing(found)
        return Response(await asyncio.to_thread(jpeg, found), media_type="image/jpeg")

    @app.get("/api/calls/{name}.wav")
    async def sound(name: str, browser: Identity = "") -> Response:
        found = subscription.sound(name)
        if found is None or not browsers.admits(browser, found.audience):
            return _nothing(found)
        return Response(encode_wav(from_pcm(found.pcm)), media_type="audio/wav")

    @app.websocket("/api/live")
    async def live(
        socket: WebSocket,
        begin: Annotated[int, Query(alias="from", ge=0)] = 0,
        browser: Identity = "",
        version: Annotated[str, Query(max_length=300)] = "",
        shown: Annotated[str | None, Query(max_length=80)] = None,
    ) -> None:
        await browsers.serve(socket, begin, browser, version, shown)

    @app.post("/api/phrases")
    def phrases(situation: Situation) -> list[dict[str, str]]:
        return offered(situation)

    return app


def page_app(first: str = "index.html") -> FastAPI:
    """Return an application that has the files of the pages alone, and refuses in words.

    Parameters
    ----------
    first
        File with which it begins.
    """
    app = FastAPI(openapi_url=None, docs_url=None, redoc_url=None)
    files = page_files()

    @app.get("/")
    def index() -> Response:
        return Response(files[first], media_type=media_type(first))

    @app.get("/page/{name}")
    def file(name: str) -> Response:
        if name not in files:
            return Response(f"no file {readable(name)}\n", status_code=404, media_type="text/plain")
        return Response(files[name], media_type=media_type(name))

    @app.exception_handler(AirhiltError)
    def failed(_: Request, error: AirhiltError) -> Response:
        return _refusal(str(error))

    @app.exception_handler(RequestValidationError)
    def garbage(_: Request, error: RequestValidationError) -> Response:
        problem = error.errors()[0]
        place = "/".join(str(part) for part in problem["loc"][1:])
        return _refusal(f"{place or 'request'}: {problem['msg']}")

    return app


LIVE: dict[str, Any] = {
    "live": True,
    "scenario": {"name": "", "title": "", "description": ""},
    "phase": "waiting",
    "notes": [],
    "end_s": 0.0,
    "pair": None,
    "airport": None,
    "summary": None,
} | dict.fromkeys(
    ("tracks", "events", "calls", "spoken", "advisories", "cameras", "latencies", "sounds"), ()
)
"""Document with which the page of a run that goes on begins."""


def _json(document: Any) -> bytes:
    return json.dumps(document, separators=(",", ":"), allow_nan=False).encode()


def _nothing(found: object | None) -> Response:
    """Return the answer where a picture or a sound has gone already, or is for somebody else."""
    if found is None:
        return Response(status_code=204)
    return Response(NOT_FOR_YOU, status_code=403, media_type="text/plain")


def _refusal(text: str) -> JSONResponse:
    return JSONResponse({"error": readable(text, LONGEST_LINE)}, status_code=400)
