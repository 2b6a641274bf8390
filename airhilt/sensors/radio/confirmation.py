"""Calls that are said again because an advisory asks to confirm them."""

from __future__ import annotations

from functools import partial

from airhilt.messages import Advisory, Confirm
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.radio_call import MOST_TIMES, RadioCall, Speakers
from airhilt.sensors.radio.readback_policy import ReadbackPolicy

CONFIRM_AFTER_S = 3.0
"""Time in s from an advisory that asks to confirm a call until whoever is asked wants to speak: an
estimate of reading it and reaching for the button."""


class Confirmations:
    """Lets controllers and crews do what an advisory recommends by `Confirm`.

    Who is asked says the call again if it was its own, and else asks its speaker to. The other
    reads an instruction back as it has taken it. A call that was not taken is made once more.
    """

    def __init__(self, context: RadioContext, speakers: Speakers, policy: ReadbackPolicy) -> None:
        self._director = context.director
        self._stations = context.stations
        self._answers = context.answers
        self._speakers = speakers
        self._policy = policy
        self._asked: set[tuple[str, str]] = set()
        """Advisories that were answered, by id and recipient."""
        self._originals: dict[str, RadioCall] = {}
        """Calls that were said again, by the ids of what was said then."""
        self._confirmed: set[str] = set()
        """Ids of the calls that were."""

    def take(self, advisory: Advisory) -> None:
        """Let the crew or driver that an advisory asks to confirm a call do so."""
        if isinstance(advisory.recommendation, Confirm) and advisory.active:
            self._director.after(CONFIRM_AFTER_S, partial(self._confirm, advisory))

    def _confirm(self, advisory: Advisory) -> None:
        call = self.confirmation(advisory, advisory.recipient)
        if call is not None:
            self._speakers.say(call)

    def confirmation(self, advisory: Advisory, name: str) -> RadioCall | None:
        """Return what an actor or a unit says to confirm the call that an advisory asks to confirm.

        None if it has done so, or has no part in the call, or the call is made again anyway. Nobody
        confirms a call twice, whatever becomes of its advisories.
        """
        recommended, key = advisory.recommendation, (advisory.id, name)
        if not isinstance(recommended, Confirm) or key in self._asked:
            return None
        call = self._call(advisory, recommended.callsign)
        if call is None or name not in (call.speaker, call.addressed):
            return None
        self._asked.add(key)
        if call.is_due_again or call.id in self._confirmed or call.first.times_given >= MOST_TIMES:
            return None
        has_taken = call.addressed is None or call.addressed in call.taken_by
        if name != call.speaker:
            return self._question(call, name, self._again(call))
        if has_taken:
            return self._again(call)
        self._policy.call_again(call)
        return None

    def _call(self, advisory: Advisory, callsign: str) -> RadioCall | None:
        """Return the call in doubt: that of the evidence, or else the last of the callsign."""
        said = self._speakers.said
        of_evidence = [said[name] for name in advisory.evidence.radio_ids if name in said]
        of_callsign = [each for each in said.values() if callsign in (each.speaker, each.addressed)]
        calls = of_evidence or of_callsign
        return self._originals.get(calls[-1].id, calls[-1]) if calls else None

    def _again(self, call: RadioCall) -> RadioCall:
        """Return a call as it is said again, with its readback."""
        self._confirmed.add(call.id)
        again = RadioCall(
            f"{call.id}.confirmation-1",
            call.frequency_khz,
            call.speaker,
            call.addressed,
            call.said,
            in_reply_to=call,
            gives_again=call,
        )
        self._originals[again.id] = call
        listener = call.addressed
        if listener is not None and self._stations.is_actor(listener):
            again.answer = self._readback(call, again, listener)
        return again

    def _readback(self, call: RadioCall, again: RadioCall, listener: str) -> RadioCall:
        """Return the readback of a call that is said again: as before, if it was read back."""
        before = self._policy.readback_in_script(call, listener)
        if before is not None and before.times_said:
            text = before.said
        else:
            text = self._answers.readback_of(call.said, listener, call.frequency_khz)
        readback = again.reply("readback", listener, text, is_repeated=False)
        self._originals[readback.id] = call if before is None else before
        return readback

    def _question(self, call: RadioCall, asked: str, again: RadioCall) -> RadioCall:
        """Return the question to the speaker of a call, who answers by saying it again."""
        return RadioCall(
            f"{again.id}.request",
            call.frequency_khz,
            asked,
            call.speaker,
            self._answers.say_again(asked, call.speaker),
            in_reply_to=call,
            answer=again,
        )
