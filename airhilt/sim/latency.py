"""Latency sources: what decides how long a step of a worker takes in simulation time."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, Protocol

from airhilt.errors import AirhiltError
from airhilt.sim.streams import stream
from airhilt.units import seconds_to_ns

NEVER_NS = seconds_to_ns(1e9)
"""Latency of a step that never ends, in ns: longer than any run."""


class LatencySource(Protocol):
    """Gives the latency of each step of one worker."""

    def known_ns(self, seq: int) -> int | None:
        """Return the latency of step ``seq``, or None when it is what the step takes.

        A source that knows it beforehand lets the simulation go on while the worker computes.
        """
        ...


class Measured:
    """The worker's own compute time on this machine."""

    def known_ns(self, seq: int) -> int | None:  # noqa: ARG002
        """Return None: only the step itself can tell."""
        return None


@dataclass(frozen=True)
class Fixed:
    """The same latency for every step."""

    latency_ns: int

    def known_ns(self, seq: int) -> int | None:  # noqa: ARG002
        """Return the latency."""
        return self.latency_ns


class Lognormal:
    """A latency drawn for each step; equal for equal seed, worker and step number."""

    def __init__(self, worker: str, seed: int, median_s: float, sigma: float) -> None:
        self._worker = worker
        self._seed = seed
        self._median_s = median_s
        self._sigma = sigma

    def known_ns(self, seq: int) -> int | None:
        """Return the latency drawn for step ``seq``."""
        draw = stream(self._seed, f"latency/{self._worker}", seq).standard_normal()
        return seconds_to_ns(self._median_s * math.exp(self._sigma * draw))


class Replay:
    """The latencies of an earlier run.

    Parameters
    ----------
    breaks_off
        Whether the earlier run broke off: steps that it did not reach never end.

    Raises
    ------
    AirhiltError
        In `known_ns`: the earlier run had no such step, so the two have diverged.
    """

    def __init__(self, worker: str, latencies_ns: Mapping[int, int], breaks_off: bool) -> None:
        self._worker = worker
        self._latencies_ns = latencies_ns
        self._breaks_off = breaks_off

    def known_ns(self, seq: int) -> int | None:
        """Return the latency that step ``seq`` had then."""
        try:
            return self._latencies_ns[seq]
        except KeyError:
            if self._breaks_off:
                return NEVER_NS
            raise AirhiltError(
                f"latency replay: the recorded run has {len(self._latencies_ns)} steps of "
                f"{self._worker!r}, this run came to step {seq}: replay needs the same scenario, "
                "seed and workers"
            ) from None


@dataclass(frozen=True)
class LatencySpec:
    """The latency source of a run; `source` makes that of one worker."""

    kind: Literal["measured", "fixed", "lognormal", "replay"]
    fixed_s: float | None = None
    replay_of: str | None = None
    recorded: Mapping[str, Mapping[int, int]] | None = None
    breaks_off: bool = False

    @property
    def text(self) -> str:
        """Spelling on the command line."""
        if self.fixed_s is not None:
            return f"fixed:{self.fixed_s:g}"
        return f"replay:{self.replay_of}" if self.kind == "replay" else self.kind

    def source(self, worker: str, seed: int, median_s: float, sigma: float) -> LatencySource:
        """Return the source for a worker that declares ``median_s`` and ``sigma``."""
        match self.kind:
            case "measured":
                return Measured()
            case "fixed":
                return Fixed(seconds_to_ns(median_s if self.fixed_s is None else self.fixed_s))
            case "lognormal":
                return Lognormal(worker, seed, median_s, sigma)
            case "replay":
                recorded = (self.recorded or {}).get(worker, {})
                return Replay(worker, recorded, self.breaks_off)


def parse_latency(text: str) -> LatencySpec:
    """Return what ``measured``, ``fixed``, ``fixed:SECONDS``, ``lognormal`` or ``replay:RUN`` say.

    The recorded latencies of ``replay:RUN`` are for the caller to fill in.

    Raises
    ------
    AirhiltError
        It is none of these.
    """
    kind, _, argument = text.partition(":")
    if text in ("measured", "fixed", "lognormal"):
        return LatencySpec(text)  # type: ignore[arg-type]
    if kind == "fixed":
        try:
            seconds = float(argument)
        except ValueError:
            seconds = math.nan
        if 0.0 <= seconds <= 3600.0:
            return LatencySpec("fixed", fixed_s=seconds)
    if kind == "replay" and argument:
        return LatencySpec("replay", replay_of=argument)
    raise AirhiltError(
        f"latency {text!r}: expected measured, fixed, fixed:SECONDS (0 to 3600), lognormal or "
        "replay:RUN"
    )
