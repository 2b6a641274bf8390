"""Runs with a language model: recorded whole, replayed without it, and without its key."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import airhilt
from airhilt import Scenario
from airhilt.assistant.language_model import KEY_VARIABLE
from airhilt.cosim.observer import Observer
from airhilt.cosim.replay import replay
from airhilt.errors import AirhiltError
from airhilt.messages import Advisory, ModelExchange
from airhilt.metrics.summary import LanguageModelStatistics
from airhilt.record import read_log
from language_models import Json, saying
from notices import Notices
from services import service

OPTIONS: dict[str, Any] = {"latency": "fixed", "speech": False, "cameras": False}
KEY = "sk-do-not-record"


def reword_for_dal456(question: Json) -> Json:
    """Reword what DAL456 is told, and forget the callsign of everybody else."""
    return {
        key: {
            **each,
            "text": f"{each['text']} immediately"
            if each["text"].startswith("DAL456")
            else "all clear",
        }
        for key, each in question.items()
    }


def test_a_run_with_a_language_model_replays_identically_without_it(
    encounter: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(KEY_VARIABLE, KEY)
    notices = Notices()
    with service(saying(reword_for_dal456)) as url:
        result = airhilt.run(
            encounter, out=tmp_path / "run", observer=notices, wording="llm", llm=url, **OPTIONS
        )
    monkeypatch.delenv(KEY_VARIABLE)
    assert replay(result.folder).identical

    log = list(read_log(result.folder / "log.mcap"))
    exchanges = [
        ModelExchange.model_validate_json(one.data) for one in log if one.key[:4] == "llm/"
    ]
    advisories = [
        Advisory.model_validate_json(one.data) for one in log if one.key.startswith("advisory/")
    ]
    refused = [each for one in exchanges for each in one.rejections]
    assert refused
    assert not any(each.subject.endswith(" DAL456") for each in refused)
    assert any("immediately" in one.message for one in advisories if one.recipient == "DAL456")
    assert "all clear" not in {one.message for one in advisories}
    assert set(exchanges[0].advisories) <= {one.id for one in advisories}

    assert result.summary.language_model == LanguageModelStatistics(
        model="gpt-oss:20b", questions=len(exchanges), failures=0, rejections=len(refused)
    )
    assert len([text for text in notices.texts if "all clear' is refused" in text]) == 1
    for path in result.folder.rglob("*"):
        assert path.is_dir() or KEY.encode() not in path.read_bytes(), path


def test_a_run_that_a_language_model_decides_replays_identically_without_it(
    encounter: Scenario, tmp_path: Path
) -> None:
    def withhold(question: Json) -> Json:
        judgements = [{"alert": each["id"], "severity": "INFO"} for each in question["rules"]]
        return {"judgements": judgements, "advisories": []}

    with service(saying(withhold)) as url:
        result = airhilt.run(encounter, out=tmp_path / "run", assistant="llm", llm=url, **OPTIONS)
    summary = result.summary
    assert summary.assistant == "llm"
    assert summary.advisories
    assert summary.language_model is not None
    assert summary.language_model.rejections > 0
    assert replay(result.folder).identical


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"wording": "llm"}, "expected --llm URL"),
        ({"llm": "http://127.0.0.1:1/v1"}, "nobody asks the language model"),
        ({"llm_model": "x"}, "would do nothing without --llm"),
        ({"llm": "http://127.0.0.1:1/v1", "assistant": "none"}, "would do nothing with"),
        ({"llm": "elsewhere", "wording": "llm"}, "is no address"),
    ],
)
def test_options_that_do_not_fit_together_are_named(
    encounter: Scenario, tmp_path: Path, options: dict[str, Any], words: str
) -> None:
    with pytest.raises(AirhiltError, match=words):
        airhilt.run(encounter, out=tmp_path / "run", **OPTIONS, **options)
    assert not (tmp_path / "run").exists()


class Stops(Observer):
    """Stops a run when it tells its user something."""

    def notice(self, text: str) -> None:
        """Stop the run."""
        raise AirhiltError(text)


@pytest.mark.parametrize(
    ("options", "what"),
    [
        ({"wording": "llm"}, "advisories"),
        ({"assistant": "llm"}, "radio calls, tracks and advisories"),
    ],
)
def test_a_run_says_what_it_sends_to_another_machine(
    encounter: Scenario, tmp_path: Path, options: dict[str, Any], what: str
) -> None:
    url = "http://192.0.2.1/v1"
    with pytest.raises(AirhiltError, match=f"^this run sends {what} to another machine: {url}$"):
        airhilt.run(
            encounter, out=tmp_path / "run", observer=Stops(), llm=url, **OPTIONS, **options
        )


def test_an_address_with_a_password_is_shown_nowhere(encounter: Scenario, tmp_path: Path) -> None:
    notices = Notices()
    with pytest.raises(AirhiltError, match="contains a user") as raised:
        airhilt.run(
            encounter, out=tmp_path / "run", observer=notices,
            assistant="http://me:secret@192.0.2.1/advise", **OPTIONS,
        )  # fmt: skip
    assert "secret" not in f"{raised.value} {notices.texts}"
    assert not (tmp_path / "run").exists()
