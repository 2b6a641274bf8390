"""Checks of a scenario's own response model."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.scenario.models import ResponseModel, Responses, Scenario
from airhilt.scenario.problems import Problem


def meaningless_shares(scenario: Scenario) -> Iterator[Problem]:
    """Yield shares of those who climb or descend wrongly, of people who do neither when told.

    Crews climb and descend by advisories and alerts. What they do after a call is done as told.
    """
    model = scenario.crews
    if not isinstance(model, ResponseModel):
        return
    rows: list[tuple[str, Responses | None]] = [
        ("crews/controller", model.crews.controller),
        *((f"drivers/{name}", each) for name, each in model.drivers),
        ("controllers", model.controllers),
    ]
    for path, responses in rows:
        for name in ("weak", "opposite"):
            share = 0.0 if responses is None else getattr(responses, name)
            if share:
                yield Problem(
                    f"crews/{path}/{name}",
                    f"found {share:g}; expected 0: only crews fly too slowly or the wrong way, and "
                    "only by an advisory or an alert",
                )
