"""Dry flights: what a scenario comes to if nobody is warned, seed by seed."""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict

from airhilt.cosim.simulation import run
from airhilt.metrics.outcome import SERIOUS
from airhilt.metrics.summary import Summary
from airhilt.options import Options
from airhilt.scenario import Scenario
from airhilt.scenario.models import UnassistedOutcome
from airhilt.world.truth.runways import IncursionCategory

DryOutcome = UnassistedOutcome | Literal["none"]
"""Most severe outcome of any two actors; a runway incursion is one of category A or B."""
LEAST_FLIGHTS_FOR_TAILS = 20
"""Number of flights from which a 5th and a 95th percentile are given: one lies beyond each."""


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True)


class DryFlight(_Part):
    """Outcome of one seed."""

    seed: int
    came_about: bool
    """True if the conflict came to what the scenario declares; without one, if any did."""
    outcome: DryOutcome
    incursion: IncursionCategory | None
    closest_m: float | None
    """Slant distance at the closest approach; None if nobody came near."""


class ClosestApproaches(_Part):
    """Spread of the closest approaches, in m."""

    min_m: float
    median_m: float
    max_m: float
    p5_m: float | None
    p95_m: float | None


class DryFlights(_Part):
    """Outcomes of the seeds of one scenario."""

    scenario: str
    declared: UnassistedOutcome | None
    """None: the scenario declares no conflict."""
    flights: tuple[DryFlight, ...]

    @property
    def came_about(self) -> int:
        """Number of flights in which the conflict came about."""
        return sum(flight.came_about for flight in self.flights)

    @property
    def uneventful(self) -> tuple[int, ...]:
        """Seeds that bring about no conflict though the scenario declares one."""
        if self.declared is None:
            return ()
        return tuple(flight.seed for flight in self.flights if not flight.came_about)

    @property
    def outcomes(self) -> Counter[DryOutcome]:
        """Number of flights by outcome."""
        return Counter(flight.outcome for flight in self.flights)

    @property
    def closest(self) -> ClosestApproaches | None:
        """Spread of the closest approaches, None if there was none."""
        found = [flight.closest_m for flight in self.flights if flight.closest_m is not None]
        if not found:
            return None
        p5, median, p95 = map(float, np.percentile(found, (5.0, 50.0, 95.0)))
        has_tails = len(found) >= LEAST_FLIGHTS_FOR_TAILS
        return ClosestApproaches(
            min_m=min(found),
            median_m=median,
            max_m=max(found),
            p5_m=p5 if has_tails else None,
            p95_m=p95 if has_tails else None,
        )


def fly_dry(scenario: Scenario, seeds: Sequence[int]) -> Iterator[DryFlight]:
    """Yield what each seed comes to without assistant, equipment, cameras and speech.

    Raises
    ------
    AirhiltError
        A run of a seed cannot begin.
    """
    for seed in seeds:
        yield _flight(scenario.model_copy(update={"equipment": ()}), seed)


def _flight(scenario: Scenario, seed: int) -> DryFlight:
    with tempfile.TemporaryDirectory(prefix="airhilt-") as scratch:
        options = Options(
            seed=seed,
            assistant="none",
            latency="fixed",
            cameras=False,
            speech=False,
            report=False,
            out=Path(scratch) / "run",
        )
        summary = run(scenario, options).summary
    outcome, closest = _outcome(summary), summary.closest_approach
    return DryFlight(
        seed=seed,
        came_about=(
            outcome != "none" if scenario.conflict is None else bool(summary.unassisted_as_declared)
        ),
        outcome=outcome,
        incursion=summary.runway_incursion_category,
        closest_m=(closest.horizontal_m**2 + closest.vertical_m**2) ** 0.5 if closest else None,
    )


def _outcome(summary: Summary) -> DryOutcome:
    if summary.collision:
        return "collision"
    if summary.nmac:
        return "nmac"
    if summary.runway_incursion_category in SERIOUS:
        return "runway_incursion"
    return "loss_of_separation" if summary.loss_of_separation else "none"
