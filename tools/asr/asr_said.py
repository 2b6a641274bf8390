"""Instructions in the words of the project's own speakers (`airhilt.phraseology.say`).

So each form that a controller, a crew or an advisory of a run can speak is in the corpus.
"""

from __future__ import annotations

import random
import re
from typing import get_args

from airhilt.phraseology.call import Action, Bound, Instruction, Turn
from airhilt.phraseology.numbers import Style
from airhilt.phraseology.spoken_actions import phrase_of
from asr_names import Names

ACTIONS: tuple[Action, ...] = get_args(Action)
APPROACHES = "ils rnav rnp vor gps ndb lda sdf gls par sra visual localizer contact".split()
SIDES: tuple[Turn | None, ...] = ("left", "right", None)
BOUNDS: tuple[Bound | None, ...] = ("or_more", "or_less", None, None)
UNITS = "Tower Ground Approach Departure Center Centre Control Radar Director Delivery".split()
REPORTS = (
    "final", "established", "ready for departure", "runway in sight", "runway vacated", "downwind",
    "traffic in sight", "passing flight level 100", "the field in sight",
)  # fmt: skip
THINGS = ("the Boeing", "the Airbus", "the company 737", "the Cessna", "the follow me", "traffic")
CONDITIONS = (
    "after departure", "when airborne", "behind the landing Boeing", "after the landing Airbus",
    "when able", "after passing {fix}", "when ready", "after the departing Cessna", "at {fix}",
    "behind the departing Embraer", "when established on the localizer", "once airborne",
)  # fmt: skip
LIMITS = ("until {fix}", "until established", "until 5 miles final", "until further advised")


def transcript(text: str) -> str:
    """Return a spoken text as a transcript has it: lower case, without punctuation."""
    return " ".join(re.findall(r"[a-z]+(?:'[a-z]+)?", text.lower()))


class Said:
    """Draws instructions with details of every kind, and speaks them."""

    def __init__(self, rng: random.Random, names: Names) -> None:
        self._rng = rng
        self._names = names

    def instruction(self, *, style: Style, readback: bool) -> str:
        """Return one instruction, or its readback."""
        return transcript(phrase_of(self.draw(), style, readback=readback))

    def draw(self) -> Instruction:
        """Return an instruction of any action, with details."""
        rng = self._rng
        action = rng.choice(ACTIONS)
        return Instruction(
            action,
            runway=self._runway() if rng.random() < 0.8 else None,
            position=self._position(action),
            via=tuple(self._taxiway() for _ in range(rng.randint(0, 3))),
            hold_short=self._taxiway() if rng.random() < 0.5 else None,
            turn=rng.choice(SIDES),
            turn_deg=float(rng.randint(1, 18) * 5),
            heading_deg=float(rng.randint(1, 72) * 5) if rng.random() < 0.85 else None,
            altitude_ft=float(rng.randint(5, 410) * 100),
            speed_kt=float(rng.randint(12, 34) * 10) if rng.random() < 0.85 else None,
            mach=rng.randint(70, 87) / 100.0,
            rate_fpm=float(rng.randint(5, 40) * 100),
            sense=rng.choice(("climb", "descend", "maintain", None)),
            bound=rng.choice(BOUNDS),
            named=rng.choice(("minimum clean", "maximum", "normal", "final approach", None)),
            approach=rng.choice(APPROACHES),
            variant=rng.choice((None, None, "Y", "Z", "W")),
            squawk="".join(str(rng.randint(0, 7)) for _ in range(4)),
            frequency_khz=rng.randint(118_000 // 5, 136_990 // 5) * 5,
            immediate=rng.random() < 0.15,
            condition=self._with_fix(rng.choice(CONDITIONS)) if rng.random() < 0.12 else None,
            until=self._with_fix(rng.choice(LIMITS)) if rng.random() < 0.08 else None,
        )

    def _runway(self) -> str:
        return f"{self._rng.randint(1, 36):02d}{self._rng.choice(('', '', 'L', 'R', 'C'))}"

    def _taxiway(self) -> str:
        number = self._rng.choice(("", "", str(self._rng.randint(1, 12))))
        return f"{self._rng.choice('ABCDEFGHJKLMNPQRSTUVWYZ')}{number}"

    def _position(self, action: Action) -> str | None:
        rng = self._rng
        if action in ("contact", "monitor"):
            return f"{self._names.place()} {rng.choice(UNITS)}"
        if action in ("direct", "hold_at", "cross_fix"):
            return self._names.waypoint()
        if action in ("climb_via", "descend_via"):
            return f"{self._names.fix()} {rng.randint(1, 9)}"
        if action in ("follow", "give_way"):
            return rng.choice(THINGS)
        if action == "report":
            return rng.choice(REPORTS)
        if action == "heading":
            return rng.choice(("present heading", "runway heading"))
        return self._taxiway() if rng.random() < 0.3 else None

    def _with_fix(self, words: str) -> str:
        return words.format(fix=self._names.waypoint())


def style_of(style: str) -> Style:
    """Return the style of the project's speakers for a style of the corpus."""
    return "icao" if style == "icao" else "faa"
