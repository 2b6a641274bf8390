"""Beliefs about clearances and levels that the calls of a run lead to."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from airhilt.assistant.decision.air_tracks import AirTracks
from airhilt.assistant.decision.clearances import Clearances
from airhilt.assistant.decision.guard import ConfidenceGuard, call_of
from airhilt.assistant.decision.level_readbacks import LevelReadbacks
from airhilt.assistant.decision.loss_prediction import SeparationStandard
from airhilt.messages import AdsbReport, SpokenTruth, Transcript
from airhilt.record import read_log

Belief = tuple[str, str, str]
"""Callsign, action, and runway or level; empty if that was not heard."""


class Beliefs:
    """Beliefs of somebody who hears the calls of a run, by the reference engine's own rules."""

    def __init__(self, tau_asr: float, callsigns: Iterable[str]) -> None:
        guard = ConfidenceGuard(tau_asr)
        self._callsigns = tuple(callsigns)
        self._clearances = Clearances(guard)
        self._tracks = AirTracks()
        self._levels = LevelReadbacks(self._tracks, guard)
        self.held: set[Belief] = set()
        """All that was believed at any time, mismatches of readbacks among it."""

    def take_report(self, report: AdsbReport) -> None:
        """Update the track of an aircraft."""
        self._tracks.take_report(report, report.t_ns)

    def take(self, transcript: Transcript) -> None:
        """Hear a call."""
        self._clearances.take(call_of(transcript, self._callsigns), transcript)
        misread = self._levels.take_transcript(transcript.t_ns, transcript, SeparationStandard())
        if misread is not None:
            self.held.add((misread.callsign, "misread", f"{misread.read_ft:.0f}"))
        for each in self._clearances.in_force(transcript.t_ns):
            if each.is_certain:
                self.held.add((each.callsign, each.action, each.runway or ""))
        for wrong in self._clearances.discrepancies(transcript.t_ns):
            self.held.add((wrong.callsign, f"misread {wrong.read.action}", wrong.read.runway or ""))
        for track in self._tracks:
            if track.cleared_m is not None:
                self.held.add((track.callsign, "altitude", f"{track.cleared_m:.0f}"))


def wrong(heard: Iterable[Belief], said: Iterable[Belief]) -> set[Belief]:
    """Return the beliefs that nothing that was said bears out.

    A belief without a runway, because it was not recognised, is not wrong if there is such a one
    with a runway; that one is missing.
    """
    known = set(said)
    known |= {(callsign, action, "") for callsign, action, _ in known}
    return set(heard) - known


def beliefs_of(folder: Path, tau_asr: float, callsigns: Iterable[str]) -> tuple[Beliefs, Beliefs]:
    """Return the beliefs by what was recognised in a run, and by what was said."""
    heard, said = Beliefs(tau_asr, callsigns), Beliefs(0.0, callsigns)
    words: dict[str, str] = {}
    for logged in read_log(folder / "log.mcap"):
        if logged.key.startswith("truth/radio/"):
            truth = SpokenTruth.model_validate_json(logged.data)
            words[truth.id] = truth.text
        elif logged.key.startswith("adsb/"):
            report = AdsbReport.model_validate_json(logged.data)
            heard.take_report(report)
            said.take_report(report)
        elif logged.key.startswith("asr/"):
            transcript = Transcript.model_validate_json(logged.data)
            heard.take(transcript)
            truth_of = {"text": words.get(transcript.id, ""), "words": (), "confidence": 1.0}
            said.take(transcript.model_copy(update=truth_of))
    return heard, said
