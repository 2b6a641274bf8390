"""The first warning: which of many it is, and when it counts."""

from __future__ import annotations

from typing import Any, cast

import pytest

from airhilt.messages import Advisory, Evidence, Severity
from airhilt.metrics.first_warning import FirstWarning
from airhilt.metrics.plans import Plans
from airhilt.units import SECOND_NS
from airhilt.world.truth.conflicts import PairTruth
from straight import Straight, Watch


def warning(name: str, at_s: float = 0.0, revision: int = 0) -> Advisory:
    return Advisory(
        t_ns=round(at_s * SECOND_NS), id=name, revision=revision, recipient="AAL1",
        recipients=("AAL1",), kind="loss_of_separation", severity=Severity.WARNING,
        traffic=("AAL1", "DAL2"), message="climb", evidence=Evidence(sources=("adsb",)),
        t_ready_ns=0,
    )  # fmt: skip


def first_of_none() -> FirstWarning:
    """Return the first warning of a scenario without an annotated pair."""
    return FirstWarning(None, cast(Any, None), cast(Any, None), 0.0)


def at_s(first: FirstWarning) -> float | None:
    return None if first.t_ns is None else first.t_ns / SECOND_NS


def test_the_first_of_several_counts_and_of_one_its_first_revision() -> None:
    first = first_of_none()
    first.warned(warning("a", 10.0), is_spoken=False)
    first.warned(warning("a", 11.0, revision=1), is_spoken=False)
    first.warned(warning("b", 12.0), is_spoken=False)
    assert at_s(first) == 10.0


def test_where_the_voice_is_lost_what_waits_for_it_is_read() -> None:
    first = first_of_none()
    first.warned(warning("a", 10.0), is_spoken=True)
    first.voice_lost(15 * SECOND_NS)
    assert at_s(first) == 15.0
    first.heard(("a", "AAL1", 0), 16 * SECOND_NS)
    assert at_s(first) == 15.0


@pytest.mark.parametrize(
    ("alert_ns", "margin_s"),
    [(10 * SECOND_NS - 1, -1e-9), (10 * SECOND_NS, 0.0), (10 * SECOND_NS + 1, 12.0), (None, 12.0)],
)
def test_an_alert_of_tcas_until_the_warning_was_and_a_later_one_would_have_been(
    alert_ns: int | None, margin_s: float
) -> None:
    """Warned 60 s before two aircraft meet, whose TCAS II gives its TA 48 s before that."""
    watch = Watch(
        Straight(-15_000.0, east_m_s=250.0),
        Straight(15_000.0, east_m_s=-250.0),
        names=("AAL1", "DAL2"),
    )
    first = FirstWarning(("AAL1", "DAL2"), watch.monitor, Plans([], {}, {}), 0.0)
    first.warned(warning("a", 10.0), is_spoken=False)
    alert: Any = "tcas_ta"
    truth = PairTruth(first_ns={} if alert_ns is None else {alert: alert_ns})
    assert first.margin_s(alert, truth) == pytest.approx(margin_s, abs=1e-12)
