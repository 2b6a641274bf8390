"""The altitudes that the script plans for each aircraft, had nobody been warned."""

from __future__ import annotations

import bisect
from collections.abc import Mapping, Sequence

from airhilt.commands import AltitudeCommand
from airhilt.geodesy.relative_motion import VerticalProfile
from airhilt.scenario.failures import EffectiveLine
from airhilt.surveillance.tcas import AltitudeAt
from airhilt.units import FOOT, FOOT_PER_MINUTE, SECOND_NS, seconds_to_ns


class Plans:
    """The altitude commands of the script, and when each is carried out.

    The lines have the scenario's failures applied. `ends_ns` is the time by which each line ends,
    by its id; for one to come, if the frequency is free then. `usual_rates_m_s` has the vertical
    speed of a climb that is scripted without one, by callsign of the aircraft.
    """

    def __init__(
        self,
        lines: Sequence[EffectiveLine],
        ends_ns: Mapping[str, int],
        usual_rates_m_s: Mapping[str, float],
    ) -> None:
        self._usual_rates_m_s = usual_rates_m_s
        self._due: dict[str, list[tuple[int, AltitudeCommand]]] = {}
        for effective in lines:
            for scripted in effective.line.commands if effective.line else ():
                if isinstance(scripted.command, AltitudeCommand):
                    due_ns = ends_ns[effective.declared.id] + seconds_to_ns(scripted.delay_s)
                    self._due.setdefault(scripted.actor, []).append((due_ns, scripted.command))

    def altitude_at(self, callsign: str, now_ns: int, profile: VerticalProfile) -> AltitudeAt:
        """Return the altitude over time of an aircraft that has this profile now, as planned."""
        pieces = [(0.0, profile)]
        for due_ns, command in sorted(self._due.get(callsign, []), key=lambda plan: plan[0]):
            if due_ns <= now_ns:
                continue
            time_s = (due_ns - now_ns) / SECOND_NS
            last_s, last = pieces[-1]
            begin_m = last.at(time_s - last_s)
            rate = command.vertical_rate_fpm
            usual_m_s = self._usual_rates_m_s[callsign]
            speed_m_s = usual_m_s if rate is None else rate * FOOT_PER_MINUTE
            target_m = command.altitude_ft * FOOT
            rate_m_s = speed_m_s if target_m > begin_m else -speed_m_s
            pieces.append((time_s, VerticalProfile(begin_m, rate_m_s, target_m)))
        begins_s = [begin_s for begin_s, _ in pieces]

        def at(time_s: float) -> float:
            begin_s, piece = pieces[bisect.bisect_right(begins_s, time_s) - 1]
            return piece.at(time_s - begin_s)

        return at
