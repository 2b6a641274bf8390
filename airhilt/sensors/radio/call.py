"""A call from its first word until it is taken, or given up."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from airhilt.scenario.conversation import needed_lines
from airhilt.scenario.failures import EffectiveLine
from airhilt.scenario.models import RadioLine, Scenario, ScriptedCommand


@dataclass(eq=False)
class RadioCall:
    """One call, which may have to be made again, and who has taken it."""

    id: str
    frequency_khz: int
    speaker: str
    addressed: str | None
    text: str
    commands: tuple[ScriptedCommand, ...] = ()
    in_reply_to: RadioCall | None = None
    is_repeated: bool = True
    """Whether it is made again if nobody answers."""
    scripted: EffectiveLine | None = None
    asks_for: RadioCall | None = None
    """The call that it asks to be made again."""
    answer: RadioCall | None = None
    """What its addressee says once he has taken it."""
    needs: tuple[RadioCall | None, ...] = ()
    """What its speaker must have taken before; None is never said."""
    times_said: int = 0
    is_due_again: bool = False
    withdrawn_for: set[str] = field(default_factory=set)
    """Who will not do any more what he has not done of it yet."""
    taken_by: set[str] = field(default_factory=set)
    _then: dict[str, list[Callable[[], None]]] = field(default_factory=dict)

    @property
    def deaf(self) -> frozenset[str]:
        """Who does not take it, as the scenario has it; said again, nobody is."""
        if self.scripted is None or self.times_said > 1:
            return frozenset()
        return self.scripted.deaf

    @property
    def said(self) -> str:
        """Its words, as they are said this time."""
        return self.text if self._put_right is None else self._put_right.text

    @property
    def meant(self) -> tuple[ScriptedCommand, ...]:
        """What those do who take it as it is said this time."""
        return self.commands if self._put_right is None else self._put_right.commands

    @property
    def _put_right(self) -> RadioLine | None:
        """As it should have been, if it is made again after it went to the wrong actor."""
        if self.scripted is None or not self.scripted.deaf or self.times_said <= 1:
            return None
        return self.scripted.declared

    @property
    def is_first_time(self) -> bool:
        """Whether it is on the air, or was, for the first time."""
        return self.times_said == 1

    def recipients(self) -> list[str]:
        """Return for whom it still is: its addressee, and who does something on it."""
        names = (self.addressed, *(scripted.actor for scripted in self.meant))
        return [
            name
            for name in dict.fromkeys(names)
            if name is not None and name != self.speaker and name not in self.taken_by
        ]

    def once_taken_by(self, name: str, action: Callable[[], None]) -> None:
        """Call something as soon as somebody has taken it."""
        self._then.setdefault(name, []).append(action)

    def take(self, name: str) -> None:
        """Count somebody among those who have taken it."""
        self.taken_by.add(name)
        for action in self._then.pop(name, ()):
            action()


def calls_of(scenario: Scenario, lines: Sequence[EffectiveLine]) -> dict[str, RadioCall]:
    """Return the calls of the lines that are said, by their ids."""
    found = {
        happening.declared.id: RadioCall(
            happening.line.id,
            happening.line.frequency_khz,
            happening.line.speaker,
            happening.line.to,
            happening.line.text,
            happening.line.commands,
            scripted=happening,
        )
        for happening in lines
        if happening.line is not None
    }
    needed = needed_lines(scenario)
    needed_by_others = {name for names in needed.values() for name in names}
    for name, call in found.items():
        call.needs = tuple(found.get(other) for other in needed[name])
        call.in_reply_to = next(iter(call.needs), None)
        has_orders = any(scripted.actor != call.speaker for scripted in call.commands)
        call.is_repeated = not call.needs or has_orders or name in needed_by_others
    return found
