"""The instruments that aircraft showed their own crews, at the time shown."""

from __future__ import annotations

from typing import Any

from airhilt.messages import CockpitInstruments
from airhilt.record import Logged, RunFolder
from airhilt.report.data import RunData
from airhilt.report.sections import Content, Section
from airhilt.units import SECOND_NS

Json = dict[str, Any]

PERIOD_NS = SECOND_NS
"""Time between two states of the instruments in the page, in ns."""
SHOWN = (
    "airspeed_kt",
    "mach",
    "altitude_ft",
    "vertical_speed_fpm",
    "heading_deg",
    "track_deg",
    "ground_speed_kt",
    "mode",
    "selected_altitude_ft",
)
"""Fields of `CockpitInstruments` in the page."""


class Cockpits(Content):
    """The instruments of each aircraft that publishes them, once a second."""

    def __init__(self, folder: RunFolder) -> None:
        super().__init__(folder)
        self._shown: dict[str, list[Json]] = {}
        self._due_ns: dict[str, int] = {}

    def take(self, logged: Logged) -> None:
        """Receive a `CockpitInstruments`; the positions of vehicles are left out."""
        if logged.key.endswith("/position") or logged.t_ns < self._due_ns.get(logged.key, 0):
            return
        self._due_ns[logged.key] = logged.t_ns + PERIOD_NS
        instruments = CockpitInstruments.model_validate_json(logged.data)
        state = {name: getattr(instruments, name) for name in SHOWN}
        times = self._shown.setdefault(instruments.callsign, [])
        times.append({"t": round(logged.t_ns / SECOND_NS, 2), **state})

    def as_json(self, run: RunData) -> list[Json]:  # noqa: ARG002
        """Return one object for each aircraft."""
        return [{"callsign": callsign, "states": own} for callsign, own in self._shown.items()]


SECTION = Section("cockpit", order=65, module=__file__, content=Cockpits, keys=("cockpit/",))
