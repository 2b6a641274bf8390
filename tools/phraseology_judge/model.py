"""A radio call, and what is true of it.

A `Call` is one line of the corpus. Its `Item`s are what the call instructs, reads back or reports.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any, Literal

Status = Literal[
    "now", "conditional", "expected", "readback", "request", "report", "information", "withdrawn"
]
Value = int | float | str | dict[str, Any] | None


@dataclass(frozen=True)
class Item:
    """One instruction, readback, request, report or piece of information.

    Attributes
    ----------
    kind
        A word of the vocabulary in the README.
    value
        The value in `unit`, or the name of a runway, fix or procedure.
    unit
        The unit of `value`; None for names.
    status
        The part that the item plays in the call.
    manner
        The way in which it is done, such as "left" or "climb"; None where it was not said.
    begins
        The event before which the item does not apply; None where it applies at once.
    ends
        The event after which the item applies no more; None where none was said.
    """

    kind: str
    value: Value = None
    unit: str | None = None
    status: Status = "now"
    manner: str | None = None
    begins: str | None = None
    ends: str | None = None

    def read_back(self) -> Item:
        """Return the item as a pilot reads it back."""
        if self.status in ("report", "request"):
            return self
        if self.status == "expected":
            return replace(self, status="readback", begins="expected")
        return replace(self, status="readback")


@dataclass(frozen=True)
class Phrase:
    """Words of a call with the items in them, and the section of the document."""

    text: str
    items: tuple[Item, ...]
    source: str


@dataclass(frozen=True)
class Exchange:
    """An instruction, and the readbacks that pilots give to it, shorter ones included."""

    instruction: Phrase
    readbacks: tuple[Phrase, ...]


@dataclass(frozen=True)
class Call:
    """One radio call as a recogniser writes it, and its truth.

    Attributes
    ----------
    text
        The words: lower case, no punctuation, numbers as spoken.
    roster
        The call signs on the frequency, in ICAO form.
    speaker
        The speaker, "controller" or "pilot".
    callsign
        The aircraft addressed or speaking; None where the call does not name it.
    items
        The items of the call.
    source
        The documents and sections of the phrases.
    said
        The words before recognition errors; None where there are no errors.
    """

    text: str
    roster: tuple[str, ...]
    speaker: Literal["controller", "pilot"]
    callsign: str | None
    items: tuple[Item, ...]
    source: str
    said: str | None = None

    def as_json(self) -> dict[str, Any]:
        """Return the published form of the call."""
        line = asdict(self)
        if self.said is None:
            del line["said"]
        return line


ROGER = ("roger", (Item("roger", status="report"),))
"""Words and items of an answer that reads nothing back."""


def exchange(
    source: str, text: str, items: Item | tuple[Item, ...], *readbacks: str | tuple[str, Item]
) -> Exchange:
    """Return an exchange whose readbacks repeat all items, or the one item given with them.

    Parameters
    ----------
    source
        The document and section.
    text
        The words of the controller.
    items
        The items of the instruction.
    readbacks
        The words of readbacks; the items of the instruction apply where a text stands alone.
        "roger" stands alone where there is none.
    """
    said = items if isinstance(items, tuple) else (items,)
    answers = []
    for each in readbacks:
        if isinstance(each, str):
            answers.append(Phrase(each, tuple(item.read_back() for item in said), source))
        else:
            answers.append(Phrase(each[0], (each[1].read_back(),), source))
    return Exchange(Phrase(text, said, source), tuple(answers) or (Phrase(*ROGER, source),))


def information(kind: str, value: Value = None, unit: str | None = None) -> Item:
    """Return an item that asks for nothing."""
    return Item(kind, value, unit, "information")


def report(kind: str, value: Value = None, unit: str | None = None, **more: Any) -> Item:
    """Return an item that a pilot reports."""
    return Item(kind, value, unit, "report", **more)


def request(kind: str, value: Value = None, unit: str | None = None, **more: Any) -> Item:
    """Return an item that a pilot asks for."""
    return Item(kind, value, unit, "request", **more)
