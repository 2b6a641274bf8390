"""Equipment that told somebody what to do first has done what an assistant cannot claim."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

from airhilt.messages import Advisory, EquipmentAlert, Evidence, MaintainLevel, Severity
from airhilt.metrics.equipment import EquipmentRecords
from airhilt.units import SECOND_NS


def records(*engines: str) -> EquipmentRecords:
    """Return records that take every alert for one about the annotated pair."""
    all_concern = SimpleNamespace(
        add=lambda _: True, warns_of_conflict=lambda _: True, summaries=lambda _: []
    )
    return EquipmentRecords(engines, lambda: cast(Any, all_concern))


def alert(at_s: float, equipment: str = "tcas", *, tells: bool = False) -> EquipmentAlert:
    return EquipmentAlert(
        t_ns=round(at_s * SECOND_NS), equipment=equipment,
        advisory=Advisory(
            id="e-1", revision=0, recipient="AAL123", recipients=("AAL123",),
            kind="loss_of_separation", severity=Severity.WARNING, traffic=("AAL123",),
            message="level off", evidence=Evidence(sources=("tcas",)), t_ready_ns=0,
            recommendation=MaintainLevel(altitude_ft=35_000.0) if tells else None,
        ),
    )  # fmt: skip


def test_a_warning_without_a_recommendation_is_no_action() -> None:
    found = records("tcas")
    found.take(alert(10.0))
    assert not found.acts_before(None)
    (entry,) = found.summaries(None, [])
    assert (entry.t_first_warning_s, entry.t_first_action_s, entry.margin_s) == (10.0, None, None)


def test_it_acts_before_an_assistant_that_warns_later_or_never() -> None:
    found = records("tcas:hmd")
    found.take(alert(10.0))
    found.take(alert(20.0, tells=True))
    assert found.acts_before(round(20.5 * SECOND_NS))
    assert found.acts_before(None)
    assert not found.acts_before(20 * SECOND_NS)
    (entry,) = found.summaries(4 * SECOND_NS, [])
    assert entry.equipment == "tcas"
    assert (entry.t_first_action_s, entry.margin_s) == (20.0, 6.0)


def test_each_piece_has_its_own_entry_though_it_says_nothing() -> None:
    found = records("tcas", "conflict_alert")
    found.take(alert(5.0, "conflict_alert"))
    assert [entry.t_first_warning_s for entry in found.summaries(None, [])] == [None, 5.0]
