"""The speakers of a run, who make calls."""

from __future__ import annotations

from functools import partial

from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.frequency_arbiter import FrequencyArbiter
from airhilt.sensors.radio.on_air import Utterance
from airhilt.sensors.radio.radio_call import RadioCall


class Speakers:
    """Lets units and actors make calls, where no person speaks for them.

    Attributes
    ----------
    on_air
        Calls on the air or waiting for it, by the id of the transmission.
    said
        Calls that were made, by the ids of their transmissions, in the order in which they were
        made.
    """

    def __init__(self, context: RadioContext, arbiter: FrequencyArbiter) -> None:
        self.on_air: dict[str, RadioCall] = {}
        self.said: dict[str, RadioCall] = {}
        self._context = context
        self._arbiter = arbiter

    def say_later(self, call: RadioCall, delay_s: float) -> None:
        """Make a call after a delay in s."""
        self._context.director.after(delay_s, partial(self.say, call))

    def say(self, call: RadioCall) -> None:
        """Make a call."""
        if not self._context.stations.is_there(call.speaker):
            return
        if self._context.seats.has_person(call.speaker) and not call.is_of_person:
            return
        again = call.times_said
        call.times_said += 1
        call.is_due_again = False
        scripted = call.scripted
        replied_to = call.in_reply_to
        utterance = Utterance(
            f"{call.id}.repeat-{again}" if again else call.id,
            call.frequency_khz,
            call.speaker,
            call.addressed,
            call.said,
            None if replied_to is None else replied_to.transmission or replied_to.id,
            None if scripted is None else scripted.declared.id,
            listens_first=again > 0 or scripted is None or scripted.listens_first,
        )
        call.transmission = utterance.id
        self.on_air[utterance.id] = self.said[utterance.id] = call
        self._arbiter.say(utterance)
