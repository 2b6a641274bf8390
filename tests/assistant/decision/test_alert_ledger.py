"""What was told is told again only when it changes, and once more when it is over."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from airhilt.assistant.decision.alert_ledger import AlertLedger
from airhilt.assistant.decision.alerts import Alert
from airhilt.assistant.decision.raised_alerts import Hazard, RaisedAlerts
from airhilt.messages import Evidence, GoAround, Severity
from airhilt.units import SECOND_NS

ALERT = Alert(
    "a", 0, "runway_conflict", Severity.CAUTION, ("AAL1", "ATC"), ("AAL1",), Evidence(sources=())
)


def test_an_alert_that_holds_is_told_once() -> None:
    ledger = AlertLedger()
    assert ledger.update([ALERT]) == [ALERT]
    later = replace(ALERT, evidence=Evidence(sources=(), time_to_go_s=3.0), messages={"AAL1": "x"})
    assert not ledger.update([later])


def test_what_holds_may_be_told_again_though_nothing_has_changed() -> None:
    ledger = AlertLedger()
    ledger.update([ALERT])
    assert ledger.update([ALERT], again={"b"}) == []
    assert ledger.update([ALERT], again={"a"}) == [replace(ALERT, revision=1)]


@pytest.mark.parametrize(
    "changed",
    [
        {"severity": Severity.WARNING},
        {"kind": "readback_mismatch"},
        {"recipients": ("AAL1",)},
        {"traffic": ("AAL1", "DAL2")},
        {"recommendations": {"AAL1": GoAround(runway="01")}},
    ],
)
def test_whoever_or_whatever_it_concerns_is_told_with_a_higher_revision(
    changed: dict[str, Any],
) -> None:
    ledger = AlertLedger()
    ledger.update([ALERT])
    news = replace(ALERT, **changed)
    assert ledger.update([news]) == [replace(news, revision=1)]


def test_what_is_over_is_told_without_recommendations_and_may_come_back() -> None:
    ledger = AlertLedger()
    other = replace(ALERT, id="b")
    advised = replace(
        ALERT, recommendations={"AAL1": GoAround(runway="01")}, messages={"AAL1": "x"}
    )
    ledger.update([advised, other])
    assert set(ledger.holding()) == {"a", "b"}
    over = replace(ALERT, revision=1, severity=Severity.INFO, active=False)
    assert ledger.update([other]) == [over]
    assert set(ledger.holding()) == {"b"}
    assert not ledger.update([other])
    assert ledger.update([advised, other]) == [replace(advised, revision=2)]


# --- hazards that are judged anew each time -------------------------------------------------


def hazard(severity: Severity, key: str = "h", **given: Any) -> Hazard:
    return Hazard(
        (key,), severity, "runway_conflict", ("AAL1",), ("AAL1",), Evidence(sources=()), **given
    )


class Raising:
    """Alerts for hazards that must last for 2 s, and be gone for 5."""

    def __init__(self) -> None:
        self.alerts = RaisedAlerts("lights", 2.0, 5.0)

    def at(self, t_s: float, *hazards: Hazard) -> list[tuple[str, int, Severity, bool]]:
        told = self.alerts.update(round(t_s * SECOND_NS), hazards)
        return [(each.id, each.revision, each.severity, each.active) for each in told]


def test_a_hazard_is_told_once_it_has_lasted_when_it_rises_and_when_it_is_gone() -> None:
    raising, caution, warning = Raising(), hazard(Severity.CAUTION), hazard(Severity.WARNING)
    assert raising.at(0.0, caution) == []
    assert raising.at(1.9, caution) == []
    assert raising.at(2.0, caution) == [("lights-1", 0, Severity.CAUTION, True)]
    assert raising.at(3.0, caution) == []
    assert raising.at(4.0, warning) == []
    assert raising.at(6.0, warning) == [("lights-1", 1, Severity.WARNING, True)]
    assert raising.at(7.0) == []
    assert raising.at(11.9) == []
    assert raising.alerts.has_any
    assert raising.at(12.0) == [("lights-1", 2, Severity.INFO, False)]
    assert not raising.alerts.has_any
    raising.at(20.0, caution)
    assert raising.at(22.0, caution) == [("lights-2", 0, Severity.CAUTION, True)]


def test_a_hazard_that_was_never_told_is_forgotten_at_once() -> None:
    raising = Raising()
    raising.at(0.0, hazard(Severity.CAUTION))
    assert raising.alerts.has_any
    assert raising.at(1.0) == []
    assert not raising.alerts.has_any


def test_of_two_with_one_key_the_graver_one_counts() -> None:
    for pair in ((Severity.CAUTION, Severity.WARNING), (Severity.WARNING, Severity.CAUTION)):
        raising = Raising()
        both = [hazard(severity) for severity in pair]
        raising.at(0.0, *both)
        assert raising.at(2.0, *both) == [("lights-1", 0, Severity.WARNING, True)]


def test_each_hazard_has_its_own_alert_and_the_last_recommendations() -> None:
    raising = Raising()
    raising.at(0.0, hazard(Severity.CAUTION, "a"), hazard(Severity.CAUTION, "b"))
    advised = {"AAL1": GoAround(runway="01")}
    told = raising.alerts.update(
        2 * SECOND_NS,
        [hazard(Severity.CAUTION, "a", recommendations=advised), hazard(Severity.CAUTION, "b")],
    )
    assert [(each.id, each.recommendations) for each in told] == [
        ("lights-1", advised), ("lights-2", {}),
    ]  # fmt: skip
    over = raising.alerts.update(8 * SECOND_NS, [])
    assert over == []
    over = raising.alerts.update(13 * SECOND_NS, [])
    assert [each.recommendations for each in over] == [{}, {}]
