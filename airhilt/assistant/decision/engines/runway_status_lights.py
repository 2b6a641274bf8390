"""The baseline on the ground for runways: red lights by surface surveillance.

It tells those who have a lit light before their eyes, and never the controller, who does not see
the lights. A light that somebody stands before is an ADVISORY: it is red, and there is nothing to
do. A light against which somebody moves on is a WARNING: red means stop. Who is too near the runway
to stop short of it goes by their own judgement, as the protocol for the lights has it: nothing is
recommended.

The real lights need no address. Here a target without a transponder is told by the name of the only
vehicle of the roster that no track has. If there is no such vehicle, or another target without a
name, such as an animal, nobody can be told.
"""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.assistant.decision.aerodrome import Aerodrome
from airhilt.assistant.decision.engine import Decision, ReceivedMessage
from airhilt.assistant.decision.raised_alerts import Hazard, RaisedAlerts
from airhilt.assistant.decision.status_lights import RedLights, StatusLightConfig, StatusLights
from airhilt.assistant.decision.surface_traffic import SurfaceTraffic, Target
from airhilt.assistant.decision.threats import UNIDENTIFIED
from airhilt.engines import Engine
from airhilt.messages import (
    Briefing,
    CancelTakeoff,
    Evidence,
    HoldPosition,
    Message,
    Recommendation,
    Severity,
    SurfaceTrack,
)

RELEASE_S = 1.0
"""Time for which a light must be out before that is told, in s: an assumption."""


class RunwayStatusLightEngine:
    """Shows red lights to crews and drivers at the entrances and beginnings of runways."""

    name = "runway_status_lights"
    reads: tuple[type[Message], ...] = (Briefing, SurfaceTrack)

    def __init__(self, configuration: StatusLightConfig | None = None) -> None:
        self.configuration = configuration or StatusLightConfig()
        self._traffic: SurfaceTraffic | None = None
        self._lights: StatusLights | None = None
        self._vehicles: frozenset[str] = frozenset()
        self._alerts = RaisedAlerts("lights", persistence_s=0.0, release_s=RELEASE_S)

    def receive(self, received: ReceivedMessage) -> None:
        """Update the traffic with one message."""
        match received.message:
            case Briefing(airport=airport, roster=roster) if airport is not None:
                aerodrome = Aerodrome(airport)
                self._traffic = SurfaceTraffic(aerodrome)
                self._lights = StatusLights(aerodrome, self.configuration)
                self._vehicles = frozenset(
                    entry.callsign for entry in roster if entry.category == "vehicle"
                )
            case SurfaceTrack() as track if self._traffic is not None:
                self._traffic.take(track)

    def decide(self, t_ns: int) -> Decision:
        """Return the alerts that are new, have risen, or are over."""
        if self._traffic is None or self._lights is None:
            return Decision()
        self._traffic.forget(t_ns)
        hazards = [
            hazard
            for red in self._lights.lit(self._traffic, t_ns)
            for hazard in self._hazards(red, self._traffic)
        ]
        return Decision(self._alerts.update(t_ns, hazards))

    def _hazards(self, red: RedLights, traffic: SurfaceTraffic) -> Iterator[Hazard]:
        """Yield the hazard for the viewer of lit lights; none if nobody can be told."""
        viewer, because = self._name(red.viewer, traffic), self._name(red.because, traffic)
        is_entrance = red.lights == "entrance"
        if viewer is None or (not is_entrance and viewer in self._vehicles):
            return
        other = because or UNIDENTIFIED
        # Who does not move on against the lights, or cannot stop short, has nothing to do.
        response: Recommendation = (HoldPosition if is_entrance else CancelTakeoff)(
            runway=red.runway
        )
        yield Hazard(
            key=(red.lights, str(red.viewer.number), red.strip.name),
            severity=Severity.WARNING if red.is_disregarded else Severity.ADVISORY,
            kind="runway_conflict",
            recipients=(viewer,),
            traffic=(viewer, other),
            evidence=Evidence(
                sources=("surface",),
                runway=red.runway,
                note=f"{red.lights} lights red for runway {red.runway}, traffic {other}",
                tracks=tuple(
                    target.icao24 or f"surface track {target.number}"
                    for target in (red.viewer, red.because)
                ),
                rules=(f"{red.lights} lights",),
            ),
            recommendations={viewer: response} if red.is_disregarded and red.can_stop else {},
        )

    def _name(self, target: Target, traffic: SurfaceTraffic) -> str | None:
        """Return the name of a target; by elimination, if it has no transponder."""
        if target.callsign or target.icao24:
            return target.callsign or target.icao24
        unnamed = [each for each in traffic if not (each.callsign or each.icao24)]
        missing = self._vehicles - {each.callsign for each in traffic}
        return next(iter(missing)) if len(missing) == len(unnamed) == 1 else None


ENGINE = Engine(
    name="runway_status_lights",
    summary="entrance, take-off hold and intersection lights by surface surveillance",
    create=lambda _, configuration: RunwayStatusLightEngine(configuration),
    configuration=StatusLightConfig,
)
