"""Rules of a seat: what its holder may do, and why an act is refused."""

from __future__ import annotations

from airhilt.messages import (
    SHORTEST_SECRET,
    AnswerQuestion,
    FlyCommand,
    PressToTalk,
    SayText,
    SayVoice,
    SeatAct,
    SeatAction,
    SeatState,
    SetPace,
    TuneFrequencies,
)

PAUSED = "paused"
"""Name of the pace at which the time stands still."""


def why_not_taken(state: SeatState, action: SeatAction, secret: str | None) -> str:
    """Return why a seat cannot be taken; empty if it can.

    Parameters
    ----------
    secret
        Secret of who has the seat; None: nobody has it.
    """
    if len(action.secret) < SHORTEST_SECRET:
        return f"the secret is too short; expected at least {SHORTEST_SECRET} characters"
    if secret not in (None, action.secret):
        return f"somebody has the seat {state.seat} already"
    return ""


def why_not_theirs(state: SeatState, action: SeatAction, secret: str | None) -> str:
    """Return why an act does not come from the holder of a seat; empty if it does."""
    if secret is None:
        return f"nobody has the seat {state.seat}; take it first"
    if (action.holder, action.secret) != (state.holder, secret):
        return f"somebody else has the seat {state.seat}"
    return ""


def why_not_done(state: SeatState, act: SeatAct, *, is_pressed: bool) -> str:
    """Return why the holder of a seat may not do something now; empty if that is allowed.

    Parameters
    ----------
    is_pressed
        True while the transmit button of the seat is held.
    """
    match act:
        case TuneFrequencies(frequencies_khz=tuned) if set(tuned) - set(state.frequencies_khz):
            return "your seat does not have that frequency"
        case PressToTalk() | SayVoice() if "voice" not in state.uses:
            return "you have not agreed to the use of your voice"
        case PressToTalk() if state.pace == PAUSED:
            return "the run is paused; nobody hears you"
        case PressToTalk() if not state.has_sound:
            return "this run has no sound; type what you want to say"
        case SayVoice() if not is_pressed:
            return "your call was cut"
        case SayText() if not state.uses:
            return "you have not agreed to the use of what you type"
        case FlyCommand() if state.category == "unit":
            return "the seat of a unit flies and drives nothing"
        case AnswerQuestion(question=number):
            open_number = None if state.question is None else state.question.number
            return "" if number == open_number else f"question {number} is not open at this seat"
        case SetPace() if not state.may_pause:
            return "this run has no pause and no slow motion"
    return ""
