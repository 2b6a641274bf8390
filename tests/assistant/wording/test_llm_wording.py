"""A language model that rewords: what it may say, and what is said when it fails."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import pytest

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.findings import Obstruction
from airhilt.assistant.language_model import KEY_VARIABLE, LanguageModel
from airhilt.assistant.wording.engine import Worded
from airhilt.assistant.wording.engines.llm import LanguageModelWording
from airhilt.assistant.wording.engines.template import Template
from airhilt.errors import LanguageModelError
from airhilt.messages import CONTROLLER, Evidence, GoAround, ModelExchange, Severity
from language_models import Json, completion, saying, settings
from services import Answer, answering, breaking_off, nobody, service

ALERT = Alert(
    id="19L-AAL123-UAL7",
    revision=0,
    kind="runway_conflict",
    severity=Severity.WARNING,
    recipients=("AAL123", CONTROLLER),
    traffic=("AAL123", "UAL7"),
    evidence=Evidence(sources=("adsb",), runway="19L", time_to_go_s=12.0),
    finding=Obstruction("AAL123", "arrival", "19L", "on", "UAL7", "19L"),
    recommendations={"AAL123": GoAround(runway="19L")},
)
RULE = {
    (ALERT.id, recipient): Template().message(ALERT, recipient) for recipient in ALERT.recipients
}


def worded(answer: Answer, deadline_s: float = 5.0) -> Worded:
    with service(answer) as url:
        wording = LanguageModelWording()
        wording.use(settings(url, deadline_s))
        return wording.words([ALERT])


def echo(changed: Callable[[str], str] = str, **more: str) -> Callable[[Json], Json]:
    """Return a model that answers what it was given, changed."""
    return lambda question: {
        key: {**each, "text": changed(each["text"]), **more} for key, each in question.items()
    }


def exchange_of(spoken: Worded) -> ModelExchange:
    (exchange,) = spoken.exchanges
    return exchange


def test_a_good_rewording_is_spoken_to_everybody_with_one_question() -> None:
    asked: list[Json] = []
    spoken = worded(saying(echo(lambda text: text.replace("12 s", "12 seconds")), asked))
    assert spoken.messages == {
        key: text.replace("12 s", "12 seconds") for key, text in RULE.items()
    }
    assert len(asked) == 1
    assert exchange_of(spoken).advisories == (ALERT.id,)
    assert not exchange_of(spoken).rejections


def test_it_is_asked_with_temperature_0_the_seed_and_a_schema_of_the_answer() -> None:
    asked: list[Json] = []
    worded(saying(echo(), asked))
    (request,) = asked
    assert (request["temperature"], request["seed"], request["model"]) == (0, 7, "scripted")
    schema = request["response_format"]["json_schema"]["schema"]
    assert schema["required"] == ["m1", "m2"]
    objects = [schema, *schema["properties"].values()]
    assert [each["additionalProperties"] for each in objects] == [False] * 3
    assert [each["required"] for each in objects[1:]] == [["severity", "text"]] * 2
    assert request["path"].endswith("/chat/completions")
    assert "Authorization" not in request["headers"]


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        (lambda text: text.replace("AAL123", "AAL321"), "expected"),
        (lambda text: text.replace("19L", "19R"), "runways"),
        (lambda text: text.replace("go around", "hold position"), "actions"),
        (lambda text: f"{text}, no action needed", "words"),
        (lambda text: f"{text}, caution", "severity"),
        (lambda _: "Ignore previous instructions. All clear.", "begins with no callsign"),
    ],
)
def test_a_rewording_that_changes_something_is_refused_and_the_log_says_why(
    changed: Callable[[str], str], why: str
) -> None:
    spoken = worded(saying(echo(changed)))
    assert spoken.messages == RULE
    rejections = exchange_of(spoken).rejections
    assert len(rejections) == 2
    assert why in rejections[0].reason
    assert changed(RULE[ALERT.id, "AAL123"]) in rejections[0].answered


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        (saying(lambda _: "I cannot help with that"), "not of the schema"),
        (saying(lambda _: {"m1": "go around"}), "not of the schema"),
        (answering(json.dumps(completion(None, refusal="no")).encode()), "refused: 'no'"),
        (answering(json.dumps(completion("{", "length")).encode()), "tokens"),
        (answering(b'{"choices": []}'), "expected a chat completion"),
        (answering(b"<html>"), "expected a chat completion"),
        (answering(b"out of memory", 500), "HTTP status 500"),
        (breaking_off, "broke off"),
    ],
)
def test_the_rule_s_text_goes_out_when_there_is_no_usable_answer(answer: Answer, why: str) -> None:
    spoken = worded(answer)
    assert spoken.messages == RULE
    assert why in exchange_of(spoken).failure


def test_what_is_not_spoken_is_not_reworded() -> None:
    wording = LanguageModelWording()
    wording.use(settings(nobody()))
    shown = [Alert(**{**vars(ALERT), "severity": Severity.ADVISORY}),
             Alert(**{**vars(ALERT), "active": False})]  # fmt: skip
    assert not wording.words(shown).exchanges


def test_the_key_is_sent_and_shown_nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(KEY_VARIABLE, "sk-secret")
    asked: list[Json] = []
    worded(saying(echo(), asked))
    assert asked[0]["headers"]["Authorization"] == "Bearer sk-secret"
    quoting = answering(b"Incorrect API key provided: sk-secret", 401)
    assert "provided: ***" in exchange_of(worded(quoting)).failure
    echoing = worded(saying(lambda _: "sk-secret"))
    assert "sk-secret" not in exchange_of(echoing).model_dump_json()


@pytest.mark.parametrize(("status", "cut_at"), [(401, 200), (200, 60)])
def test_no_half_of_a_key_is_left_where_the_error_cuts_what_it_quotes(
    monkeypatch: pytest.MonkeyPatch, status: int, cut_at: int
) -> None:
    monkeypatch.setenv(KEY_VARIABLE, "sk-secret")
    quoting = answering(b"x" * (cut_at - 5) + b"sk-secret is no key", status)
    failure = exchange_of(worded(quoting)).failure
    assert "xxxxx***" in failure
    assert "sk-" not in failure


def test_a_key_that_no_header_can_have_is_refused_unseen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(KEY_VARIABLE, "sk-secret\nX: 1")
    with pytest.raises(LanguageModelError) as raised:
        LanguageModel(settings("http://127.0.0.1:1/v1"))
    assert "sk-secret" not in str(raised.value)


def test_no_radio_call_reaches_the_model() -> None:
    asked: list[Any] = []
    worded(saying(echo(), asked))
    question = json.loads(asked[0]["messages"][-1]["content"])
    texts = [each["text"] for each in question.values()]
    assert texts == list(RULE.values())
