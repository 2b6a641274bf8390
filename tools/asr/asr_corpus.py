"""Made-up calls on aeronautical frequencies: texts for training and testing speech.

`Talk` draws calls with all that varies in them: who, where, which numbers, in which phraseology.
The forms are in ``asr_forms.txt``, plain English is in ``asr_english.txt``, and the commonest
English words, of which some calls have a few anywhere, are in ``asr_words.txt``. Texts are
lower-case words without punctuation except the apostrophe, as a transcript has them.
"""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Sequence
from functools import lru_cache
from pathlib import Path

from asr_callsigns import Callsigns
from asr_names import Names
from asr_said import Said, style_of
from asr_values import Values

HERE = Path(__file__).parent
FORMS = (HERE / "asr_forms.txt", HERE / "asr_english.txt")
UNITS = (
    "tower tower tower ground ground approach approach departure departure center centre control "
    "control radar director delivery information radio arrival final apron ramp clearance unicom"
).split()
TYPES = (
    "boeing|airbus|cessna|piper|citation|learjet|gulfstream|embraer|bombardier|dash eight|a t r|"
    "regional jet|heavy boeing|seven thirty seven|triple seven|seven four seven|seven eight seven|"
    "seven fifty seven|three twenty|three thirty|skyhawk|helicopter|twin cessna|heavy|seven six "
    "seven|seven three seven|boeing seven three seven|boeing seven seventy seven|dreamliner|"
    "airbus three twenty|airbus a three eighty|three fifty|three nineteen|three twenty one|"
    "a three twenty|neo|max|crj|c r j|r j|erj|e jet|embraer one seventy five|king air|pilatus|"
    "caravan|cirrus|challenger|falcon|phenom|md eleven|m d eleven|super|company|company traffic|"
    "cherokee|bonanza|baron|glider|ultralight|experimental|warbird|twin|jet|hawker|saab|fokker|"
    "blackhawk|chinook|hercules|c one thirty|fighter|flight of two|light aircraft|business jet|"
    "robinson|diamond|balloon|drone|tug|truck|vehicle|sweeper|snow plow|follow me"
).split("|")
ANIMALS = (
    "deer|deer|coyote|coyotes|fox|dog|dogs|geese|birds|gulls|flock of birds|flock of geese|animal|"
    "a deer|a fox|a dog|a coyote|seagulls|hawk|large bird|large birds|flock of starlings|pigeons|"
    "rabbit|hare|turtle|cow|sheep|moose|bear|wild boar|vulture|eagle|crows|herons|cat|several deer"
).split("|")
POINTS = "north south east west northeast northwest southeast southwest".split()
GREETINGS = (
    "good morning|good afternoon|good evening|good day|hello|hi|morning|afternoon|evening|hey|"
    "bonjour|guten tag|buenos dias|buongiorno|hello again|happy new year|greetings|gruezi|moin"
).split("|")
FAREWELLS = (
    "good day|bye|bye bye|have a good one|have a good flight|see you|so long|thanks|thank you|"
    "good night|have a nice day|ciao|cheers|safe flight|take care|thanks for the help|see ya|"
    "thank you sir|thank you maam|au revoir|auf wiedersehen|adios|tschuss|have a good night"
).split("|")
FILLERS = "uh uh uh um um er ah uhm hmm erm and so okay well like".split()
TURNS = (
    "correction|correction|negative|i say again|break|break break|disregard|correction i say again|"
    "sorry|no|disregard that|rather|make that|excuse me|actually"
).split("|")

UNEXPECTED_SHARE = 0.12
"""Share of the calls with words from anywhere in English."""
LONGEST = 45
"""Most words of a call before unexpected ones and hesitations."""
_WEIGHT = re.compile(r"([0-9]+): ")
_CHOICE = re.compile(r"\(([^()]*)\)")
_VARIABLE = re.compile(r"\{(\w+)\}")


@lru_cache(maxsize=1)
def forms() -> dict[str, list[str]]:
    """Return the forms of calls by their kind, each as often as its weight."""
    found: dict[str, list[str]] = {}
    kind = ""
    for path in FORMS:
        for line in path.read_text(encoding="utf-8").splitlines():
            if line.startswith("["):
                kind = line.strip("[]")
            elif line and not line.startswith("#"):
                weight = _WEIGHT.match(line)
                form = line[weight.end() :] if weight else line
                found.setdefault(kind, []).extend([form] * (int(weight[1]) if weight else 1))
    return found


@lru_cache(maxsize=1)
def common_words() -> tuple[str, ...]:
    """Return the commonest English words."""
    lines = (HERE / "asr_words.txt").read_text(encoding="utf-8").splitlines()
    return tuple(word for line in lines if not line.startswith("#") for word in line.split())


class Talk:
    """Draws calls.

    Parameters
    ----------
    held_out
        True for the names of places and fixes that no training text has.

    Attributes
    ----------
    callsign_of_call
        Callsign of the last `call`, as on a flight strip; None if it names nobody.
    """

    def __init__(self, rng: random.Random, *, held_out: bool = False) -> None:
        self.callsign_of_call: str | None = None
        self._rng = rng
        self._values = values = Values(rng)
        self._names = names = Names(rng, held_out=held_out)
        self._callsigns = Callsigns(rng, values)
        self._said = Said(rng, names)
        self._who = self.callsign()
        self._forms = forms()
        self._variables: dict[str, Callable[[], str]] = {
            "callsign": self.callsign, "station": self.station, "procedure": self.procedure,
            "airway": self.airway, "spelledfix": self.spelled_fix,
            "who": lambda: self._who,
            "place": names.place, "fix": names.fix, "waypoint": names.waypoint,
            "unit": lambda: rng.choice(UNITS),
            "type": lambda: rng.choice(TYPES),
            "animal": lambda: rng.choice(ANIMALS),
            "point": lambda: rng.choice(POINTS),
            "digits3": lambda: values.digits(rng.randint(10, 410)),
            "number2": lambda: values.number(rng.randint(2, 99)),
            "said_instruction": lambda: self._spoken(readback=False),
            "said_readback": lambda: self._spoken(readback=True),
        }  # fmt: skip

    # --- what varies in a form -------------------------------------------------------------

    def callsign(self) -> str:
        """Return how somebody is called."""
        return self._callsigns.draw()

    def station(self) -> str:
        """Return a controller's position."""
        unit = self._rng.choice(UNITS)
        return unit if self._rng.random() < 0.25 else f"{self._names.place()} {unit}"

    def procedure(self) -> str:
        """Return a standard departure or arrival (ICAO Annex 11, appendix 3)."""
        number = self._values.digit(self._rng.randint(1, 9))
        letter = f" {self._values.letter()}" if self._values.style == "icao" else ""
        name = self._names.fix() if self._rng.random() < 0.6 else self._names.place()
        return f"{name} {number}{letter}"

    def airway(self) -> str:
        """Return an airway."""
        letter = self._rng.choice(("j", "q", "v", "t", "victor", "lima", "mike", "uniform lima"))
        return f"{letter} {self._values.number(self._rng.randint(1, 999))}"

    def spelled_fix(self) -> str:
        """Return a fix with its letters."""
        name = self._names.fix()
        return f"{name} {self._rng.choice(('', 'that is', 'spelled'))} {self._values.spelled(name)}"

    def _spoken(self, *, readback: bool) -> str:
        return self._said.instruction(style=style_of(self._values.style), readback=readback)

    # --- whole calls -----------------------------------------------------------------------

    def say(self, kind: str) -> str:
        """Return a form of a kind with its choices made and its variables drawn."""
        form = self._rng.choice(self._forms[kind])
        while "(" in form:
            form = _CHOICE.sub(lambda choice: self._rng.choice(choice[1].split("|")), form)
        return " ".join(_VARIABLE.sub(lambda name: self._drawn(name[1]), form).split())

    def _drawn(self, name: str) -> str:
        if name in self._forms:
            return self.say(name)
        draw = self._variables.get(name)
        return draw() if draw else str(getattr(self._values, name)())

    def salad(self, words: Sequence[str]) -> str:
        """Return words that make no sense together."""
        return " ".join(self._rng.choices(words, k=self._rng.randint(2, 9)))

    def call(self) -> str:
        """Return a call of any kind."""
        rng, kind = self._rng, self._rng.random()
        self._values.begin()
        who = self._who = self._callsigns.draw()
        callsign = self._callsigns.strip
        text = " ".join(" ".join(self._parts(kind, who)).split())
        while len(text.split()) > LONGEST:
            text = " ".join(" ".join(self._parts(kind, who)).split())
        self.callsign_of_call = callsign if who in text else None
        if rng.random() < UNEXPECTED_SHARE:
            text = self._with_unexpected(text, who)
        return self._hesitating(text) if rng.random() < 0.16 else text

    def _parts(self, kind: float, who: str) -> list[str]:
        """Return the parts of a call of a kind in [0, 1), by or to somebody."""
        rng = self._rng
        if kind < 0.33:
            station = self.station() if rng.random() < 0.2 else ""
            extra = self.say("traffic") if rng.random() < 0.2 else ""
            return [who, station, self._greeting(0.06), self._several("instruction"), extra]
        if kind < 0.56:
            first = rng.choice(("", "", "", "roger", "okay", "and", "copy", "wilco", "alright"))
            return [first, self._several("readback"), who, self._farewell(0.08)]
        if kind < 0.63:
            return [who, self.say("traffic")]
        if kind < 0.75:
            station = self.station()
            first = rng.choice(
                (f"{station} {who}", f"{station} {who}", who, f"tower {who}", "tower")
            )
            return [first, self._greeting(0.2), self.say("report")]
        if kind < 0.81:
            return [self.say("report"), who, self._farewell(0.08)]
        if kind < 0.85:
            return [who, self.say("instruction"), rng.choice(TURNS), self.say("instruction")]
        if kind < 0.885:
            return [self.say("advisory")]
        if kind < 0.91:
            return [self._several("instruction")]
        if kind < 0.93:
            return [rng.choice((f"{self.station()} {who}", f"{who} {self.station()}", who)),
                    self._greeting(0.4)]  # fmt: skip
        if kind < 0.955:
            return [self.say("atis")]
        return [who if rng.random() < 0.15 else "", self.say("english")]

    def _several(self, kind: str) -> str:
        count = self._rng.choices((1, 2, 3), (0.66, 0.29, 0.05))[0]
        return " ".join(self.say(kind) for _ in range(count))

    def _greeting(self, share: float) -> str:
        return self._rng.choice(GREETINGS) if self._rng.random() < share else ""

    def _farewell(self, share: float) -> str:
        return self._rng.choice(FAREWELLS) if self._rng.random() < share else ""

    def _with_unexpected(self, text: str, who: str) -> str:
        """Return a call with a few words more, or instead of one, but none in its callsign."""
        rng = self._rng
        before, name, after = text.partition(who)
        parts = [before.split(), after.split()]
        words = parts[rng.random() < 0.6]
        at = rng.randrange(len(words) + 1)
        words[at : at + (rng.random() < 0.5)] = rng.choices(common_words(), k=rng.randint(1, 4))
        return " ".join([*parts[0], *filter(None, [name]), *parts[1]])

    def _hesitating(self, text: str) -> str:
        """Return a call with a filler, or with words that are said again."""
        rng, words = self._rng, text.split()
        for _ in range(rng.choice((1, 1, 2))):
            at = rng.randrange(len(words) + 1)
            if rng.random() < 0.7:
                words.insert(at, rng.choice(FILLERS))
            else:
                begin = max(0, at - rng.randint(1, 3))
                filler = [rng.choice(FILLERS)] if rng.random() < 0.4 else []
                words[at:at] = [*filler, *words[begin:at]]
        return " ".join(words)
