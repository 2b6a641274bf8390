"""The listeners of a call, who hear or read it, and their understanding of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from airhilt.messages import HearingTruth, Transcript
from airhilt.sensors.radio.compliance import Compliance, Decision
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.controllers import Controllers
from airhilt.sensors.radio.hearing import HearingModel, Outcome, hearing_key
from airhilt.sensors.radio.on_air import OnAir, Utterance
from airhilt.sensors.radio.radio_call import UNCLEAR, HeardCall, RadioCall
from airhilt.sensors.radio.readback_policy import ReadbackPolicy
from airhilt.sensors.radio.transmissions import Transmissions
from airhilt.world.actors.listening import Understanding

TRANSCRIPT_PATIENCE_S = 20.0
"""Time in s after the end of a call for which a crew that reads waits for the transcript."""

_OUTCOMES: dict[str, Outcome] = {
    "as_said": "understood",
    "otherwise": "misheard",
    "unclear": "unsure",
    "not_for_me": "missed",
}

Confidences = tuple[float, ...] | None
"""Confidence of each word of a transcript; None if the recogniser gives none."""


class Listeners:
    """The people on the frequencies, who hear calls or read their transcripts, and act on them.

    No mistake is drawn for people at seats: a call that reaches them counts as heard, and they
    switch their receivers off.
    """

    def __init__(
        self,
        context: RadioContext,
        hearing: HearingModel,
        transmissions: Transmissions,
        compliance: Compliance,
        policy: ReadbackPolicy,
        controllers: Controllers,
    ) -> None:
        self._context = context
        self._radio = context.radio
        self._stations = context.stations
        self._seats = context.seats
        self._hearing = hearing
        self._transmissions = transmissions
        self._compliance = compliance
        self._policy = policy
        self._controllers = controllers
        self._waiting: dict[str, list[Callable[[str, Confidences], None]]] = {}
        """Actions that wait for the words of a transmission, by its id: for its transcript, or for
        none."""

    # --- by ear -----------------------------------------------------------------------------

    def let_hear(self, call: RadioCall, on_air: OnAir) -> None:
        """Let the recipients of a call hear it, except those who read."""
        for listener in call.recipients():
            if not self._reads(listener):
                heard = HeardCall(call, on_air.utterance, listener)
                self._take(self._by_ear(heard) if self._gets(heard, on_air) else heard)

    def _by_ear(self, heard: HeardCall) -> HeardCall:
        """Return a call that reaches a listener as the listener understands it."""
        said, listener = heard.said, heard.listener
        if self._seats.has_person(listener):
            return self._as_said(heard)
        snr_db = self._context.receptions.of(said, listener).snr_db
        times = 2 if heard.call.is_said_twice else 1
        drawn = self._hearing.listen(said.id, listener, said.text, snr_db, times)
        match drawn.outcome:
            case "understood":
                return self._as_said(heard)
            case "misheard":
                return self._interpreted(heard, drawn.text, None)
            case "unsure":
                return replace(heard, text=drawn.text, understanding=UNCLEAR)
            case "missed":
                return heard

    def _gets(self, heard: HeardCall, on_air: OnAir) -> bool:
        """Return whether a call comes to a recipient, who then may hear it well or not."""
        listener, frequency_khz = heard.listener, heard.said.frequency_khz
        return (
            listener not in heard.call.deaf
            and self._stations.is_on(listener, frequency_khz)
            and self._transmissions.reaches(on_air, listener)
            and self._seats.listens(listener, frequency_khz)
        )

    # --- by transcript ----------------------------------------------------------------------

    def _reads(self, listener: str) -> bool:
        """Return whether a listener reads transcripts instead of listening."""
        return self._radio.topology == "asr_first" and self._stations.is_crew(listener)

    def let_read(self, call: RadioCall, said: Utterance, *, is_blocked: bool) -> None:
        """Let the crews that read wait for the transcript of a call.

        Nobody reads a call that was received with another in it. A crew may take a call of a unit
        to somebody else for its own.
        """
        recipients, is_of_unit = call.recipients(), not self._stations.is_actor(said.speaker)
        waiting: list[Callable[[str, Confidences], None]] = []
        for listener in self._stations.actors_on(said.frequency_khz):
            if listener == said.speaker or not self._reads(listener):
                continue
            heard = HeardCall(call, said, listener, "transcript")
            may_overhear = self._radio.overhearing and not self._seats.has_person(listener)
            is_off = not self._seats.listens(listener, said.frequency_khz)
            if listener in recipients and (is_blocked or is_off or listener in call.deaf):
                self._take(heard)
            elif listener in recipients:
                waiting.append(partial(self._read, heard))
            elif is_of_unit and may_overhear and not is_blocked and listener not in call.taken_by:
                waiting.append(partial(self._overhear, heard))
        if waiting:
            self._waiting[said.id] = waiting
            give_up = partial(self._hand_out, said.id, "", None)
            self._context.director.after(TRANSCRIPT_PATIENCE_S, give_up)

    def take(self, transcript: Transcript) -> None:
        """Give a transcript to the crews that wait for it."""
        confidences = tuple(word.confidence for word in transcript.words) or None
        self._hand_out(transcript.id, transcript.text, confidences)

    def _hand_out(self, transmission: str, text: str, confidences: Confidences) -> None:
        for read in self._waiting.pop(transmission, ()):
            read(text, confidences)

    def _read(self, heard: HeardCall, text: str, confidences: Confidences) -> None:
        """Let a recipient of a call read its transcript."""
        self._take(self._interpreted(heard, text, confidences) if text else heard)

    def _overhear(self, heard: HeardCall, text: str, confidences: Confidences) -> None:
        """Let a crew read a call for somebody else, which it may take for its own."""
        listener = self._stations.listener(heard.call.frequency_khz)
        taken = listener.overhear(text, heard.said.text, heard.listener, confidences)
        if taken.kind == "otherwise":
            heard = replace(heard, text=text, understanding=taken)
            self._publish_truth(heard)
            self._compliance.take(heard)

    # --- spoken by a person -----------------------------------------------------------------

    def let_understand(
        self, call: RadioCall, said: Utterance, on_air: OnAir, *, is_clear: bool
    ) -> None:
        """Let the recipients of a call that a person spoke take it as it was recognised."""
        for listener in call.recipients():
            heard = HeardCall(call, said, listener, "transcript")
            if self._gets(heard, on_air):
                unclear = replace(heard, text=said.text, understanding=UNCLEAR)
                heard = self._as_said(heard) if is_clear else unclear
            self._take(heard)

    # --- what it means ----------------------------------------------------------------------

    def _as_said(self, heard: HeardCall) -> HeardCall:
        """Return a call as it is understood by who has heard every word."""
        text, listener = heard.said.text, self._stations.listener(heard.call.frequency_khz)
        if heard.call.is_of_person:
            return replace(heard, text=text, understanding=listener.as_said(text))
        understanding = Understanding("as_said", listener.parse(text))
        return replace(heard, text=text, understanding=understanding)

    def _interpreted(self, heard: HeardCall, text: str, confidences: Confidences) -> HeardCall:
        """Return a call as a recipient understands the words that arrived.

        An actor knows a call by its own callsign, or by the one that it takes for its own; a unit
        by that of the caller.
        """
        call, stations = heard.call, self._stations
        names = [heard.listener, call.addressed or ""]
        if not stations.is_actor(heard.listener):
            names = [call.speaker]
        known_by = tuple(name for name in names if stations.is_actor(name))
        listener = stations.listener(call.frequency_khz)
        taken = listener.understand(text, heard.said.text, known_by, confidences)
        return replace(heard, text=text, understanding=taken)

    def _take(self, heard: HeardCall) -> None:
        """Let a recipient act on a call, and answer it, as it has understood it."""
        self._publish_truth(heard)
        is_actor = self._stations.is_actor(heard.listener)
        if heard.text and not is_actor:
            self._controllers.heard(heard)
        is_decided = heard.is_taken and is_actor
        decision = self._compliance.take(heard) if is_decided else Decision()
        self._policy.follow_up(heard, decision)
        if heard.is_taken and not is_actor:
            self._controllers.check(heard)

    def _publish_truth(self, heard: HeardCall) -> None:
        truth = HearingTruth(
            t_ns=self._context.director.now_ns,
            id=heard.said.id,
            actor=heard.listener,
            outcome=_OUTCOMES[heard.understanding.kind],
            text=heard.text,
            source=heard.source,
        )
        self._context.publish(hearing_key(heard.listener), truth)
