"""What a language model is asked, how often, and which answers count, without an endpoint."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from typing import Any

import pytest

from airhilt.assistant import language_model
from airhilt.assistant.language_model import LanguageModel, LanguageModelSettings, endpoint
from airhilt.errors import AirhiltError, LanguageModelError
from language_models import completion

Reply = bytes | LanguageModelError
SCHEMA = {"type": "object", "required": ["m1"]}
OTHER_FORMAT = LanguageModelError("HTTP status 422: response_format: expected 'json_object'")


def said(content: str | None, finish_reason: str = "stop", **more: Any) -> bytes:
    return json.dumps(completion(content, finish_reason, **more)).encode()


class Scripted:
    """Stands for the service at every address: it answers in turn, the last one for ever."""

    def __init__(self, *replies: Reply) -> None:
        self.replies = list(replies)
        self.asked: list[dict[str, Any]] = []
        self.deadlines_s: list[float] = []
        self.urls: set[str] = set()
        self.clock_s = 0.0
        self.takes_s = 0.0

    def __call__(
        self, subject: str, url: str, timeout_s: float, maximum_bytes: int, failure: Any, key: str
    ) -> Scripted:
        assert (subject, maximum_bytes, failure, key) == (
            "language model",
            1_000_000,
            LanguageModelError,
            "",
        )
        self.urls.add(url)
        self.timeout_s = timeout_s
        return self

    def post(self, body: bytes, content_type: str) -> bytes:
        assert content_type == "application/json"
        self.asked.append(json.loads(body))
        self.deadlines_s.append(self.timeout_s)
        self.clock_s += self.takes_s
        reply = self.replies.pop(0) if len(self.replies) > 1 else self.replies[0]
        if isinstance(reply, LanguageModelError):
            raise reply
        return reply

    def error(self, what: str, expected: str) -> AirhiltError:
        return LanguageModelError(f"{what}; expected {expected}")


Model = Callable[..., tuple[LanguageModel, Scripted]]


@pytest.fixture
def model(monkeypatch: pytest.MonkeyPatch) -> Model:
    monkeypatch.delenv(language_model.KEY_VARIABLE, raising=False)

    def of(*replies: Reply) -> tuple[LanguageModel, Scripted]:
        scripted = Scripted(*replies)
        monkeypatch.setattr(language_model, "HttpService", scripted)
        monkeypatch.setattr(time, "monotonic", lambda: scripted.clock_s)
        settings = LanguageModelSettings("http://localhost/v1", "small", deadline_s=5.0, seed=7)
        return LanguageModel(settings), scripted

    return of


def ask(asks: LanguageModel) -> str:
    return asks.ask("Be brief.", "Why?", SCHEMA)


def test_a_question_has_its_instructions_the_model_the_seed_and_no_temperature(
    model: Model,
) -> None:
    asks, scripted = model(said("{}"))
    assert ask(asks) == "{}"
    assert scripted.urls == {"http://localhost/v1/chat/completions"}
    assert scripted.deadlines_s == [5.0]
    assert scripted.asked == [
        {
            "model": "small",
            "messages": [
                {"role": "system", "content": "Be brief."},
                {"role": "user", "content": "Why?"},
            ],
            "temperature": 0,
            "seed": 7,
            "max_tokens": 1024,
            "response_format": {
                "type": "json_schema",
                "json_schema": {"name": "answer", "strict": True, "schema": SCHEMA},
            },
        }
    ]


def test_who_refuses_the_format_is_asked_in_the_other_one_with_the_time_that_is_left(
    model: Model,
) -> None:
    asks, scripted = model(OTHER_FORMAT, said("{}"))
    scripted.takes_s = 2.0
    assert ask(asks) == ask(asks) == "{}"
    formats = [each["response_format"] for each in scripted.asked]
    assert [each["type"] for each in formats] == ["json_schema", "json_object", "json_object"]
    assert formats[1]["schema"] == SCHEMA
    assert scripted.deadlines_s == [5.0, 3.0, 5.0]


@pytest.mark.parametrize(
    "refusal",
    [
        LanguageModelError("HTTP status 500: out of memory"),
        LanguageModelError("no answer in time; response_format"),
    ],
)
def test_who_fails_otherwise_is_not_asked_again(model: Model, refusal: LanguageModelError) -> None:
    asks, scripted = model(refusal, said("{}"))
    with pytest.raises(LanguageModelError, match=str(refusal)):
        ask(asks)
    assert len(scripted.asked) == 1
    assert ask(asks) == "{}"
    assert scripted.asked[1]["response_format"]["type"] == "json_schema"


def test_when_the_time_is_over_nothing_more_is_asked(model: Model) -> None:
    asks, scripted = model(OTHER_FORMAT, said("{}"))
    scripted.takes_s = 5.0
    with pytest.raises(LanguageModelError):
        ask(asks)
    assert len(scripted.asked) == 1


def test_after_three_answers_in_a_row_that_were_not_accepted_it_is_not_asked(model: Model) -> None:
    asks, scripted = model(said("{}"))
    for _ in range(2):
        ask(asks)
    asks.accept()
    for _ in range(3):
        ask(asks)
    with pytest.raises(LanguageModelError, match="is not asked any more: 3 questions in a row"):
        ask(asks)
    assert len(scripted.asked) == 5


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        (said(None), "refused: 'an empty answer'"),
        (said(""), "refused: 'an empty answer'"),
        (said("{}", refusal="I will not."), "refused: 'I will not.'"),
        (said("{", "length"), "answered more than 1024 tokens"),
        (b'{"choices": []}', "answered"),
        (b"nothing of the kind", "answered"),
    ],
)
def test_what_is_no_answer_is_told_as_such(model: Model, answer: bytes, why: str) -> None:
    asks, _ = model(answer)
    with pytest.raises(LanguageModelError, match=why):
        ask(asks)


@pytest.mark.parametrize(
    "url",
    ["http://host/v1", "http://host/v1/", "http://host/v1/chat/completions"],
)
def test_the_address_is_that_of_completions_below_a_base(url: str) -> None:
    assert endpoint(url) == "http://host/v1/chat/completions"


@pytest.mark.parametrize("url", ["http://me@host/v1", "http://host/v1?key=1", "http://host/v1#a"])
def test_an_address_with_more_than_a_place_is_refused(url: str) -> None:
    with pytest.raises(LanguageModelError, match="expected none"):
        endpoint(url)
