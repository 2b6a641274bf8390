"""A language model behind an OpenAI-compatible endpoint: one question, one answer in JSON.

The client library ``openai`` would add retries, which break the deadline, and addresses from the
environment.
"""

from __future__ import annotations

import json
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, Protocol, TypeVar, runtime_checkable

from pydantic import BaseModel, Field, ValidationError

from airhilt.errors import AirhiltError, LanguageModelError, first_problem
from airhilt.host.services import MOST_FAILURES, HttpService, key_of, without_key, without_user
from airhilt.messages import ModelExchange

Answer = TypeVar("Answer", bound=BaseModel)
KEY_VARIABLE = "AIRHILT_LLM_KEY"
"""Environment variable with the key of the endpoint; it is sent, and written nowhere."""
MAXIMUM_BYTES = 1_000_000
"""Size of the largest answer."""
MOST_TOKENS = 1_024
"""Length of the longest answer, in tokens, with what a model thinks before it answers."""
Dialect = Literal["json_schema", "json_object"]
"""Ways to ask for JSON of a schema: OpenAI's, and that of llama-cpp-python."""
_PATH = "/chat/completions"


@dataclass(frozen=True)
class LanguageModelSettings:
    """Language model of a run."""

    url: str
    """Base of the endpoint, such as ``http://127.0.0.1:11434/v1``."""
    model: str
    """Name that the endpoint has for the model."""
    deadline_s: float
    """Wall time after which an answer is not waited for any more."""
    seed: int = 0
    """Seed of sampling, which is sent with temperature 0."""


@runtime_checkable
class UsesLanguageModel(Protocol):
    """Part that an engine or a wording has which asks the language model of the run."""

    @property
    def name(self) -> str:
        """Short name, such as ``llm``."""

    def use(self, settings: LanguageModelSettings) -> None:
        """Ask this language model."""


class _Message(BaseModel):
    content: str | None = None
    refusal: str | None = None


class _Choice(BaseModel):
    message: _Message
    finish_reason: str | None = None


class _Completion(BaseModel):
    choices: tuple[_Choice, ...] = Field(min_length=1)


class LanguageModel:
    """Asks one language model, and stops asking one that does not answer.

    Raises
    ------
    LanguageModelError
        The address is none, or contains a password or a query, or the key can be none.
    """

    def __init__(self, settings: LanguageModelSettings) -> None:
        self.name = settings.model
        self._settings = settings
        self._url = endpoint(settings.url)
        self._key = key_of(KEY_VARIABLE, "language model", LanguageModelError)
        self._dialect: Dialect = "json_schema"
        self._failures = 0
        self._service(settings.deadline_s)

    def ask(self, instructions: str, question: str, schema: Mapping[str, Any]) -> str:
        """Return the answer: a text that should be JSON of a schema.

        The caller checks that, and calls `accept` if it is, as `answer_to` does.

        Raises
        ------
        LanguageModelError
            There is no answer in time, it is a refusal, or it was cut off.
        """
        if self._failures >= MOST_FAILURES:
            raise LanguageModelError(
                f"language model {self.name!r} is not asked any more: {MOST_FAILURES} questions "
                "in a row had no usable answer"
            )
        begun = time.monotonic()
        request = {
            "model": self._settings.model,
            "messages": [
                {"role": "system", "content": instructions},
                {"role": "user", "content": question},
            ],
            "temperature": 0,
            "seed": self._settings.seed,
            "max_tokens": MOST_TOKENS,
        }
        self._failures += 1
        try:
            data = self._post(request | _format(schema, self._dialect), self._settings.deadline_s)
        except LanguageModelError as error:
            left_s = self._settings.deadline_s - (time.monotonic() - begun)
            refuses_format = "HTTP status" in str(error) and "response_format" in str(error)
            if self._dialect != "json_schema" or not refuses_format or left_s <= 0.0:
                raise
            data = self._post(request | _format(schema, "json_object"), left_s)
            self._dialect = "json_object"
        return self._content(data)

    def answer_to(
        self,
        exchange: ModelExchange,
        instructions: str,
        schema: Mapping[str, Any],
        model: type[Answer],
    ) -> tuple[Answer | None, ModelExchange]:
        """Return the answer to the question of an exchange, and the exchange with what came of it.

        Without a usable answer in time, it is None, and the exchange has the failure.
        """
        try:
            text = self.ask(instructions, exchange.question, schema)
        except LanguageModelError as error:
            return None, exchange.model_copy(update={"failure": str(error)})
        exchange = exchange.model_copy(update={"answer": text})
        try:
            answer = model.model_validate_json(text)
        except ValidationError as error:
            failure = f"the answer is not of the schema: {first_problem(error)}"
            return None, exchange.model_copy(update={"failure": failure})
        self.accept()
        return answer, exchange

    def accept(self) -> None:
        """Record that the last answer is of its schema: the model goes on being asked."""
        self._failures = 0

    def _post(self, request: Mapping[str, Any], timeout_s: float) -> bytes:
        body = json.dumps(request).encode()
        return self._service(timeout_s).post(body, "application/json")

    def _service(self, timeout_s: float) -> HttpService:
        return HttpService(
            "language model", self._url, timeout_s, MAXIMUM_BYTES, LanguageModelError, self._key
        )

    def _content(self, data: bytes) -> str:
        try:
            choice = _Completion.model_validate_json(data).choices[0]
        except ValidationError as error:
            text = without_key(data.decode("utf-8", "replace"), self._key)
            raise self._error(
                f"answered {text[:60]!r}: {first_problem(error)}", "a chat completion"
            ) from None
        if choice.message.refusal or not choice.message.content:
            why = without_key(choice.message.refusal or "an empty answer", self._key)[:200]
            raise self._error(f"refused: {why!r}", "an answer")
        if choice.finish_reason == "length":
            raise self._error(f"answered more than {MOST_TOKENS} tokens", "no more than that")
        return without_key(choice.message.content, self._key)

    def _error(self, what: str, expected: str) -> AirhiltError:
        return self._service(self._settings.deadline_s).error(what, expected)


def _format(schema: Mapping[str, Any], dialect: Dialect) -> dict[str, Any]:
    if dialect == "json_object":
        return {"response_format": {"type": "json_object", "schema": schema}}
    described = {"name": "answer", "strict": True, "schema": schema}
    return {"response_format": {"type": "json_schema", "json_schema": described}}


def endpoint(url: str) -> str:
    """Return the address of chat completions below a base.

    Raises
    ------
    LanguageModelError
        It contains a user, a password or a query, which ``run.json`` would keep.
    """
    if any(each in url for each in "@?#"):
        raise LanguageModelError(
            f"language model: the address at {without_user(url)} contains a user, a password, a "
            f"query or a fragment; expected none, and the key in the environment as {KEY_VARIABLE}"
        )
    base = url.rstrip("/")
    return base if base.endswith(_PATH) else base + _PATH
