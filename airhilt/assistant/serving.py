"""Engines of AIRHILT behind addresses: the other side of the services that a run asks."""

from __future__ import annotations

import base64
import binascii
import io
import threading
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from fastapi import FastAPI, HTTPException, Request, Response
from fastapi.concurrency import run_in_threadpool
from PIL import Image, UnidentifiedImageError
from prometheus_client import CONTENT_TYPE_LATEST
from pydantic import BaseModel, ValidationError

from airhilt.assistant.asr.engine import AsrEngine, Call, recognised
from airhilt.assistant.asr.service_messages import TranscribedWord, Transcription, TranscriptionForm
from airhilt.assistant.decision.served import ServedAssistant
from airhilt.assistant.decision.service_messages import AssistantRequest
from airhilt.assistant.reference import decision_worker
from airhilt.assistant.service_kinds import PATHS, ServiceKind
from airhilt.assistant.service_metrics import ServiceMetrics
from airhilt.assistant.services_document import services_document
from airhilt.assistant.vision.detector import Detector, DetectsShots, Shot
from airhilt.assistant.vision.gating import SeesParts
from airhilt.assistant.vision.service_messages import DetectionAnswer, FoundObject, PictureRequest
from airhilt.assistant.vision.tiling import Tile
from airhilt.audio.wav import decode_speech, encode_wav
from airhilt.engine_families import DETECTORS, RECOGNISERS, VOICES
from airhilt.errors import AirhiltError, all_problems
from airhilt.host.forms import decoded_form
from airhilt.host.service_headers import ServiceHeaders
from airhilt.units import MILLISECOND_NS
from airhilt.voices.engine import TtsEngine, VoiceSpec
from airhilt.voices.service_messages import SpeechRequest

MOST_PIXELS = 40_000_000
"""Largest picture that is looked at."""


def service_app(kind: ServiceKind, engine: str) -> FastAPI:
    """Return the application that answers as one engine.

    It answers one request after the other: engines do one thing at a time.

    Raises
    ------
    AirhiltError
        The engine cannot be loaded.
    """
    answer = _ANSWERS[kind](engine)
    metrics = ServiceMetrics(kind, engine)
    app = FastAPI(docs_url=None, redoc_url=None, openapi_url=None)
    lock = threading.Lock()

    def locked(body: bytes, headers: Mapping[str, str]) -> Response:
        with metrics.in_progress(), lock, metrics.engine_time():
            return answer(body, headers)

    @app.post(PATHS[kind])
    async def post(request: Request) -> Response:
        body = await request.body()
        status = 500
        try:
            answered = await run_in_threadpool(locked, body, request.headers)
            status = answered.status_code
        except ValidationError as error:
            status = 422
            raise HTTPException(status, all_problems(error)) from None
        except AirhiltError as error:
            status = 422
            raise HTTPException(status, str(error)) from None
        finally:
            metrics.answered(status)
        return answered

    @app.get("/metrics")
    async def measured() -> Response:
        return Response(metrics.text(), media_type=CONTENT_TYPE_LATEST)

    @app.get("/health")
    async def health() -> dict[str, str]:
        return {"status": "ok", "kind": kind, "engine": engine}

    @app.get("/openapi.json")
    async def openapi() -> dict[str, Any]:
        return services_document()

    return app


Answer = Callable[[bytes, Mapping[str, str]], Response]


def _asr(name: str) -> Answer:
    engine: AsrEngine = RECOGNISERS.create(name)

    def answer(body: bytes, headers: Mapping[str, str]) -> Response:
        fields = decoded_form(body, headers.get("content-type", ""))
        texts = {
            field: value if field == "file" else value.decode("utf-8", "replace")
            for field, value in fields.items()
        }
        form = TranscriptionForm.model_validate({"model": name, **texts})
        told = ServiceHeaders.decoded(headers)
        call = Call(
            told.turn_id or "",
            told.frequency_khz or 0,
            (told.ts_ms or 0) * MILLISECOND_NS,
            told.speaker,
            told.callsigns or (),
        )
        heard = recognised(engine, decode_speech(form.file, "file"), call)
        words = tuple(
            TranscribedWord.model_validate({"word": word, "probability": sure})
            for word, sure in heard.words
        )
        return _json(Transcription(text=heard.text, confidence=heard.confidence, words=words))

    return answer


def _tts(name: str) -> Answer:
    engine: TtsEngine = VOICES.create(name)

    def answer(body: bytes, _: Mapping[str, str]) -> Response:
        request = SpeechRequest.model_validate_json(body)
        own = engine.voice_of(request.voice)
        voice = VoiceSpec(own.name, own.rate * request.speed, own.pitch)
        wav = encode_wav(engine.synthesise(request.input, voice))
        return Response(wav, media_type="audio/wav")

    return answer


def _vision(name: str) -> Answer:
    engine: Detector = DETECTORS.create(name)

    def answer(body: bytes, _: Mapping[str, str]) -> Response:
        request = PictureRequest.model_validate_json(body)
        picture = np.asarray(_picture(request.image).convert("RGB"))
        left, top = request.offset_px
        own = None if request.ego_mask is None else _picture(request.ego_mask).convert("1")
        shot = Shot(
            request.camera_id,
            request.ts_ms * MILLISECOND_NS,
            left,
            top,
            None if own is None else np.asarray(own),
        )
        if request.window_px is not None and isinstance(engine, SeesParts):
            left, top, right, bottom = request.window_px
            found = engine.detect_in(picture, Tile(top, left, bottom - top, right - left), shot)
        elif isinstance(engine, DetectsShots):
            found = engine.detect_shot(picture, shot)
        else:
            found = engine.detect(picture)
        objects = tuple(FoundObject.model_validate(each._asdict()) for each in found)
        return _json(
            DetectionAnswer(
                detections=objects,
                threshold=engine.threshold,
                looks_at_windows=isinstance(engine, SeesParts),
            )
        )

    return answer


def _decision(name: str) -> Answer:
    assistant = ServedAssistant(lambda: decision_worker(name))

    def answer(body: bytes, headers: Mapping[str, str]) -> Response:
        run_id = ServiceHeaders.decoded(headers).run_id or ""
        return _json(assistant.answer(AssistantRequest.model_validate_json(body), run_id))

    return answer


_ANSWERS: Mapping[ServiceKind, Callable[[str], Answer]] = {
    "asr": _asr,
    "tts": _tts,
    "vision": _vision,
    "decision": _decision,
}


def _json(model: BaseModel) -> Response:
    return Response(model.model_dump_json(), media_type="application/json")


def _picture(text: str) -> Image.Image:
    """Return a PNG in base64, whole."""
    try:
        picture = Image.open(io.BytesIO(base64.b64decode(text, validate=True)), formats=["PNG"])
        if picture.width * picture.height > MOST_PIXELS:
            raise AirhiltError(f"image: more than {MOST_PIXELS:,} pixels; expected no more")
        picture.load()
    except UnidentifiedImageError:
        raise AirhiltError("image: no PNG; expected PNG in base64") from None
    except (binascii.Error, OSError, SyntaxError) as error:
        raise AirhiltError(f"image: {error}; expected PNG in base64") from None
    return picture
