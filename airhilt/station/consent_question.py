"""The question to a participant, before the first trial, what of voice and words may be used."""

from __future__ import annotations

from airhilt.messages import Use
from airhilt.station.questionnaires import Answers, Choice, Questionnaire

USES: dict[str, Use | None] = {
    "Voice and typed words": "voice",
    "Typed words alone": "words",
    "Neither: ask me at the seat": None,
}
"""Uses by the choices of the question."""
_KEPT = {
    True: "Your voice is recorded as sound, and as text.",
    False: "The sound of your voice is not recorded. Its words are, as they were recognised.",
}


def consent_question(*, is_recorded: bool) -> Questionnaire:
    """Return the question for trials in which voices are recorded, or are not."""
    text = (
        "What you say while you hold the button at your seat is recognised, everybody in the run "
        f"hears it, and its programs get it. {_KEPT[is_recorded]} What you type is said to "
        "everybody, and kept as text. What you do at the seat, and what it shows you, is logged. "
        "What of yours may be used?"
    )
    name = "consent" if is_recorded else "consent_unrecorded"
    return Questionnaire(
        name, (Choice(type="choice", name="use", question=text, choices=tuple(USES)),)
    )


def use_of(answers: Answers | None) -> Use | None:
    """Return to what a participant has agreed; None: to nothing yet."""
    return USES.get(str((answers or {}).get("use")))


def least_use(*uses: str | None) -> Use | None:
    """Return to what somebody agrees who gave several answers; None, ``none``: to nothing."""
    if all(use == "voice" for use in uses):
        return "voice"
    return "words" if all(use in ("voice", "words") for use in uses) else None
