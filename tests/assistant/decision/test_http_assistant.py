"""An assistant behind an address: what it is asked, and what is made of its answers."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from http.server import BaseHTTPRequestHandler
from typing import Any

import pytest

from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.engines.http import AssistantService, HttpAssistant
from airhilt.assistant.decision.service_messages import AssistantRequest
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template
from airhilt.errors import WorkerError
from airhilt.messages import (
    AdsbReport,
    Advisory,
    Briefing,
    Climb,
    RosterEntry,
    Severity,
    Transcript,
)
from airhilt.units import SECOND_NS
from airhilt.workers.samples import sample_inputs
from services import answering, breaking_off, nobody, redirecting, service

Json = dict[str, Any]
ADVISORY: Json = {
    "id": "pair-1",
    "kind": "loss_of_separation",
    "severity": "CAUTION",
    "recipients": ["AAL123", "ATC"],
    "traffic": ["AAL123", "DAL456"],
    "messages": {"AAL123": "AAL123 traffic ahead, climb"},
    "recommendations": {
        "AAL123": {
            "action": "altitude", "sense": "climb", "altitude_ft": 5000, "vertical_rate_fpm": 1500
        }
    },
    "evidence": {"sources": ["adsb"], "tracks": ["a00001"], "rules": ["mine"], "note": "near"},
}  # fmt: skip


class Scripted:
    """Answers each request with the next list of advisories, and keeps the requests."""

    def __init__(self, *answers: list[Json]) -> None:
        self.requests: list[Json] = []
        self._answers: Iterator[list[Json]] = iter(answers)

    def __call__(self, handler: BaseHTTPRequestHandler, body: bytes) -> None:
        self.requests.append(json.loads(body))
        data = json.dumps({"advisories": next(self._answers, [])}).encode()
        answering(data)(handler, body)


def transcript(
    text: str, name: str = "c-1", t_s: float = 1.0, confidence: float = 0.9
) -> Transcript:
    begin_ns = int(t_s * SECOND_NS)
    return Transcript(
        id=name, frequency_khz=118_300, t_tx_ns=begin_ns, t_end_ns=begin_ns + SECOND_NS, text=text,
        confidence=confidence, engine="test",
    )  # fmt: skip


def tell(engine: HttpAssistant, message: Any, t_s: float) -> Decision:
    t_ns = int(t_s * SECOND_NS)
    engine.receive(ReceivedMessage(message, t_ns, t_ns))
    return engine.decide(t_ns)


def worker_of(url: str) -> DecisionWorker:
    return DecisionWorker(HttpAssistant(AssistantService(url)), Template())


def advisories_of(worker: DecisionWorker, t_s: int) -> list[Advisory]:
    inputs = [item for item in sample_inputs(t_s * SECOND_NS) if is_read(worker, item.key)]
    outputs = worker.step(t_s * SECOND_NS, inputs).outputs
    return [Advisory.model_validate_json(output.payload) for output in outputs]


def is_read(worker: DecisionWorker, key: str) -> bool:
    return any(
        re.fullmatch(each.key.replace("*", "[^/]+"), key) for each in worker.description.inputs
    )


def test_the_answer_becomes_an_advisory_to_each_recipient() -> None:
    with service(Scripted([ADVISORY])) as url:
        crew, controller = advisories_of(worker_of(url), 2)
    assert (crew.recipient, crew.id, crew.revision) == ("AAL123", "decision-pair-1", 0)
    assert crew.message == "AAL123 traffic ahead, climb"
    assert crew.recommendation == Climb(sense="climb", altitude_ft=5000, vertical_rate_fpm=1500)
    assert crew.evidence.rules == ("mine",)
    assert controller.message == "AAL123, near; AAL123 climb to 5000 ft"
    assert controller.recommendation is None


def test_a_request_has_the_slices_of_all_modalities() -> None:
    answers = Scripted()
    with service(answers) as url:
        advisories_of(worker_of(url), 2)
    (request,) = answers.requests
    AssistantRequest.model_validate(request)
    assert request["ts_ms"] == 2000
    assert request["context"]["controller"] == "Washington Center"
    (turn,) = request["radio"]
    assert {"turn_id", "ts_ms", "speaker", "text", "frequency_khz", "addressed_callsign",
            "overheard", "confidence"} <= set(turn)  # fmt: skip
    assert [each["camera_id"] for each in request["cameras"]] == ["sample"]
    assert [each["callsign"] for each in request["tracks"]] == ["AAL123", "DAL456"]


def test_a_turn_says_whom_it_addresses_and_who_speaks() -> None:
    roster = tuple(RosterEntry(callsign=name, category="aircraft", type="B738")
                   for name in ("AAL123", "DAL456"))  # fmt: skip
    briefing = Briefing(
        controller="Tower", horizontal_separation_nm=3, vertical_separation_ft=1000, roster=roster
    )
    answers = Scripted()
    with service(answers) as url:
        engine = HttpAssistant(AssistantService(url))
        tell(engine, briefing, 1.0)
        tell(engine, transcript("American one two three, runway zero one, cleared to land"), 2.0)
        tell(
            engine, transcript("cleared to land runway zero one, American one two three", "c-2"), 3
        )
    given, read = answers.requests[-1]["radio"]
    assert (given["addressed_callsign"], given["speaker"]) == ("AAL123", None)
    assert (read["addressed_callsign"], read["speaker"]) == (None, "AAL123")


def test_it_is_asked_once_a_second_and_at_once_about_a_call() -> None:
    answers = Scripted()
    briefing = Briefing(controller="T", horizontal_separation_nm=3, vertical_separation_ft=1000)
    with service(answers) as url:
        engine = HttpAssistant(AssistantService(url))
        tell(engine, briefing, 1.0)
        assert tell(engine, briefing, 1.25).again_ns == 2 * SECOND_NS
        assert len(answers.requests) == 1
        tell(engine, transcript("hello"), 1.5)
        assert [each["ts_ms"] for each in answers.requests] == [1000, 1500]
        assert engine.decide(5 * SECOND_NS) == Decision()


def test_what_is_not_listed_any_more_is_over() -> None:
    with service(Scripted([ADVISORY], [ADVISORY], [])) as url:
        worker = worker_of(url)
        assert len(advisories_of(worker, 2)) == 2
        assert advisories_of(worker, 4) == []
        over = advisories_of(worker, 6)
    assert [(each.active, each.severity, each.message) for each in over] == [
        (False, Severity.INFO, "clear of conflict")
    ] * 2


def test_the_same_call_twice_and_old_calls_are_no_more_than_one() -> None:
    answers = Scripted()
    with service(answers) as url:
        engine = HttpAssistant(AssistantService(url))
        tell(engine, transcript("first", "c-2", 5.0), 6.0)
        tell(engine, transcript("earlier", "c-1", 1.0), 7.0)
        tell(engine, transcript("second", "c-2", 5.0), 8.0)
        tell(engine, transcript("late", "c-3", 200.0), 201.0)
    assert [each["text"] for each in answers.requests[2]["radio"]] == ["earlier", "first"]
    assert [each["text"] for each in answers.requests[3]["radio"]] == ["late"]


def adsb(t_s: float, latitude_deg: float) -> AdsbReport:
    t_ns = int(t_s * SECOND_NS)
    return AdsbReport(
        icao24="a00001", callsign="AAL123", latitude_deg=latitude_deg, longitude_deg=-77.0,
        altitude_ft=20_000.0, ground_speed_kt=480.0, track_deg=0.0, vertical_rate_fpm=0.0, nacp=9,
        nacv=2, receiver="r", t_adsb_in_ns=t_ns, t_adsb_out_ns=t_ns,
    )  # fmt: skip


def test_what_cannot_be_right_is_left_out_and_the_advisory_says_so() -> None:
    answers = Scripted([], [ADVISORY])
    with service(answers) as url:
        engine = HttpAssistant(AssistantService(url))
        tell(engine, adsb(1.0, 40.0), 1.0)
        decision = tell(engine, adsb(3.0, 41.0), 3.0)
    (track,) = answers.requests[1]["tracks"]
    assert track["latitude_deg"] == 40.0
    (wrong,) = decision.alerts[0].evidence.inconsistencies
    assert "ADS-B of AAL123" in wrong


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"recipients": []}, "advisories/0/recipients"),
        ({"recipients": ["A/*"]}, "advisories/0/recipients/0"),
        ({"recommendations": {"DAL456": {"action": "go_around", "runway": "01"}}},
         "recommendations for DAL456; expected recipients only"),
        ({"recomendations": {}}, "recomendations"),
        ({"messages": {"AAL123": "climb\x1b[2J"}}, "advisories/0/messages/AAL123"),
        ({"traffic": ["AAL123", "x" * 1000]}, "advisories/0/traffic/1"),
    ],
)  # fmt: skip
def test_an_answer_that_is_not_of_the_schema_is_refused_by_name(changes: Json, words: str) -> None:
    with (
        service(Scripted([ADVISORY | changes])) as url,
        pytest.raises(WorkerError, match=re.escape(words)),
    ):
        advisories_of(worker_of(url), 2)


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (answering(b"no JSON"), "expected an AssistantAnswer"),
        (answering(b"busy", 503), "HTTP status 503"),
        (breaking_off, "broke off"),
        (redirecting("http://127.0.0.1:1/"), "HTTP status 303"),
    ],
)
def test_a_service_that_fails_is_named(answer: Callable[..., None], words: str) -> None:
    with service(answer) as url, pytest.raises(WorkerError, match=words):
        advisories_of(worker_of(url), 2)
    with pytest.raises(WorkerError, match="is not there"):
        advisories_of(worker_of(nobody()), 2)


def test_an_address_with_a_password_is_refused_without_showing_it() -> None:
    with pytest.raises(WorkerError, match=r"http://127\.0\.0\.1:9000 contains a user") as raised:
        AssistantService("http://me:secret@127.0.0.1:9000/advise")
    assert "secret" not in str(raised.value)
