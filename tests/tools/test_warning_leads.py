"""The table of baselines is measured where nobody reacts, and shows medians over seeds."""

from __future__ import annotations

from typing import Any

from airhilt import load
from airhilt.messages import Advisory, Severity
from airhilt.metrics.summary import AdvisorySummary, ClosestApproach, Summary
from airhilt.scenario.models import AircraftSpec
from airhilt.units import SECOND_NS
from warning_leads import Lead, lead_s, median_of, unheeded


def test_no_crew_complies_and_no_equipment_is_there() -> None:
    scenario = unheeded(load("s02a_headon_tcas"))
    crews = [actor.pilot for actor in scenario.actors if isinstance(actor, AircraftSpec)]
    assert [crew.compliance for crew in crews] == [0.0, 0.0]
    assert scenario.equipment == ()


def test_a_median_is_over_the_seeds_in_which_there_was_such_an_advisory() -> None:
    leads = [
        Lead("a", seed, "tcas", lead_s, None) for seed, lead_s in enumerate((40.0, None, 50.0))
    ]
    assert median_of(leads, "caution_s") == "45"
    assert median_of(leads, "warning_s") == "-"


def advisory(name: str, t_s: int) -> Advisory:
    known: dict[str, Any] = {"id": name, "t_ns": t_s * SECOND_NS, "severity": Severity.CAUTION}
    return Advisory.model_construct(**known)


def test_a_nuisance_alert_gives_no_lead() -> None:
    told = [
        AdvisorySummary(
            id=name, nuisance_to=("AAL1",) if name == "cloud" else (), kind="runway_conflict",
            traffic=(), t_first_s=0.0,
            t_spoken_s=None, severity=Severity.CAUTION, revisions=1,
        )
        for name in ("cloud", "meeting")
    ]  # fmt: skip
    closest = ClosestApproach(t_s=100.0, horizontal_m=0.0, vertical_m=0.0)
    fields: dict[str, Any] = {"advisories": told, "closest_approach": closest}
    summary = Summary.model_construct(**fields)
    advisories = [advisory("cloud", 10), advisory("meeting", 40)]
    assert lead_s(summary, advisories, Severity.CAUTION) == 60.0
    assert lead_s(summary, advisories[:1], Severity.CAUTION) is None
    assert lead_s(summary, advisories, Severity.WARNING) is None
