"""The listeners of a call, who hear or read it, and their understanding of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Literal

from airhilt.messages import HearingTruth, Transcript
from airhilt.sensors.radio.compliance import Compliance, Decision
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.hearing import HearingModel, Outcome, hearing_key
from airhilt.sensors.radio.on_air import OnAir, Utterance
from airhilt.sensors.radio.radio_call import RadioCall
from airhilt.sensors.radio.readback_policy import ReadbackPolicy
from airhilt.sensors.radio.transmissions import Transmissions
from airhilt.world.actors.listening import Listener, Understanding

TRANSCRIPT_PATIENCE_S = 20.0
"""Time in s after the end of a call for which a crew that reads waits for the transcript."""

NOTHING = Understanding("not_for_me")
AS_SAID = Understanding("as_said")
UNCLEAR = Understanding("unclear")
_OUTCOMES: dict[str, Outcome] = {
    "as_said": "understood",
    "otherwise": "misheard",
    "unclear": "unsure",
    "not_for_me": "missed",
}

Read = Callable[[str, tuple[float, ...] | None], None]
"""Called with the words of a transcript, none if there is no transcript, and their confidences."""


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
        heard_by_unit: Callable[[RadioCall, str, str], None],
    ) -> None:
        self._context = context
        self._radio = context.radio
        self._stations = context.stations
        self._seats = context.seats
        self._hearing = hearing
        self._transmissions = transmissions
        self._compliance = compliance
        self._policy = policy
        self._heard_by_unit = heard_by_unit
        self._waiting: dict[str, list[Read]] = {}
        """Listeners that wait for the transcript of a transmission, by its id."""

    # --- by ear -----------------------------------------------------------------------------

    def let_hear(self, call: RadioCall, on_air: OnAir) -> None:
        """Let the recipients of a call hear it, except those who read."""
        for listener in call.recipients():
            if not self._reads(listener):
                self._hear(call, on_air, listener)

    def _hear(self, call: RadioCall, on_air: OnAir, listener: str) -> None:
        said = on_air.utterance
        if not self._gets(call, on_air, listener):
            self._understand(call, said, listener, NOTHING, "")
            return
        if self._seats.has_person(listener):
            self._understand(call, said, listener, AS_SAID, said.text)
            return
        snr_db = self._context.receptions.of(said, listener).snr_db
        heard = self._hearing.listen(
            said.id, listener, said.text, snr_db, 2 if call.is_said_twice else 1
        )
        match heard.outcome:
            case "understood":
                understanding = AS_SAID
            case "misheard":
                understanding = self._interpret(call, said, listener, heard.text, None)
            case "unsure":
                understanding = UNCLEAR
            case "missed":
                understanding = NOTHING
        self._understand(call, said, listener, understanding, heard.text)

    def _gets(self, call: RadioCall, on_air: OnAir, listener: str) -> bool:
        """Return whether a call comes to a recipient, who then may hear it well or not."""
        return (
            listener not in call.deaf
            and self._stations.is_on(listener, on_air.utterance.frequency_khz)
            and self._transmissions.reaches(on_air, listener)
            and self._seats.listens(listener, on_air.utterance.frequency_khz)
        )

    # --- by transcript ----------------------------------------------------------------------

    def _reads(self, listener: str) -> bool:
        """Return whether a listener reads transcripts instead of listening."""
        return self._radio.topology == "asr_first" and self._stations.is_crew(listener)

    def let_read(self, call: RadioCall, said: Utterance, *, is_blocked: bool) -> None:
        """Let the crews that read wait for the transcript of a call.

        Nobody reads a call that was received with another in it.
        """
        recipients = call.recipients()
        for listener in self._stations.actors_on(said.frequency_khz):
            if listener == said.speaker or not self._reads(listener):
                continue
            may_overhear = self._radio.overhearing and not self._seats.has_person(listener)
            is_off = not self._seats.listens(listener, said.frequency_khz)
            if listener in recipients and (is_blocked or is_off or listener in call.deaf):
                self._understand(call, said, listener, NOTHING, "", source="transcript")
            elif listener in recipients:
                read = partial(self._read, call, said, listener)
                self._waiting.setdefault(said.id, []).append(read)
            elif may_overhear and not is_blocked and listener not in call.taken_by:
                overhear = partial(self._overhear, call, said, listener)
                self._waiting.setdefault(said.id, []).append(overhear)
        if said.id in self._waiting:
            give_up = partial(self._hand_out, said.id, "", None)
            self._context.director.after(TRANSCRIPT_PATIENCE_S, give_up)

    def take(self, transcript: Transcript) -> None:
        """Give a transcript to the crews that wait for it."""
        confidences = tuple(word.confidence for word in transcript.words) or None
        self._hand_out(transcript.id, transcript.text, confidences)

    def _hand_out(
        self, transmission: str, text: str, confidences: tuple[float, ...] | None
    ) -> None:
        for read in self._waiting.pop(transmission, ()):
            read(text, confidences)

    def _read(
        self,
        call: RadioCall,
        said: Utterance,
        listener: str,
        text: str,
        confidences: tuple[float, ...] | None,
    ) -> None:
        """Let a recipient of a call read its transcript."""
        understanding = NOTHING
        if text:
            understanding = self._interpret(call, said, listener, text, confidences)
        self._understand(call, said, listener, understanding, text, source="transcript")

    def _overhear(
        self,
        call: RadioCall,
        said: Utterance,
        listener: str,
        text: str,
        confidences: tuple[float, ...] | None,
    ) -> None:
        """Let a crew read a call for somebody else, which it may take for its own."""
        if not text or self._stations.is_actor(said.speaker):
            return
        understanding = self._listener(call).overhear(text, said.text, listener, confidences)
        if understanding.kind == "otherwise" and understanding.call is not None:
            self._publish_truth(said, listener, understanding, text, source="transcript")
            decision = self._compliance.decide(call, listener, understanding.call, as_said=False)
            self._compliance.comply(call, listener, decision.commands)

    # --- spoken by a person -----------------------------------------------------------------

    def let_understand(
        self, call: RadioCall, said: Utterance, on_air: OnAir, *, is_clear: bool
    ) -> None:
        """Let the recipients of a call that a person spoke take it as it was recognised."""
        for listener in call.recipients():
            is_heard = self._gets(call, on_air, listener)
            understanding = (AS_SAID if is_clear else UNCLEAR) if is_heard else NOTHING
            text = said.text if is_heard else ""
            self._understand(call, said, listener, understanding, text, source="transcript")

    # --- what it means ----------------------------------------------------------------------

    def _interpret(
        self,
        call: RadioCall,
        said: Utterance,
        listener: str,
        heard: str,
        confidences: tuple[float, ...] | None,
    ) -> Understanding:
        """Return what a recipient of a call makes of the words that arrived.

        An actor knows a call by its own callsign, or by the one that it takes for its own; a unit
        by that of the caller.
        """
        stations = self._stations
        names = [listener, call.addressed or ""]
        if not stations.is_actor(listener):
            names = [call.speaker]
        known_by = tuple(name for name in names if stations.is_actor(name))
        return self._listener(call).understand(heard, said.text, known_by, confidences)

    def _listener(self, call: RadioCall) -> Listener:
        return self._stations.listener(call.frequency_khz)

    def _understand(
        self,
        call: RadioCall,
        said: Utterance,
        listener: str,
        understanding: Understanding,
        text: str,
        source: Literal["ear", "transcript"] = "ear",
    ) -> None:
        self._publish_truth(said, listener, understanding, text, source)
        if text and not self._stations.is_actor(listener):
            self._heard_by_unit(call, listener, text)
        decision, kind = Decision(), understanding.kind
        if kind in ("as_said", "otherwise"):
            taken = understanding.call or self._listener(call).parse(said.text)
            understanding = replace(understanding, call=taken)
            if self._stations.is_actor(listener):
                decision = self._compliance.decide(call, listener, taken, as_said=kind == "as_said")
                self._compliance.comply(call, listener, decision.commands)
        self._policy.follow_up(call, said, listener, understanding, decision)

    def _publish_truth(
        self,
        said: Utterance,
        listener: str,
        understanding: Understanding,
        text: str,
        source: Literal["ear", "transcript"],
    ) -> None:
        truth = HearingTruth(
            t_ns=self._context.director.now_ns,
            id=said.id,
            actor=listener,
            outcome=_OUTCOMES[understanding.kind],
            text=text,
            source=source,
        )
        self._context.publish(hearing_key(listener), truth)
