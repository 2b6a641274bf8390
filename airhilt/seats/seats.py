"""The state of all seats of a run, changed by what is done at them and by what the run asks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any

from airhilt.commands import Command
from airhilt.messages import (
    SHORTEST_SECRET,
    AgreeToUses,
    AnswerQuestion,
    CommandOffer,
    FlyCommand,
    LeaveSeat,
    Message,
    PressToTalk,
    ReleaseToTalk,
    SayText,
    SayVoice,
    SeatAct,
    SeatAction,
    SeatNotice,
    SeatState,
    SetPace,
    TakeSeat,
    TaskCard,
    TuneFrequencies,
    WorkloadQuestion,
    key_chunk,
)
from airhilt.sim import Director
from airhilt.sim.payload import Payload

PAUSED = "paused"
"""Name of the pace at which the time stands still."""
MOST_OFFERS = 5
"""Number of commands that are offered at a seat at a time: the newest."""


class Seats:
    """Knows the seats of a run, and publishes the state of each when it changes.

    Parameters
    ----------
    states
        States of the seats before anybody has come.
    """

    def __init__(
        self,
        states: Iterable[SeatState],
        publish: Callable[[str, SeatState], None],
        director: Director,
    ) -> None:
        self._states = {state.seat: state for state in states}
        self._names = {key_chunk(name): name for name in self._states}
        self._publish = publish
        self._director = director
        self._secrets: dict[str, str] = {}
        """Secret of the holder, by seat."""
        self._pressed: set[str] = set()
        """Seats whose transmit button is held."""
        self._gone: set[tuple[str, str]] = set()
        """Seats and holders whose tokens have ended."""
        self._offers = 0
        self._is_open = False

    def __iter__(self) -> Iterator[SeatState]:
        return iter(list(self._states.values()))

    def __bool__(self) -> bool:
        return bool(self._states)

    def open(self, **facts: Any) -> None:
        """Publish the states from now on, with fields that were not known before."""
        self._is_open = True
        for state in self:
            self._tell(state.model_copy(update=facts))

    # --- what is asked of them --------------------------------------------------------------

    def at(self, key: str) -> SeatState | None:
        """Return the state of the seat of a key, such as ``seat/AAL1/do``; None if it is none."""
        return self._states.get(self._names.get(key.split("/")[1], ""))

    def has_person(self, name: str) -> bool:
        """Return whether a person speaks and acts for a unit or an actor, and nobody else.

        A seat that nobody has taken yet waits for its person. One whose person has left is a part
        of the script again.
        """
        return name in self._states and self._states[name].phase != "left"

    def listens(self, name: str, frequency_khz: int) -> bool:
        """Return whether somebody listens to a frequency; all do but people who switch it off."""
        return name not in self._states or frequency_khz in self._states[name].tuned_khz

    def refusal(self, key: str, action: SeatAction) -> str:
        """Return why an act at the seat of a key is refused; empty if it is accepted."""
        state = self.at(key)
        if state is None:
            known = ", ".join(self._names) or "none: there is no --seat"
            return f"no seat of this run; expected {known}"
        if (state.seat, action.holder) in self._gone:
            return "the liveliness token of the holder has ended; declare another one"
        secret = self._secrets.get(state.seat)
        if isinstance(action.act, TakeSeat):
            if len(action.secret) < SHORTEST_SECRET:
                return f"the secret is too short; expected at least {SHORTEST_SECRET} characters"
            if secret not in (None, action.secret):
                return f"somebody has the seat {state.seat} already"
        elif secret is None:
            return f"nobody has the seat {state.seat}; take it first"
        elif (action.holder, action.secret) != (state.holder, secret):
            return f"somebody else has the seat {state.seat}"
        return self._why_not_now(state, action.act)

    def _why_not_now(self, state: SeatState, act: SeatAct) -> str:
        """Return why the holder of a seat may not do something now; empty if that is allowed."""
        match act:
            case TuneFrequencies(frequencies_khz=tuned) if set(tuned) - set(state.frequencies_khz):
                return "your seat does not have that frequency"
            case PressToTalk() | SayVoice() if "voice" not in state.uses:
                return "you have not agreed to the use of your voice"
            case PressToTalk() if state.pace == PAUSED:
                return "the run is paused; nobody hears you"
            case PressToTalk() if not state.has_sound:
                return "this run has no sound; type what you want to say"
            case SayVoice() if state.seat not in self._pressed:
                return "your call was cut"
            case SayText() if not state.uses:
                return "you have not agreed to the use of what you type"
            case FlyCommand() if state.category == "unit":
                return "the seat of a unit flies and drives nothing"
            case AnswerQuestion(question=number):
                open_number = None if state.question is None else state.question.number
                return (
                    "" if number == open_number else f"question {number} is not open at this seat"
                )
            case SetPace() if not state.may_pause:
                return "this run has no pause and no slow motion"
        return ""

    def ends_hold(self, key: str, holder: str) -> bool:
        """Return whether the end of a holder's token at the seat of a key ends the hold."""
        state = self.at(key)
        if state is None:
            return False
        self._gone.add((state.seat, holder))
        return state.holder == holder

    # --- what changes them ------------------------------------------------------------------

    def note_secret(self, key: str, action: SeatAction) -> None:
        """Keep the secret of who takes a seat; the act itself is logged without it."""
        state = self.at(key)
        if state is not None and isinstance(action.act, TakeSeat):
            self._secrets[state.seat] = action.secret

    def take(self, key: str, message: Message, data: Payload) -> None:  # noqa: ARG002
        """Take in an act that was accepted."""
        if not isinstance(message, SeatAction) or (state := self.at(key)) is None:
            return
        changes = self._changes_by(state, message)
        if changes:
            self._tell(state.model_copy(update=changes))

    def _changes_by(self, state: SeatState, action: SeatAction) -> dict[str, Any]:
        """Return the fields of a state that an act changes."""
        match action.act:
            case TakeSeat() if state.phase != "taken":
                return {"phase": "taken", "holder": action.holder, "notice": None}
            case TakeSeat():
                return {"holder": action.holder}
            case LeaveSeat():
                self._secrets.pop(state.seat, None)
                self._pressed.discard(state.seat)
                return {
                    "phase": "left",
                    "holder": None,
                    "uses": (),
                    "tuned_khz": state.frequencies_khz,
                    "offers": (),
                    "question": None,
                    "notice": self._notice(
                        f"Nobody is at the seat: the script of {state.seat} goes on by itself."
                    ),
                }
            case AgreeToUses(uses=uses):
                if "voice" not in uses:
                    self._pressed.discard(state.seat)
                return {"uses": tuple(sorted(set(uses)))}
            case TuneFrequencies(frequencies_khz=tuned):
                return {"tuned_khz": tuple(sorted(set(tuned)))}
            case PressToTalk():
                self._pressed.add(state.seat)
            case ReleaseToTalk():
                self._pressed.discard(state.seat)
            case AnswerQuestion():
                return {"question": None}
        return {}

    def add_task(self, name: str, card: TaskCard) -> None:
        """Tell the person at a seat that a call of the script is due."""
        self._change(name, tasks=(*self._states[name].tasks, card))

    def end_task(self, name: str, line: str) -> None:
        """Take away the card of a call that was made."""
        kept = tuple(card for card in self._states[name].tasks if card.line != line)
        self._change(name, tasks=kept)

    def offer(self, name: str, call: str, command: Command) -> None:
        """Offer the person at a seat a command of a call; an open offer of the same one is over."""
        self._offers += 1
        offer = CommandOffer(number=self._offers, call=call, command=command)
        others = (one for one in self._states[name].offers if one.command != command)
        self._change(name, offers=(*others, offer)[-MOST_OFFERS:])

    def end_offer(self, name: str, command: Command) -> None:
        """Take away the offer of a command that an actor carries out."""
        if name in self._states:
            left = tuple(one for one in self._states[name].offers if one.command != command)
            self._change(name, offers=left)

    def ask(self, name: str, question: WorkloadQuestion) -> None:
        """Ask the person at a seat; an earlier question has no answer then."""
        self._change(name, question=question)

    def notify(self, name: str, text: str) -> None:
        """Tell the person at a seat something in words; nothing if there is no such seat."""
        if name in self._states:
            self._change(name, notice=self._notice(text))

    def _notice(self, text: str) -> SeatNotice:
        return SeatNotice(told_ns=self._director.now_ns, text=text)

    def cut(self, name: str, text: str) -> None:
        """Take in that the call of a person was ended, and tell why."""
        self._pressed.discard(name)
        self.notify(name, text)

    def change_all(self, **facts: Any) -> None:
        """Change fields of all seats."""
        for state in self:
            self._change(state.seat, **facts)
        if facts.get("pace") == PAUSED:
            self._pressed.clear()

    def _change(self, name: str, **facts: Any) -> None:
        state = self._states[name].model_copy(update=facts)
        if state != self._states[name]:
            self._tell(state)

    def _tell(self, state: SeatState) -> None:
        state = state.model_copy(update={"t_ns": self._director.now_ns})
        self._states[state.seat] = state
        if self._is_open:
            self._publish(f"seat/{key_chunk(state.seat)}", state)
