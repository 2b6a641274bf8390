"""Baseline engines and that of a language model, before which messages come one by one."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, cast

import pytest

from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.engines.llm import LanguageModelAssistant
from airhilt.assistant.decision.engines.well_clear import WellClearEngine
from airhilt.assistant.language_model import LanguageModel
from airhilt.errors import LanguageModelError
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.messages import AdsbReport, Message, Severity, Transcript, Turn
from airhilt.units import DEGREE, KNOT, SECOND_NS

FRAME = LocalFrame((38.9 * DEGREE, -77.0 * DEGREE))


def at(t_s: float) -> int:
    return round(t_s * SECOND_NS)


def give(engine: Any, t_s: float, *messages: Message) -> None:
    for message in messages:
        engine.receive(ReceivedMessage(message, at(t_s), at(t_s)))


def report(
    callsign: str, north_m: float, north_m_s: float, *, t_s: float = 0.0,
    altitude_ft: float | None = 20_000.0, rate_fpm: float = 0.0, east_m: float = 0.0,
) -> AdsbReport:  # fmt: skip
    latitude, longitude = FRAME.to_place(east_m, north_m)
    return AdsbReport.model_validate(
        {
            "icao24": callsign.encode().hex()[-6:], "callsign": callsign,
            "latitude_deg": latitude / DEGREE, "longitude_deg": longitude / DEGREE,
            "altitude_ft": altitude_ft, "ground_speed_kt": abs(north_m_s) / KNOT,
            "track_deg": 0.0 if north_m_s >= 0.0 else 180.0, "vertical_rate_fpm": rate_fpm,
            "nacp": 9, "nacv": 2, "receiver": "all", "t_adsb_in_ns": at(t_s), "t_adsb_out_ns": 0,
            "on_ground": altitude_ft is None,
        }
    )  # fmt: skip


# --- well clear -------------------------------------------------------------------------------


def meets(engine: WellClearEngine, t_s: float, meet_s: float, *, down_fpm: float = 0.0) -> Decision:
    """Give two that meet head-on with 200 m/s each; one may descend to the level of the other."""
    left_s = meet_s - t_s
    above_ft = down_fpm * left_s / 60.0
    give(
        engine, t_s, report("AAL123", -200.0 * left_s, 200.0, t_s=t_s),
        report(
            "DAL456", 200.0 * left_s, -200.0, t_s=t_s, altitude_ft=20_000.0 + above_ft,
            rate_fpm=-down_fpm,
        ),
    )  # fmt: skip
    return engine.decide(at(t_s))


@pytest.mark.parametrize("down_fpm", [0.0, 900.0, -900.0])
def test_both_crews_are_told_to_turn_alike_whoever_is_above(down_fpm: float) -> None:
    (alert,) = meets(WellClearEngine(), 0.0, 50.0, down_fpm=down_fpm).alerts
    assert alert.recommendations.keys() == {"AAL123", "DAL456"}
    first, second = alert.recommendations.values()
    assert first == second == Turn(degrees=20.0)
    assert alert.evidence.vertical_at_closest_approach_m == pytest.approx(0.0, abs=1.0)
    assert alert.evidence.time_to_closest_approach_s == pytest.approx(50.0, abs=0.5)


@pytest.mark.parametrize(("silent_s", "is_known"), [(15.0, True), (15.1, False)])
def test_a_track_without_an_alert_is_dropped_after_15_s(silent_s: float, is_known: bool) -> None:
    engine = WellClearEngine()
    assert meets(engine, 0.0, 200.0).alerts == []
    engine.decide(at(silent_s))
    assert len(list(engine._tracks)) == (2 if is_known else 0)


def test_a_pair_with_an_alert_is_judged_again_each_second_without_news() -> None:
    engine = WellClearEngine()
    assert meets(engine, 0.0, 200.0).again_ns is None
    assert meets(engine, 120.0, 200.0).again_ns == at(121.0)
    assert engine.decide(at(120.9)).alerts == []
    told = [alert for t_s in range(121, 160) for alert in engine.decide(at(float(t_s))).alerts]
    ranks = [alert.severity.rank for alert in told]
    assert ranks == sorted(ranks)
    assert told[-1].severity is Severity.WARNING
    assert [alert.revision for alert in told] == [*range(1, len(told) + 1)]


# --- a language model -------------------------------------------------------------------------


class Model:
    """Answers as it is told to, and remembers the questions."""

    name = "test"
    answer_to = LanguageModel.answer_to

    def __init__(self, severity: str = "INFO", is_there: bool = True) -> None:
        self.severity, self.is_there = severity, is_there
        self.asked: list[Mapping[str, Any]] = []

    def ask(self, _: str, question: str, schema: object) -> str:
        assert schema
        given = json.loads(question)
        self.asked.append(given)
        if not self.is_there:
            raise LanguageModelError("nobody is there")
        judgements = [
            {"alert": each["id"], "severity": self.severity, "radio": ["r1"]}
            for each in given["rules"]
        ]
        return json.dumps({"judgements": judgements, "advisories": []})

    def accept(self) -> None:
        """Keep the answer."""


class Asked:
    """The engine with a model, before which two come to lose separation after a while."""

    def __init__(self, lost_s: float, model: Model | None = None) -> None:
        self.model = model or Model()
        self.engine = LanguageModelAssistant()
        self.engine._model = cast(Any, self.model)
        self._begin_m = (9260.0 + 400.0 * lost_s) / 2.0
        self.told: list[tuple[float, Alert]] = []
        self.asked_s: list[float] = []
        self.again_s: dict[float, float] = {}

    def goes_on(self, from_s: float, to_s: float, *calls: Transcript, step_s: float = 0.5) -> Asked:
        give(self.engine, from_s, *calls)
        steps = round((to_s - from_s) / step_s)
        for t_s in (from_s + step_s * step for step in range(steps + 1)):
            for callsign, side in (("AAL123", -1.0), ("DAL456", 1.0)):
                north_m = side * (self._begin_m - 200.0 * t_s)
                give(self.engine, t_s, report(callsign, north_m, -200.0 * side, t_s=t_s))
            decision = self.engine.decide(at(t_s))
            self.told += [(t_s, alert) for alert in decision.alerts]
            self.asked_s += [t_s] * len(decision.exchanges)
            if decision.again_ns is not None:
                self.again_s[t_s] = decision.again_ns / SECOND_NS
        return self

    def severities(self) -> list[tuple[float, str]]:
        return [(t_s, alert.severity.value) for t_s, alert in self.told]


def call(text: str, t_s: float, name: str = "c") -> Transcript:
    return Transcript(
        id=name, frequency_khz=118_300, t_tx_ns=at(t_s), t_end_ns=at(t_s), text=text,
        confidence=1.0, engine="test",
    )  # fmt: skip


def test_without_news_the_model_is_asked_every_5_s_while_an_alert_is_open() -> None:
    asked = Asked(170.0, Model("ADVISORY")).goes_on(0.0, 20.0)
    assert asked.asked_s == [1.0, 6.0, 11.0, 16.0]
    assert [each["rules"][0]["severity"] for each in asked.model.asked] == ["ADVISORY"] * 4


def test_with_news_it_is_asked_again_after_2_s_at_the_earliest() -> None:
    asked = Asked(170.0, Model("ADVISORY")).goes_on(0.0, 1.0)
    asked.goes_on(1.5, 10.0, call("American one two three, maintain flight level 200", 1.5))
    assert asked.asked_s == [1.0, 3.0, 8.0]


def test_without_an_alert_or_a_call_it_is_not_asked() -> None:
    asked = Asked(400.0).goes_on(0.0, 10.0)
    assert asked.asked_s == []
    asked.goes_on(10.5, 20.0, call("American one two three, maintain flight level 200", 10.5))
    assert asked.asked_s == [10.5]


def test_a_warning_does_not_wait_for_the_model_which_is_asked_a_tenth_of_a_second_later() -> None:
    asked = Asked(62.0, Model("CAUTION")).goes_on(0.0, 10.0)
    ((warned_s, _),) = [each for each in asked.severities() if each[1] == "WARNING"]
    assert warned_s not in asked.asked_s
    assert asked.again_s[warned_s] == pytest.approx(warned_s + 0.1)


READBACK = "Heading two seven zero, American one two three."


def test_what_the_model_has_answered_holds_for_10_s_without_another_answer() -> None:
    """It withholds an ADVISORY for a readback that resolves it, and answers no more."""
    asked = Asked(185.0).goes_on(0.0, 7.0, call(READBACK, 0.0))
    assert asked.told == []
    assert asked.asked_s == [0.0, 6.5]
    asked.model.is_there = False
    asked.goes_on(7.5, 20.0)
    assert asked.severities() == [(17.0, "ADVISORY")]


def test_an_alert_that_was_told_does_not_fall_whatever_the_model_says() -> None:
    asked = Asked(170.0, Model("ADVISORY")).goes_on(0.0, 3.0)
    assert asked.severities() == [(1.0, "ADVISORY")]
    asked.model.severity = "INFO"
    asked.goes_on(3.5, 12.0, call(READBACK, 3.5))
    assert asked.severities() == [(1.0, "ADVISORY")]
    assert "language model" not in asked.told[0][1].evidence.rules


def test_an_alert_that_the_model_raises_is_told_as_its_judgement() -> None:
    asked = Asked(170.0, Model("CAUTION")).goes_on(0.0, 0.5, call(READBACK, 0.0))
    asked.goes_on(1.0, 5.0)
    assert asked.severities()[-1][1] == "CAUTION"
    assert asked.told[-1][1].evidence.rules[-1] == "language model"
