"""The first warning of the annotated conflict, and how long before TCAS II it came."""

from __future__ import annotations

from airhilt.messages import Advisory
from airhilt.metrics.plans import Plans
from airhilt.surveillance import tcas
from airhilt.units import SECOND_NS
from airhilt.world.truth.conflicts import ConflictMonitor, Pair, PairTruth


class FirstWarning:
    """The first warning: when it was heard or, where no voice speaks, read.

    Attributes
    ----------
    t_ns
        Time of the first warning, None before it.
    advisory
        The first warning as it was published, None before it was heard or read.
    """

    def __init__(
        self, pair: Pair | None, monitor: ConflictMonitor, plans: Plans, ground_m: float
    ) -> None:
        self.t_ns: int | None = None
        self.advisory: Advisory | None = None
        self._pair = pair
        self._monitor = monitor
        self._plans = plans
        self._ground_m = ground_m
        self._unspoken: dict[tuple[str, str, int], Advisory] = {}
        """Warnings that wait for their audio, by id, recipient and revision."""
        self._projection: tcas.Projection | None = None

    def warned(self, advisory: Advisory, is_spoken: bool) -> None:
        """Record an advisory that warns of the conflict; if it is spoken, its audio counts."""
        if self.t_ns is not None:
            return
        if is_spoken:
            self._unspoken[advisory.id, advisory.recipient, advisory.revision] = advisory
        else:
            self._set(advisory, advisory.t_ns)

    def heard(self, name: tuple[str, str, int], t_ns: int) -> None:
        """Record when the voice of an advisory began, by its id, recipient and revision."""
        spoken = self._unspoken.get(name)
        if spoken is not None:
            self._set(spoken, t_ns)

    def voice_lost(self, now_ns: int) -> None:
        """Record the loss of the voice: warnings that wait for it are read now."""
        if self._unspoken:
            self._set(next(iter(self._unspoken.values())), now_ns)

    def margin_s(self, alert: tcas.Alert, truth: PairTruth | None) -> float | None:
        """Return the time from the first warning to an alert of TCAS II, had nobody reacted, in s.

        Where TCAS spoke before the warning, the margin is negative.

        Parameters
        ----------
        truth
            Truth of the annotated pair.
        """
        if self.t_ns is None or self._projection is None or self._pair is None:
            return None
        alert_ns = truth.first_ns.get(alert) if truth else None
        if alert_ns is not None and alert_ns <= self.t_ns:
            return (alert_ns - self.t_ns) / SECOND_NS
        return self._projection.traffic_s if alert == "tcas_ta" else self._projection.resolution_s

    def _set(self, advisory: Advisory, now_ns: int) -> None:
        self._unspoken.clear()
        if self.t_ns is not None:
            return
        self.t_ns = now_ns
        self.advisory = advisory
        pair = self._pair
        if pair and self._monitor.flying(pair) and self._monitor.is_seen_by_tcas(pair):
            self._projection = self._project(pair, now_ns)

    def _project(self, pair: Pair, now_ns: int) -> tcas.Projection:
        """Return when TCAS II would speak if both went on as the script plans."""
        motion, first, second = self._monitor.motion(pair)
        first_m = self._plans.altitude_at(pair[0], now_ns, first)
        second_m = self._plans.altitude_at(pair[1], now_ns, second)
        return tcas.earliest(
            tcas.project(motion, first_m, second_m, self._ground_m),
            tcas.project(motion, second_m, first_m, self._ground_m),
        )
