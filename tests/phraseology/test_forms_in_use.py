"""The forms that controllers and pilots use are read, each with its values, and nothing else."""

from __future__ import annotations

from pathlib import Path

from airhilt.phraseology import CLEARANCES, TAU_ASR, Call, Instruction, parse_call

KNOWN = ("DAL88", "AAL123", "N172SP", "UAL2243")
LISTED = tuple(
    Path(__file__).parent / name
    for name in ("forms_in_use.txt", "forms_of_busy_days.txt", "forms_less_often_heard.txt")
)


LOST_UNSEEN = frozenset(
    {"not", "don't", "did", "you", "was", "that", "plan", "told", "ready", "anticipate", "once",
     "after", "behind"}
)  # fmt: skip
"""Words whose loss nobody could tell."""


def forms() -> list[tuple[str, list[str]]]:
    """Return the calls of the lists, and what each says."""
    read = []
    for line in (line for path in LISTED for line in path.read_text().splitlines()):
        speaker, _, rest = line.partition(" ")
        if speaker not in ("c", "p"):
            continue
        words, _, truth = rest.partition("=")
        name = "delta eighty eight"
        text = f"{name} {words}" if speaker == "c" else f"{words} {name}"
        read.append(
            (" ".join(text.split()), sorted(filter(None, map(str.strip, truth.split(";")))))
        )
    return read


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
    ]  # fmt: skip
    return " ".join(part for part in parts if part)


def all_of(call: Call) -> list[str]:
    return sorted(
        [in_words(each) for each in call.instructions]
        + [in_words(each, "expect") for each in call.expected]
    )


def test_the_forms_in_use_are_read_as_they_are_meant() -> None:
    misread = {}
    for text, truth in forms():
        call = parse_call(text, KNOWN)
        if call.callsign != "DAL88" or all_of(call) != truth:
            misread[text] = (call.callsign, all_of(call), truth)
    assert misread == {}


def test_a_word_that_is_lost_from_such_a_form_makes_no_other_clearance() -> None:
    """Sides and conditions apart, of which nobody could tell that they are lost."""
    for text, truth in forms():
        words = text.split()
        given = {" ".join(each.split()[:1]) for each in truth}
        for at in range(3, len(words)):
            if words[at] in LOST_UNSEEN:
                continue
            rest = " ".join([*words[:at], *words[at + 1 :]])
            made = {
                each.action
                for each in parse_call(rest, KNOWN).instructions
                if each.action in CLEARANCES
                and each.condition is None
                and each.confidence >= TAU_ASR
            }
            assert made <= given, rest
