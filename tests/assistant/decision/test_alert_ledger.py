"""What was told is told again only when it changes, and once more when it is over."""

from __future__ import annotations

from dataclasses import replace

from airhilt.assistant.decision.alert_ledger import AlertLedger
from airhilt.assistant.decision.alerts import Alert
from airhilt.messages import Evidence, GoAround, Severity

ALERT = Alert(
    "a", 0, "runway_conflict", Severity.CAUTION, ("AAL1", "ATC"), ("AAL1",), Evidence(sources=())
)


def test_an_alert_that_holds_is_told_once() -> None:
    ledger = AlertLedger()
    assert ledger.update([ALERT]) == [ALERT]
    later = replace(ALERT, evidence=Evidence(sources=(), time_to_go_s=3.0), messages={"AAL1": "x"})
    assert not ledger.update([later])


def test_what_changes_is_told_with_a_higher_revision() -> None:
    ledger = AlertLedger()
    ledger.update([ALERT])
    worse = replace(ALERT, severity=Severity.WARNING)
    advised = replace(worse, recommendations={"AAL1": GoAround(runway="01")})
    assert ledger.update([worse]) == [replace(worse, revision=1)]
    assert ledger.update([advised]) == [replace(advised, revision=2)]


def test_what_is_missing_is_over_and_may_come_back() -> None:
    ledger = AlertLedger()
    ledger.update([ALERT])
    (over,) = ledger.update([])
    assert (over.active, over.revision, over.severity) == (False, 1, Severity.INFO)
    assert not ledger.update([])
    assert ledger.update([ALERT]) == [replace(ALERT, revision=2)]
