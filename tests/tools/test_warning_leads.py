"""The table of baselines is measured where nobody reacts, and shows medians over seeds."""

from __future__ import annotations

from airhilt import load
from airhilt.scenario.models import AircraftSpec
from warning_leads import Lead, median_of, unheeded


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
