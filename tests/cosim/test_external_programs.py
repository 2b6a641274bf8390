"""A program that takes no grants is heard; what does not count is refused with a notice."""

from __future__ import annotations

import json
from types import SimpleNamespace
from typing import Any, cast

import pytest

from airhilt.bus.access import PUBLISHED
from airhilt.cosim.external_programs import HEARD, LIMITS, MOST_NOTICES, ExternalPrograms
from airhilt.errors import WorkerError
from airhilt.host.text import MOST_CHARACTERS
from airhilt.options import Options
from airhilt.seats import Seats
from airhilt.sim import Director, Virtual
from notices import Notices
from seats import state_of


def programs(
    notices: Notices, events: list[Any], *, is_strict: bool = False, seats: tuple[str, ...] = ()
) -> ExternalPrograms:
    director = Director(Virtual())
    context = SimpleNamespace(
        setup=SimpleNamespace(options=Options(strict=is_strict)),
        director=director,
        observer=notices,
        event=lambda *event: events.append(event),
    )
    participants = SimpleNamespace(
        programs=(),
        workers=[SimpleNamespace(description=SimpleNamespace(name="decision"))],
        does=lambda _modality: False,
    )
    held = Seats(map(state_of, seats), lambda _key, _state: None, director)
    return ExternalPrograms(cast(Any, context), held, cast(Any, participants))


def test_a_voice_without_a_grant_is_refused_and_noticed_once() -> None:
    notices, events = Notices(), list[Any]()
    heard = programs(notices, events)
    heard.take("tts/a-1", b"\0\0")
    heard.take("tts/a-2", b"\0\0")
    (text,) = notices.texts
    assert text.startswith("a program published on 'tts/*' without a grant; expected a voice that")
    assert [event[:2] for event in events] == [
        ("unregistered", "tts/a-1"), ("refused", "tts/a-1"), ("refused", "tts/a-2"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("key", "words"),
    [
        (
            "advisory/ATC",
            "a program published on 'advisory/ATC' something that is no Advisory: id, revision, "
            "recipient, recipients, kind, severity, traffic, message, evidence, t_ready_ns: Field "
            "required; see `airhilt schema --message Advisory`",
        ),
        ("command/AAL123", "a program published on 'command/AAL123' something that is no ActorCom"),
    ],
)
def test_a_refused_message_is_said_to_be_of_a_program(key: str, words: str) -> None:
    notices = Notices()
    programs(notices, []).take(key, b"{}")
    assert notices.texts[0].startswith(words)
    with pytest.raises(WorkerError, match=words):
        programs(notices, [], is_strict=True).take(key, b"{}")


def test_the_terminal_tells_of_few_refusals_and_the_log_of_all() -> None:
    notices, events = Notices(), list[Any]()
    heard = programs(notices, events)
    for number in range(100):
        heard.take("advisory/ATC", json.dumps({f"\x1b[{number}m": "x" * 1000}).encode())
        heard.take_refused("worker/own/step", f"{number}" + "\u202e" * 10_000)
    assert len(notices.texts) == MOST_NOTICES + 1
    assert notices.texts[-1].startswith("more was refused: the log has it all")
    assert len([event for event in events if event[0] == "refused"]) == 200
    for text in (*notices.texts, *(event[2] for event in events)):
        assert text.isprintable()
        assert len(text) <= MOST_CHARACTERS


@pytest.mark.parametrize("seats", [(), ("tower",)])
def test_what_a_page_has_refused_is_logged_and_changes_nothing_else(seats: tuple[str, ...]) -> None:
    notices, events = Notices(), list[Any]()
    heard = programs(notices, events, seats=seats)
    heard.take("page", b'{"text": "refused a page of another version\\u001b[0m"}')
    assert events == [("refused", "page", "refused a page of another version\ufffd[0m")]
    assert not heard.heard
    assert notices.texts == []


def test_every_key_that_is_heard_has_a_limit() -> None:
    assert set(LIMITS) == set(HEARD) == {key for keys in PUBLISHED.values() for key in keys}


def test_an_advisory_in_the_name_of_a_worker_is_refused() -> None:
    told = {
        "id": "decision-1", "revision": 9, "recipient": "ATC", "recipients": ["ATC"],
        "kind": "loss_of_separation", "severity": "WARNING", "traffic": [], "message": "",
        "evidence": {"sources": []}, "t_ready_ns": 0,
    }  # fmt: skip
    notices = Notices()
    programs(notices, []).take("advisory/ATC", json.dumps(told).encode())
    assert "the id 'decision-1'; expected an id of its own" in notices.texts[0]
