"""The outcome of a conflict, as the monitors of the truth found it."""

from __future__ import annotations

from collections.abc import Iterable

from airhilt.metrics.summary import ClosestApproach, ConflictOutcome, RunwayIncursion
from airhilt.scenario.models import UnassistedOutcome
from airhilt.units import SECOND_NS
from airhilt.world.truth.conflicts import ConflictMonitor, Pair, PairTruth
from airhilt.world.truth.runways import IncursionCategory, RunwayMonitor

SEVEREST_FIRST: tuple[IncursionCategory, ...] = ("accident", "A", "B", "C", "D")
"""Categories of runway incursions in falling order."""
SERIOUS = frozenset(SEVEREST_FIRST[:3])
"""Categories that mean that a conflict was not avoided."""
INFRINGEMENTS = frozenset({"loss_of_separation", "nmac", "collision"})
"""Phases that mean that a conflict was not avoided."""
AT_LEAST: dict[UnassistedOutcome, frozenset[str]] = {
    "collision": frozenset({"collision"}),
    "nmac": frozenset({"nmac", "collision"}),
    "runway_incursion": frozenset({"collision"}),
    "loss_of_separation": INFRINGEMENTS,
}
"""Phases of a pair that are as severe as the outcome that a scenario declares, or more so."""


class Outcome:
    """The outcome of a run: of the annotated pair, and of the runways where there are any.

    `causes` are the pairs whose collision begins the conflict: it is no outcome of it.
    """

    def __init__(
        self,
        monitor: ConflictMonitor,
        runways: RunwayMonitor | None,
        pair: Pair | None,
        causes: Iterable[Pair] = (),
    ) -> None:
        self._monitor = monitor
        self._runways = runways
        self._pair = pair
        self._causes = {frozenset(each) for each in causes}

    @property
    def pair_truth(self) -> PairTruth | None:
        """Truth of the annotated pair; without one, of the pair that came nearest."""
        pairs = self._monitor.pairs
        if self._pair is not None:
            return pairs.get(self._pair)
        near = [truth for truth in pairs.values() if truth.closest is not None]
        return min(near, key=lambda t: t.closest.slant_m if t.closest else 0.0, default=None)

    @property
    def closest_approach(self) -> ClosestApproach | None:
        """Closest approach of the annotated pair in the conflict window.

        In a scenario without a conflict it is that of the pair that came nearest.
        """
        truth = self.pair_truth
        if truth is None:
            return None
        closest = truth.closest if self._pair is None else truth.closest_in_window
        if closest is None:
            return None
        return ClosestApproach(
            t_s=closest.t_ns / SECOND_NS,
            horizontal_m=closest.horizontal_m,
            vertical_m=closest.vertical_m,
        )

    def happened(self, phase: str) -> bool:
        """Return true if any pair but the causes came to a phase, such as ``nmac``."""
        return any(
            phase in truth.first_ns
            for pair, truth in self._monitor.pairs.items()
            if frozenset(pair) not in self._causes
        )

    def incursions(self) -> list[RunwayIncursion]:
        """Return all runway incursions."""
        if self._runways is None:
            return []
        return [
            RunwayIncursion(
                t_s=incursion.t_ns / SECOND_NS,
                runway=incursion.runway,
                user=incursion.user,
                intruder=incursion.intruder,
                category=incursion.category,
                closest_m=None if incursion.closest is None else incursion.closest.slant_m,
            )
            for incursion in self._runways.incursions.values()
        ]

    def worst_category(self) -> IncursionCategory | None:
        """Return the most severe category of the incursions, None if there were none."""
        categories = [incursion.category for incursion in self.incursions()]
        return min(categories, key=SEVEREST_FIRST.index, default=None)

    def came_about(self, declared: UnassistedOutcome) -> bool:
        """Return true if the annotated pair came to what a scenario declares, or to worse."""
        if declared == "runway_incursion" and self._pair_in_serious_incursion():
            return True
        truth = self.pair_truth
        return truth is not None and not truth.first_ns.keys().isdisjoint(AT_LEAST[declared])

    def avoided(self, was_warned: bool) -> bool | None:
        """Return true if the conflict was avoided after a warning, None if nothing happened.

        It was not if one of the pair came to harm, with whomever: who evades one aircraft into
        another, or into the ground, has avoided nothing.
        """
        if self._pair_came_to_harm():
            return False
        return True if was_warned else None

    def conflict(self, was_warned: bool, has_opened: bool, is_credited: bool) -> ConflictOutcome:
        """Return what became of the annotated conflict.

        Parameters
        ----------
        was_warned
            Somebody was warned of it before its window closed.
        has_opened
            Its window opened.
        is_credited
            Somebody was warned before equipment told anybody what to do.
        """
        avoided = self.avoided(was_warned=is_credited)
        if avoided:
            return "avoided"
        if avoided is False:
            return "lost" if was_warned or self._pair is None else "missed"
        if was_warned:
            return "avoided_by_equipment"
        return "missed" if has_opened else "no_conflict"

    def _pair_came_to_harm(self) -> bool:
        if self._pair is None:
            truth = self.pair_truth
            return truth is not None and not truth.first_ns.keys().isdisjoint(INFRINGEMENTS)
        own = set(self._pair)
        infringed = any(
            not truth.first_ns.keys().isdisjoint(INFRINGEMENTS)
            for pair, truth in self._monitor.pairs.items()
            if own.intersection(pair) and frozenset(pair) not in self._causes
        )
        incurred = any(
            incursion.category in SERIOUS and own & {incursion.user, incursion.intruder}
            for incursion in self.incursions()
        )
        return infringed or incurred or not self._monitor.flying(self._pair)

    def _pair_in_serious_incursion(self) -> bool:
        pair = set(self._pair or ())
        return any(
            incursion.category in SERIOUS and {incursion.user, incursion.intruder} <= pair
            for incursion in self.incursions()
        )
