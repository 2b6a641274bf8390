"""The first warning of the annotated conflict, and how long before TCAS II it came."""

from __future__ import annotations

from typing import NamedTuple

from airhilt.messages import Advisory
from airhilt.metrics.plans import Plans
from airhilt.surveillance import tcas
from airhilt.units import SECOND_NS
from airhilt.world.truth.conflicts import ConflictMonitor, Pair, PairTruth


class _Warning(NamedTuple):
    t_ns: int
    advisory: Advisory
    projection: tcas.Projection | None


class FirstWarning:
    """The first warning: when it was heard or, where no voice speaks, read."""

    def __init__(
        self, pair: Pair | None, monitor: ConflictMonitor, plans: Plans, ground_m: float
    ) -> None:
        self._pair = pair
        self._monitor = monitor
        self._plans = plans
        self._ground_m = ground_m
        self._unspoken: dict[tuple[str, str, int], Advisory] = {}
        """Warnings that wait for their audio, by id, recipient and revision."""
        self._first: _Warning | None = None

    @property
    def t_ns(self) -> int | None:
        """Time of the first warning, None before it."""
        return self._first and self._first.t_ns

    @property
    def advisory(self) -> Advisory | None:
        """The first warning as it was published, None before it was heard or read."""
        return self._first and self._first.advisory

    def warned(self, advisory: Advisory, is_spoken: bool) -> None:
        """Record an advisory that warns of the conflict; if it is spoken, its audio counts."""
        if is_spoken:
            self._unspoken[advisory.id, advisory.recipient, advisory.revision] = advisory
        else:
            self._add(advisory, advisory.t_ns)

    def ended(self, advisory_id: str) -> None:
        """Record that an advisory is not active any more: what was not said of it never will be."""
        self._unspoken = {
            name: one for name, one in self._unspoken.items() if one.id != advisory_id
        }

    def heard(self, name: tuple[str, str, int], t_ns: int) -> None:
        """Record when the voice of an advisory began, by its id, recipient and revision."""
        spoken = self._unspoken.pop(name, None)
        if spoken is not None:
            self._add(spoken, t_ns)

    def voice_lost(self, now_ns: int) -> None:
        """Record the loss of the voice: warnings that wait for it are read now."""
        for advisory in self._unspoken.values():
            self._add(advisory, now_ns)
        self._unspoken.clear()

    def margin_s(self, alert: tcas.Alert, truth: PairTruth | None) -> float | None:
        """Return the time from the first warning to an alert of TCAS II, had nobody reacted, in s.

        Where TCAS spoke before the warning, as the truth of the pair tells, it is negative.
        """
        first = self._first
        if first is None or first.projection is None:
            return None
        alert_ns = truth.first_ns.get(alert) if truth else None
        if alert_ns is not None and alert_ns <= first.t_ns:
            return (alert_ns - first.t_ns) / SECOND_NS
        projection = first.projection
        return projection.traffic_s if alert == "tcas_ta" else projection.resolution_s

    def _add(self, advisory: Advisory, now_ns: int) -> None:
        if self._first is None:
            self._first = _Warning(now_ns, advisory, self._projection(now_ns))

    def _projection(self, now_ns: int) -> tcas.Projection | None:
        """Return when TCAS II would speak if both went on as the script plans, None if never."""
        pair = self._pair
        if not (pair and self._monitor.flying(pair) and self._monitor.is_seen_by_tcas(pair)):
            return None
        motion, (first, second) = self._monitor.motion(pair), self._monitor.profiles(pair)
        first_m = self._plans.altitude_at(pair[0], now_ns, first)
        second_m = self._plans.altitude_at(pair[1], now_ns, second)
        return tcas.earliest(
            tcas.project(motion, first_m, second_m, self._ground_m),
            tcas.project(motion, second_m, first_m, self._ground_m),
        )
