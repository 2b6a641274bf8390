"""Calls as controllers and pilots say them, with what each of them says."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

from airhilt.phraseology import Call, Instruction, Speaker

CALLED = "delta eighty eight"
"""DAL88 as it is spoken in them."""
KNOWN = ("DAL88", "AAL123", "N172SP", "UAL2243")
LISTED = tuple(
    Path(__file__).parents[1] / "phraseology" / name
    for name in ("forms_in_use.txt", "forms_of_busy_days.txt", "forms_less_often_heard.txt")
)


class Form(NamedTuple):
    """A call of DAL88 or to it, and its instructions as `in_words` writes them."""

    text: str
    speaker: Speaker
    truth: list[str]

    @property
    def subject(self) -> str:
        """Action of the first instruction; ``nothing`` if there is none."""
        if not self.truth:
            return "nothing"
        return next(word for word in self.truth[0].split() if word not in ("later", "expect"))


@cache
def forms() -> tuple[Form, ...]:
    """Return the calls of the lists."""
    read = []
    for line in (line for path in LISTED for line in path.read_text().splitlines()):
        speaker, _, rest = line.partition(" ")
        if speaker not in ("c", "p"):
            continue
        words, _, truth = rest.partition("=")
        text = f"{CALLED} {words}" if speaker == "c" else f"{words} {CALLED}"
        said = sorted(filter(None, map(str.strip, truth.split(";"))))
        read.append(Form(" ".join(text.split()), "controller" if speaker == "c" else "pilot", said))
    return tuple(read)


def by_subject() -> dict[str, list[Form]]:
    """Return the calls of the lists by the action that comes first in them."""
    found: defaultdict[str, list[Form]] = defaultdict(list)
    for form in forms():
        found[form.subject].append(form)
    return dict(sorted(found.items()))


def in_words(said: Instruction, status: str = "") -> str:
    """Return an instruction as the list writes it."""
    units: dict[str, float | None] = {
        "ft": said.altitude_ft, "fpm": said.rate_fpm, "deg": said.turn_deg, "kt": said.speed_kt,
    }  # fmt: skip
    number = {unit: f"{value:g}{unit}" for unit, value in units.items() if value is not None}
    parts = [
        status or ("later" if said.is_conditional else None), said.action, said.runway,
        said.position, said.hold_short, " ".join(("via", *said.via)) if said.via else None,
        said.sense, number.get("ft"), said.bound, number.get("fpm"), said.turn,
        f"{said.heading_deg:g}" if said.heading_deg else None, number.get("deg"),
        number.get("kt"), said.named,
        f"{said.frequency_khz / 1000:.3f}" if said.frequency_khz else None, said.squawk,
        said.approach, said.variant, "now" if said.immediate else None,
        f"mach {said.mach:g}" if said.mach else None,
        f"[{said.condition}]" if said.condition else None,
        f"[{said.until}]" if said.until else None,
        f"~{said.confidence:.2g}" if said.confidence < 1.0 else None,
    ]  # fmt: skip
    return " ".join(part for part in parts if part)


def all_of(call: Call) -> list[str]:
    """Return what a call says as the list writes it, in order of its words."""
    return sorted(
        [in_words(each) for each in call.instructions]
        + [in_words(each, "expect") for each in call.expected]
        + [in_words(each.about, f"{each.asks}?") for each in call.asked]
        + [f"({each})" for each in _besides(call)]
    )


def _besides(call: Call) -> Iterator[str]:
    """Yield what a call says besides its instructions."""
    if call.kind not in ("instruction", "readback"):
        yield call.kind
    yield from call.traffic
    if call.wind is not None:
        gust = "" if call.wind.gust_kt is None else f" gusts {call.wind.gust_kt:g}"
        from_deg = call.wind.direction_deg
        direction = "variable" if from_deg is None else f"{from_deg:g}"
        yield f"wind {direction} at {call.wind.speed_kt:g}{gust}"
    if call.pressure_hpa is not None:
        yield f"{call.pressure_hpa:.1f} hPa"
    if call.position is not None:
        yield f"at {call.position}"
    yield from (
        name
        for name in ("distress", "urgency", "emergency_descent", "corrected", "negative")
        if getattr(call, name)
    )
