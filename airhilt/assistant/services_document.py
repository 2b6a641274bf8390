"""The requests of a run to services, and their answers, as an OpenAPI document."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel
from pydantic.json_schema import models_json_schema

from airhilt._version import __version__
from airhilt.assistant.asr.service_messages import Transcription, TranscriptionForm
from airhilt.assistant.decision.service_messages import AssistantAnswer, AssistantRequest
from airhilt.assistant.vision.service_messages import DetectionAnswer, PictureRequest
from airhilt.host.service_headers import ServiceHeaders
from airhilt.voices.service_messages import LineRequest, SpeechRequest

Json = dict[str, Any]
BINARY: Json = {"type": "string", "format": "binary"}
MODELS: tuple[type[BaseModel], ...] = (
    TranscriptionForm,
    Transcription,
    SpeechRequest,
    LineRequest,
    PictureRequest,
    DetectionAnswer,
    AssistantRequest,
    AssistantAnswer,
)
CALL = ("ts_ms", "turn_id", "frequency_khz", "speaker", "callsigns")
"""Fields of `ServiceHeaders` about a call."""
PICTURE = ("ts_ms", "camera_id")
FAILURE = (
    "Any other status, an answer that is not of the schema, and none in time are failures. The run "
    "tells the text, or what is in `error`, `message` or `detail`, and goes on. The third in a row "
    "is the loss of the service. Redirects are not followed."
)


def services_document() -> Json:
    """Return the OpenAPI 3.1 document of all services."""
    _, found = models_json_schema(
        [(model, "validation") for model in MODELS], ref_template="#/components/schemas/{model}"
    )
    call, transcription = _json(TranscriptionForm), _json(Transcription)
    wav, png = {"audio/wav": {"schema": BINARY}}, {"image/png": {"schema": BINARY}}
    form = {"multipart/form-data": call["application/json"]}
    detections = _json(DetectionAnswer)
    picture = (*PICTURE, "offset_px", "mask")
    return {
        "openapi": "3.1.0",
        "info": {
            "title": "Services of AIRHILT",
            "version": __version__,
            "description": "Requests of a run to --asr, --tts, --detector and --assistant. The end "
            "of the path of an address chooses the form of the request.",
        },
        "paths": {
            "/v1/audio/transcriptions": _post("--asr: OpenAI's API", form, transcription, CALL),
            "/inference": _post("--asr: the server of whisper.cpp", form, transcription, CALL),
            "/asr": _post("--asr: any other path", wav, transcription, CALL),
            "/v1/audio/speech": _post("--tts: OpenAI's API", _json(SpeechRequest), wav),
            "/tts": _post("--tts: any other path", _json(LineRequest), wav),
            "/v1/detections": _post("--detector", _json(PictureRequest), detections, PICTURE),
            "/detector": _post("--detector: any other path", png, detections, picture),
            "/v1/advisories": _post(
                "--assistant: any path",
                _json(AssistantRequest),
                _json(AssistantAnswer),
                ("run_id", "ts_ms", "callsigns"),
            ),
        },
        "security": [{}, {"key": []}],
        "components": {
            "schemas": found["$defs"],
            "securitySchemes": {
                "key": {
                    "type": "http",
                    "scheme": "bearer",
                    "description": "from AIRHILT_ASR_KEY, AIRHILT_TTS_KEY, AIRHILT_DETECTOR_KEY or "
                    "AIRHILT_ASSISTANT_KEY of the environment",
                }
            },
        },
    }


def _json(model: type[BaseModel]) -> Json:
    return {"application/json": {"schema": {"$ref": f"#/components/schemas/{model.__name__}"}}}


def _post(summary: str, request: Json, answer: Json, headers: tuple[str, ...] = ()) -> Json:
    return {
        "post": {
            "summary": summary,
            "parameters": [_parameter(name) for name in headers],
            "requestBody": {"required": True, "content": request},
            "responses": {
                "200": {"description": "The answer.", "content": answer},
                "default": {"description": FAILURE},
            },
        }
    }


def _parameter(name: str) -> Json:
    field = ServiceHeaders.model_fields[name]
    alias = str(field.alias)
    schema = dict(ServiceHeaders.model_json_schema()["properties"][alias])
    description = schema.pop("description", None)
    (schema,) = [each for each in schema["anyOf"] if each != {"type": "null"}]
    told = {} if description is None else {"description": description}
    return {"name": alias, "in": "header", **told, "schema": schema}
