"""A scripted OpenAI-compatible endpoint: it answers as a test wants."""

from __future__ import annotations

import json
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler
from typing import Any

from airhilt.assistant.language_model import LanguageModelSettings
from services import Answer, answering

Json = dict[str, Any]


def saying(reply: Callable[[Json], Any], asked: list[Json] | None = None) -> Answer:
    """Return an answer whose content is made of the question, the JSON of the user's message.

    Parameters
    ----------
    asked
        Collects the whole requests.
    """

    def answer(handler: BaseHTTPRequestHandler, body: bytes) -> None:
        request = json.loads(body)
        if asked is not None:
            asked.append({**request, "path": handler.path, "headers": dict(handler.headers)})
        content = reply(json.loads(request["messages"][-1]["content"]))
        text = content if isinstance(content, str) else json.dumps(content)
        answering(json.dumps(completion(text)).encode())(handler, body)

    return answer


def completion(content: str | None, finish_reason: str = "stop", **more: Any) -> Json:
    """Return a chat completion."""
    message = {"role": "assistant", "content": content, **more}
    return {
        "id": "chatcmpl-1",
        "object": "chat.completion",
        "created": 0,
        "model": "scripted",
        "choices": [{"index": 0, "message": message, "finish_reason": finish_reason}],
    }


def settings(url: str, deadline_s: float = 5.0) -> LanguageModelSettings:
    """Return the settings for an endpoint."""
    return LanguageModelSettings(url, "scripted", deadline_s, seed=7)
