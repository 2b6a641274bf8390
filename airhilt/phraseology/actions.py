"""All forms of actions, by their first words."""

from __future__ import annotations

from airhilt.phraseology import (
    approaches,
    circuit,
    expectations,
    ground,
    lateral,
    questions,
    runways,
    speeds,
    surveillance,
    vertical,
)
from airhilt.phraseology.forms import Form
from airhilt.phraseology.patterns import LatePattern

_SUBJECTS = (
    questions.FORMS, expectations.FORMS, circuit.FORMS, vertical.CROSSINGS, runways.FORMS,
    approaches.FORMS, ground.FORMS, surveillance.FORMS, speeds.FORMS, lateral.FORMS, vertical.FORMS,
)  # fmt: skip
"""Forms in their order: the first that fits is taken."""


def _by_first_word() -> dict[str, tuple[Form, ...]]:
    forms: dict[str, list[Form]] = {}
    for subject in _SUBJECTS:
        for words, action, pattern, build in subject:
            form = Form(action, LatePattern(rf"{pattern}(?!\S)"), build)
            for word in words.split():
                forms.setdefault(word, []).append(form)
    return {word: tuple(listed) for word, listed in forms.items()}


FORMS = _by_first_word()
"""Forms of actions, by their first words."""
NUMBER_FORMS: dict[str, tuple[Form, ...]] = {
    "decimal": (surveillance.FREQUENCY_FORM,),
    "knots": (speeds.KNOTS_FORM,),
    "on": (speeds.ON_SPEED_FORM, lateral.ON_HEADING_FORM),
    **dict.fromkeys(("or", "to", "until"), (speeds.LIMITED_FORM,)),
}
"""Forms that begin with a number, by the word behind it."""
