"""Latency sources: what decides how long a step of a worker takes in simulation time."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal, Protocol

from airhilt.errors import AirhiltError
from airhilt.sim.streams import stream
from airhilt.units import seconds_to_ns

NEVER_NS = seconds_to_ns(1e9)
"""Latency of a step that never ends, in ns: longer than any run."""
LONGEST_S = 3600.0
"""Longest latency that may be given, in s."""
SPREAD = 0.1
"""Standard deviation of the logarithm of the times that `SinceStart` draws. An assumption: the
publication whose recogniser it stands for gives a mean and no spread."""
LEAST_NS = seconds_to_ns(0.1)
"""Least latency of `SinceStart`, in ns: time of a step after the end of what it works on. An
assumption."""


class LatencySource(Protocol):
    """Gives the latency of each step of one worker."""

    def known_ns(self, seq: int, lasted_ns: int | None = None) -> int | None:
        """Return the latency of step ``seq``, or None when only its result tells.

        A source that knows it beforehand lets the simulation go on while the worker computes.

        Parameters
        ----------
        lasted_ns
            Time since the begin of what the step works on, such as a call, in ns; None if that
            was of one instant.
        """
        ...

    def settled_ns(self, compute_s: float, outputs: int) -> int:
        """Return the latency of a step whose result is there; asked where `known_ns` is None."""
        ...


class KnownBeforehand:
    """Base class of the sources that know each latency before its step."""

    def settled_ns(self, compute_s: float, outputs: int) -> int:
        """Raise: `known_ns` has told."""
        raise NotImplementedError


class Measured:
    """The worker's own compute time on this machine."""

    def known_ns(self, seq: int, lasted_ns: int | None = None) -> int | None:  # noqa: ARG002
        """Return None: only the step itself can tell."""
        return None

    def settled_ns(self, compute_s: float, outputs: int) -> int:  # noqa: ARG002
        """Return the compute time."""
        return seconds_to_ns(compute_s)


@dataclass(frozen=True)
class OnOutput:
    """The same latency for every step that gives something, and none for the others."""

    latency_ns: int

    def known_ns(self, seq: int, lasted_ns: int | None = None) -> int | None:  # noqa: ARG002
        """Return None: only the result can tell."""
        return None

    def settled_ns(self, compute_s: float, outputs: int) -> int:  # noqa: ARG002
        """Return the latency if there are outputs."""
        return self.latency_ns if outputs else 0


@dataclass(frozen=True)
class Fixed(KnownBeforehand):
    """The same latency for every step."""

    latency_ns: int

    def known_ns(self, seq: int, lasted_ns: int | None = None) -> int | None:  # noqa: ARG002
        """Return the latency."""
        return self.latency_ns


class Lognormal(KnownBeforehand):
    """A latency drawn for each step; equal for equal seed, worker and step number."""

    def __init__(self, worker: str, seed: int, median_s: float, sigma: float) -> None:
        self._worker = worker
        self._seed = seed
        self._median_s = median_s
        self._sigma = sigma

    def known_ns(self, seq: int, lasted_ns: int | None = None) -> int | None:  # noqa: ARG002
        """Return the latency drawn for step ``seq``."""
        return _lognormal_ns(self._worker, self._seed, seq, self._median_s, self._sigma)


class SinceStart(KnownBeforehand):
    """A time drawn for each step that counts from the start of what the step works on.

    A time of 6 s leaves 2 s to recognise a call that has lasted 4 s, and at least `LEAST_NS` in any
    case. An input of one instant takes no time.

    Parameters
    ----------
    mean_s
        Mean of the lognormal distribution of the times, in s.
    """

    def __init__(self, worker: str, seed: int, mean_s: float) -> None:
        self._worker = worker
        self._seed = seed
        self._median_s = mean_s * math.exp(-(SPREAD**2) / 2.0)

    def known_ns(self, seq: int, lasted_ns: int | None = None) -> int | None:
        """Return what of the time drawn for step ``seq`` has not passed yet."""
        if lasted_ns is None:
            return 0
        drawn_ns = _lognormal_ns(self._worker, self._seed, seq, self._median_s, SPREAD)
        return max(drawn_ns - lasted_ns, LEAST_NS)


def _lognormal_ns(worker: str, seed: int, seq: int, median_s: float, sigma: float) -> int:
    draw = stream(seed, f"latency/{worker}", seq).standard_normal()
    return seconds_to_ns(median_s * math.exp(sigma * draw))


class Replay(KnownBeforehand):
    """The latencies of an earlier run.

    Parameters
    ----------
    breaks_off
        True if the earlier run broke off: steps that it did not reach never end.

    Raises
    ------
    AirhiltError
        In `known_ns`: the earlier run had no such step, so the two have diverged.
    """

    def __init__(self, worker: str, latencies_ns: Mapping[int, int], breaks_off: bool) -> None:
        self._worker = worker
        self._latencies_ns = latencies_ns
        self._breaks_off = breaks_off

    def known_ns(self, seq: int, lasted_ns: int | None = None) -> int | None:  # noqa: ARG002
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


Kind = Literal["measured", "fixed", "lognormal", "since_start", "on_output", "replay"]
"""Kinds of latency sources, as the command line spells them."""
WITH_TIME = ("fixed", "lognormal", "since_start", "on_output")
"""Kinds that take a time in s."""
WITHOUT_TIME = ("measured", "fixed", "lognormal")
"""Kinds that may stand without one."""


@dataclass(frozen=True)
class LatencySpec:
    """The latency source of a run; `source` makes that of one worker.

    Attributes
    ----------
    given_s
        Latency of each step, or the median of those drawn (the mean since the start), in place of
        what a worker declares.
    stages
        Sources of single stages, by name; the others have this one.
    of_users
        Source of what the user brings, such as a worker in another process; None: this one.
    """

    kind: Kind
    given_s: float | None = None
    replay_of: str | None = None
    recorded: Mapping[str, Mapping[int, int]] | None = None
    breaks_off: bool = False
    stages: Mapping[str, LatencySpec] = field(default_factory=dict)
    of_users: LatencySpec | None = None

    @property
    def text(self) -> str:
        """Spelling on the command line."""
        if self.kind == "replay":
            return f"replay:{self.replay_of}"
        return ",".join(
            [self.own_text, *(f"{stage}={each.text}" for stage, each in self.stages.items())]
        )

    @property
    def own_text(self) -> str:
        """Kind, with its time if one was given, without the sources of single stages."""
        return self.kind if self.given_s is None else f"{self.kind}:{self.given_s:g}"

    def of(self, stage: str, is_of_user: bool = False) -> LatencySpec:
        """Return the latency source of a stage, such as ``asr``.

        Parameters
        ----------
        is_of_user
            True if the user brings the worker, or the engine that it is made of.
        """
        others = self.of_users if is_of_user and self.of_users else self
        return self.stages.get(stage, others)

    def source(self, worker: str, seed: int, median_s: float, sigma: float) -> LatencySource:
        """Return the source for a worker that declares ``median_s`` and ``sigma``."""
        median_s = median_s if self.given_s is None else self.given_s
        match self.kind:
            case "measured":
                return Measured()
            case "fixed":
                return Fixed(seconds_to_ns(median_s))
            case "lognormal":
                return Lognormal(worker, seed, median_s, sigma)
            case "since_start":
                return SinceStart(worker, seed, median_s)
            case "on_output":
                return OnOutput(seconds_to_ns(median_s))
            case "replay":
                recorded = (self.recorded or {}).get(worker, {})
                return Replay(worker, recorded, self.breaks_off)


DEFAULT = LatencySpec("fixed", of_users=LatencySpec("measured"))
"""Latency source unless one is given.

What AIRHILT brings has the same times on every machine, and what a user brings is timed.
"""


def parse_latency(text: str | None, presets: Mapping[str, str] | None = None) -> LatencySpec:
    """Return the latency source that a text such as ``fixed,asr=lognormal:5.9`` says.

    One source is for the stages that are not named; without it they have `DEFAULT`, and so have all
    stages if the text is None. The recorded latencies of ``replay:RUN`` are for the caller to fill
    in.

    Parameters
    ----------
    presets
        Texts by the names that may stand for them, in the place of the one source.

    Raises
    ------
    AirhiltError
        It is none of the sources, or a stage is named twice.
    """
    if text is None:
        return DEFAULT
    kind, _, argument = text.partition(":")
    if kind == "replay" and argument:
        return LatencySpec("replay", replay_of=argument)
    rest: list[LatencySpec] = []
    stages: dict[str, LatencySpec] = {}
    for part in text.split(","):
        stage, has_stage, said = part.strip().rpartition("=")
        if not has_stage and presets and said in presets:
            rest.append(parse_latency(presets[said]))
            continue
        spec = _parse_one(said, text)
        if not has_stage:
            rest.append(spec)
        elif not stage or stage in stages:
            raise _refused(text)
        else:
            stages[stage] = spec
    if len(rest) > 1:
        raise _refused(text)
    others = rest[0] if rest else DEFAULT
    return replace(others, stages={**others.stages, **stages})


def _parse_one(said: str, text: str) -> LatencySpec:
    """Return the source of one stage, a part of the text."""
    kind, has_time, argument = said.partition(":")
    if kind not in WITH_TIME or not has_time:
        if said not in WITHOUT_TIME:
            raise _refused(text)
        return LatencySpec(said)  # type: ignore[arg-type]
    try:
        seconds = float(argument)
    except ValueError:
        seconds = math.nan
    if not 0.0 <= seconds <= LONGEST_S:
        raise _refused(text)
    return LatencySpec(kind, given_s=seconds)  # type: ignore[arg-type]


def _refused(text: str) -> AirhiltError:
    return AirhiltError(
        f"latency {text!r}: expected measured, fixed, fixed:SECONDS (0 to {LONGEST_S:.0f}), "
        "lognormal, lognormal:MEDIAN, since_start:MEAN, on_output:SECONDS, paper or replay:RUN, "
        "and after it other ones for single stages, such as fixed,asr=lognormal:5.9,tts=fixed:0.9"
    )
