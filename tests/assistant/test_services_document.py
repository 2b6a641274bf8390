"""The document of services: complete in itself, and of what is sent."""

from __future__ import annotations

import json
import re
from http.server import BaseHTTPRequestHandler
from typing import Any

import numpy as np
import pytest

from airhilt.assistant.asr.engine import Call
from airhilt.assistant.asr.engines.http import HttpAsr
from airhilt.assistant.decision.engines.http import AssistantService
from airhilt.assistant.services_document import services_document
from airhilt.assistant.vision.detector import Shot
from airhilt.assistant.vision.detectors.http import HttpDetector
from airhilt.audio.wav import encode_wav
from airhilt.host.forms import decoded_form
from airhilt.voices.engines.http import HttpTts
from services import answering, service

SECOND = np.zeros(16_000, np.float32)
CALL = Call("c-1", 118_300, 0, "TOWER", ("AAL123",))
SHOT = Shot("nose", 0, own_aircraft=np.ones((48, 64), dtype=bool))
PICTURE = np.zeros((48, 64, 3), np.uint8)
ANSWERS = {
    "application/json": b'{"text": "", "detections": [], "advisories": []}',
    "audio/wav": encode_wav(SECOND),
}


def ask(kind: str, url: str) -> None:
    match kind:
        case "asr":
            HttpAsr(url).recognise_call(SECOND, CALL)
        case "tts":
            HttpTts(url).probe()
        case "detector":
            HttpDetector(url).detect_shot(PICTURE, SHOT)
        case "assistant":
            AssistantService(url).introduction()


def test_every_reference_leads_somewhere() -> None:
    document = services_document()
    names = set(re.findall(r'"#/components/schemas/([^"]+)"', json.dumps(document)))
    assert names
    assert names <= set(document["components"]["schemas"])


@pytest.mark.parametrize("path", services_document()["paths"])
def test_what_is_sent_is_what_the_document_says(path: str) -> None:
    operation = services_document()["paths"][path]["post"]
    (kind,) = re.findall(r"--(\w+)", operation["summary"])
    ((content_type, body_schema),) = operation["requestBody"]["content"].items()
    (answer_type,) = operation["responses"]["200"]["content"]
    sent: list[tuple[Any, bytes]] = []

    def answer(handler: BaseHTTPRequestHandler, body: bytes) -> None:
        sent.append((handler.headers, body))
        data = ANSWERS[answer_type]
        if kind == "assistant":
            data = b'{"advisories": []}'
        answering(data)(handler, body)

    with service(answer) as url:
        ask(kind, url.removesuffix("/service") + path)
    ((headers, body),) = sent
    assert headers["Content-Type"].partition(";")[0] == content_type
    told = {each for each in headers if each.startswith("X-")}
    known = {each["name"] for each in operation["parameters"]}
    assert told == (known - {"X-Callsigns"} if kind == "assistant" else known)
    if "$ref" in body_schema["schema"]:
        name = body_schema["schema"]["$ref"].rpartition("/")[2]
        fields = services_document()["components"]["schemas"][name]["properties"]
        is_json = content_type == "application/json"
        given = json.loads(body) if is_json else decoded_form(body, headers["Content-Type"])
        assert set(given) == set(fields)
