"""Latency sources: what decides how long a step of a worker takes in simulation time."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from airhilt.errors import AirhiltError
from airhilt.sim.streams import stream
from airhilt.units import seconds_to_ns

NEVER_NS = seconds_to_ns(1e9)
"""Latency of a step that never ends, in ns: longer than any run."""
LONGEST_S = 3600.0
"""Longest latency that may be given, in s."""
SPREAD = 0.1
"""Standard deviation of the logarithm of the times that ``since_start`` draws. An assumption: the
publication whose recogniser it stands for gives a mean and no spread."""
LEAST_NS = seconds_to_ns(0.1)
"""Least latency of ``since_start``, in ns: time of a step after the end of what it works on. An
assumption."""

Kind = Literal["measured", "fixed", "lognormal", "since_start", "on_output", "replay"]
"""Kinds of latency sources, as the command line spells them.

``measured`` is the worker's own compute time on this machine, ``fixed`` the same latency for every
step, ``on_output`` the same for every step that gives something and none for the others.
``lognormal`` is drawn for each step, equal for equal seed, worker and step number. ``since_start``
is drawn too, and counts from the start of what the step works on: a time of 6 s leaves 2 s to
recognise a call that has lasted 4 s, and at least `LEAST_NS` in any case; an input of one instant
takes no time. ``replay`` has the latencies of an earlier run.
"""
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
        """Return the latency source of a stage such as ``asr``, or of what a user brings for it."""
        others = self.of_users if is_of_user and self.of_users else self
        return self.stages.get(stage, others)

    def source(self, worker: str, seed: int, median_s: float, sigma: float) -> LatencySource:
        """Return the source for a worker that declares ``median_s`` and ``sigma``."""
        median_s = median_s if self.given_s is None else self.given_s
        return LatencySource(self, worker, seed, median_s, sigma)


@dataclass(frozen=True)
class LatencySource:
    """The latency of each step of one worker."""

    spec: LatencySpec
    worker: str
    seed: int
    median_s: float
    sigma: float

    def known_ns(self, seq: int, lasted_ns: int | None = None) -> int | None:
        """Return the latency of step ``seq``, or None when only its result tells.

        A source that knows it beforehand lets the simulation go on while the worker computes.
        ``lasted_ns`` is the time since the begin of what the step works on, such as a call; None
        if that was of one instant. An AirhiltError says that an earlier run that is replayed had
        no such step.
        """
        match self.spec.kind:
            case "measured" | "on_output":
                return None
            case "fixed":
                return seconds_to_ns(self.median_s)
            case "lognormal":
                return self._drawn_ns(seq, self.median_s, self.sigma)
            case "since_start":
                if lasted_ns is None:
                    return 0
                median_s = self.median_s * math.exp(-(SPREAD**2) / 2.0)
                return max(self._drawn_ns(seq, median_s, SPREAD) - lasted_ns, LEAST_NS)
            case "replay":
                return self._recorded_ns(seq)

    def settled_ns(self, compute_s: float, outputs: int) -> int:
        """Return the latency of a step whose result is there; asked where `known_ns` is None."""
        if self.spec.kind == "measured":
            return seconds_to_ns(compute_s)
        return seconds_to_ns(self.median_s) if outputs else 0

    def _drawn_ns(self, seq: int, median_s: float, sigma: float) -> int:
        draw = stream(self.seed, f"latency/{self.worker}", seq).standard_normal()
        return seconds_to_ns(median_s * math.exp(sigma * draw))

    def _recorded_ns(self, seq: int) -> int:
        """Return the latency that a step had in the earlier run; endless after it broke off."""
        latencies_ns = (self.spec.recorded or {}).get(self.worker, {})
        if seq in latencies_ns:
            return latencies_ns[seq]
        if self.spec.breaks_off:
            return NEVER_NS
        raise AirhiltError(
            f"latency replay: the recorded run has {len(latencies_ns)} steps of {self.worker!r}, "
            f"this run came to step {seq}: replay needs the same scenario, seed and workers"
        )


DEFAULT = LatencySpec("fixed", of_users=LatencySpec("measured"))
"""Latency source unless one is given.

What AIRHILT brings has the same times on every machine, and what a user brings is timed.
"""


def parse_latency(text: str | None, presets: Mapping[str, str] | None = None) -> LatencySpec:
    """Return the latency source that a text such as ``fixed,asr=lognormal:5.9`` says.

    One source is for the stages that are not named; without it they have `DEFAULT`, and so have all
    stages if the text is None. Presets are texts by names that may stand for the one source. The
    recorded latencies of ``replay:RUN`` are for the caller to fill in. An AirhiltError says that
    it is none of the sources, or a stage is named twice.
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
