"""Costs of a run to the people in it: what is broken off, flown aside, and told anew."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from airhilt.messages import ActorTruth, Advisory, Climb
from airhilt.metrics.measures import HOUR_S
from airhilt.metrics.plans import LateralOffset, Plans, place_of
from airhilt.metrics.summary import Costs
from airhilt.surveillance.tcas import AltitudeAt
from airhilt.units import FOOT, NAUTICAL_MILE, SECOND_NS

EN_ROUTE = "en_route"
GO_AROUND, REJECTED_TAKEOFF = "go_around", "rejected_takeoff"


@dataclass
class _Deviation:
    """Deviation of one aircraft from its plan, integrated over time en route."""

    since_ns: int
    """Start of the run for the aircraft."""
    planned_altitude: AltitudeAt
    planned_path: LateralOffset
    level_until_ns: float
    path_until_ns: float
    level_m_s: float = 0.0
    """Integral of the distance from the planned altitude, in m times s."""
    path_m_s: float = 0.0
    """Integral of the lateral distance from the planned path, in m times s."""

    def take(self, state: ActorTruth, since_ns: int) -> None:
        """Add the deviation of a state, which stands for the time since another one."""
        passed_s = (state.t_ns - since_ns) / SECOND_NS
        if state.t_ns <= self.level_until_ns:
            planned_m = self.planned_altitude((state.t_ns - self.since_ns) / SECOND_NS)
            self.level_m_s += abs(state.altitude_m - planned_m) * passed_s
        if state.t_ns <= self.path_until_ns:
            self.path_m_s += self.planned_path(place_of(state)) * passed_s


class CostRecords:
    """Follows the true states of the actors, and what they are told, for what a run costs them."""

    def __init__(self, plans: Plans) -> None:
        self._plans = plans
        self._last: dict[str, ActorTruth] = {}
        self._deviations: dict[str, _Deviation] = {}
        self._begun: Counter[str] = Counter()
        """Number of times that aircraft came into each phase."""
        self._senses: dict[tuple[str, str], str] = {}
        """Sense that each recipient of each advisory was told last."""
        self._reversals = 0

    def take_state(self, state: ActorTruth) -> None:
        """Receive the true state of an actor."""
        if state.category != "aircraft":
            return
        last = self._last.get(state.actor)
        if last is None:
            self._begin(state)
        else:
            self._begun[state.phase] += state.phase != last.phase
            deviation = self._deviations.get(state.actor)
            if deviation is not None and state.phase == EN_ROUTE:
                deviation.take(state, last.t_ns)
        self._last[state.actor] = state

    def _begin(self, state: ActorTruth) -> None:
        if state.phase != EN_ROUTE or state.target_altitude_m is None:
            return
        self._deviations[state.actor] = _Deviation(
            state.t_ns,
            self._plans.altitude_from_start(state, state.target_altitude_m),
            self._plans.offset_from_start(state),
            self._plans.level_until_ns(state.actor),
            self._plans.path_until_ns(state.actor),
        )

    def take_advisory(self, advisory: Advisory) -> None:
        """Receive a revision of an advisory."""
        told = advisory.recommendation
        if isinstance(told, Climb):
            key = advisory.id, advisory.recipient
            self._reversals += self._senses.get(key, told.sense) != told.sense
            self._senses[key] = told.sense

    def summary(self, advisories: int, advice_spoken_s: float, duration_s: float) -> Costs:
        """Return the costs, with the number of advisories and the time for which they spoke."""
        deviations = self._deviations.values()
        return Costs(
            go_arounds=self._begun[GO_AROUND],
            rejected_takeoffs=self._begun[REJECTED_TAKEOFF],
            level_deviation_ft_s=sum(one.level_m_s for one in deviations) / FOOT,
            path_deviation_nm_s=sum(one.path_m_s for one in deviations) / NAUTICAL_MILE,
            advisories_per_hour=advisories / (duration_s / HOUR_S) if duration_s else None,
            advice_spoken_s=advice_spoken_s,
            reversals=self._reversals,
        )
