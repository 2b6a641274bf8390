"""Crews report a resolution advisory of TCAS to their unit, and its end."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from airhilt.messages import EquipmentAlert
from airhilt.phraseology.say import speak_ra_report
from airhilt.sensors.radio.context import RadioContext
from airhilt.sensors.radio.radio_call import RadioCall, Speakers

TCAS = "tcas"
"""Name of the equipment whose alerts with a recommendation are resolution advisories."""
REPORT_AFTER_S = 8.0
"""Time in s from a resolution advisory to its report: the crew flies first, 5 s after the advisory
(ICAO Annex 10, volume IV), and then speaks; the rest is assumed."""


class RaReports:
    """Lets crews say "TCAS RA", and "clear of conflict" afterwards (ICAO Doc 4444, 12.3.1.2).

    A crew does so for a resolution advisory to climb, to descend or to stay, from the moment at
    which its workload permits. An advisory that is over before that is not reported. ``unit_of``
    returns the unit and the frequency in kHz that an aircraft is with; None if there is none.
    """

    def __init__(
        self,
        context: RadioContext,
        speakers: Speakers,
        unit_of: Callable[[str], tuple[str, int] | None],
    ) -> None:
        self._context = context
        self._speakers = speakers
        self._unit_of = unit_of
        self._in_force: dict[str, str] = {}
        """Id of the resolution advisory of each crew, by callsign."""
        self._reported: dict[str, str] = {}
        """Likewise of those that were reported."""
        self._reports = 0

    def take(self, alert: EquipmentAlert) -> None:
        """Take in an alert of equipment in a cockpit."""
        advisory = alert.advisory
        callsign = self._context.scenario.callsigns.get(advisory.recipient)
        if alert.equipment != TCAS or callsign is None:
            return
        if not self._context.stations.is_crew(callsign):
            return
        if advisory.active and advisory.recommendation is not None:
            if self._in_force.get(callsign) != advisory.id:
                self._in_force[callsign] = advisory.id
                report = partial(self._report, callsign, advisory.id)
                self._context.director.after(REPORT_AFTER_S, report)
        elif self._in_force.get(callsign) == advisory.id:
            del self._in_force[callsign]
            if self._reported.pop(callsign, None) is not None:
                self._say(callsign, is_over=True)

    def _report(self, callsign: str, identity: str) -> None:
        if self._in_force.get(callsign) == identity:
            self._reported[callsign] = identity
            self._say(callsign, is_over=False)

    def _say(self, callsign: str, *, is_over: bool) -> None:
        contact = self._unit_of(callsign)
        if contact is None:
            return
        unit, frequency_khz = contact
        self._reports += 1
        style = self._context.radio.phraseology
        text = speak_ra_report(callsign, style, is_over=is_over)
        name = f"ra.{callsign}.{self._reports}"
        self._speakers.say(RadioCall(name, frequency_khz, callsign, unit, text, is_repeated=False))
