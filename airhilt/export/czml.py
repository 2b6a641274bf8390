"""CZML: actors, airport, calls and advisories for Cesium.

Packets are those of the CZML Guide (https://github.com/AnalyticalGraphicsInc/czml-writer/wiki).
Heights are altitudes above mean sea level, taken for heights above Cesium's ellipsoid, so that they
fit its globe without terrain. The run begins at the time of day of its daylight.
"""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from airhilt.displays.lines import megahertz
from airhilt.displays.scene import AREA_COLOURS, Outline, Scene, attitude_on_earth, quaternion
from airhilt.displays.story import Story
from airhilt.messages import ActorTruth, Severity
from airhilt.metrics.result import Result
from airhilt.record.overlay import SEVERITY_COLOURS
from airhilt.units import SECOND_NS

Packet = dict[str, Any]
Colour = tuple[int, int, int]

TRAIL_S = 60.0
"""Length of the trail behind an actor, in s."""
POINT_PX = 8
LINE_PX = 2
LINE_HEIGHT_PX = 20
LABEL_ABOVE_GROUND_M = 1e6
"""Distance up to which the ground hides no part of a label, in m."""
CALL_COLOUR = (255, 255, 255)


def write(run: Result, out: Path) -> list[Path]:
    """Write the run as ``run.czml``."""
    path = out / "run.czml"
    path.write_text(json.dumps(_Document(run.info.run, Scene(run), Story.of(run)).packets))
    return [path]


class _Document:
    def __init__(self, name: str, scene: Scene, story: Story) -> None:
        self._scene, self._story = scene, story
        whole = self._interval(0, story.end_ns)
        clock = {"interval": whole, "currentTime": self._time(0), "multiplier": 1}
        self.packets: list[Packet] = [
            {"id": "document", "name": name, "version": "1.0", "clock": clock},
            {"id": "centre", "position": {"cartographicDegrees": self._on_ground((0.0, 0.0))}},
        ]
        for number, outline in enumerate(scene.outlines()):
            self.packets.append(self._area(number, outline))
        for actor, states in story.tracks.items():
            self.packets.append(self._actor(actor, states))
        self._lines: defaultdict[str | None, list[int]] = defaultdict(list)
        for call in story.calls:
            words = f"{call.speaker}: {call.text}"
            place = story.teller((call.speaker,))
            packet = self._words(call.id, words, place, call.t_tx_ns, call.t_end_ns, None)
            self.packets.append(packet | {"description": megahertz(call.frequency_khz)})
        for advisory, until_ns in sorted(story.advisories, key=lambda told: told.advisory.t_ns):
            name = f"{advisory.id} {advisory.revision} {advisory.recipient}"
            place = story.teller((advisory.recipient, *advisory.traffic))
            self.packets.append(
                self._words(
                    name, f"{advisory.recipient}: {advisory.message}", place, advisory.t_ns,
                    until_ns, advisory.severity,
                )
            )  # fmt: skip

    def _area(self, number: int, outline: Outline) -> Packet:
        places = [part for point in outline.points for part in self._on_ground(point)]
        name = f"{outline.area} {outline.name}"
        colour = AREA_COLOURS[outline.area]
        if outline.area == "runway":
            drawn: Packet = {"polygon": {
                "positions": {"cartographicDegrees": places}, "material": _material(colour),
                "height": self._scene.ground_m,
            }}  # fmt: skip
        else:
            drawn = {"polyline": {
                "positions": {"cartographicDegrees": places}, "width": LINE_PX,
                "material": _material(colour), "arcType": "NONE",
            }}  # fmt: skip
        return {"id": f"area {number}", "name": name, **drawn}

    def _actor(self, actor: str, states: Sequence[ActorTruth]) -> Packet:
        colour = self._scene.colour(actor)
        places, attitudes = [], []
        for state in states:
            t_s = state.t_ns / SECOND_NS
            places += [t_s, state.longitude_deg, state.latitude_deg, state.altitude_m]
            attitudes += [t_s, *quaternion(attitude_on_earth(state))]
        width_m, length_m, height_m = np.ptp(self._scene.mesh(actor).corners, axis=(0, 1)).tolist()
        return {
            "id": actor,
            "name": actor,
            "availability": self._interval(states[0].t_ns, self._story.end_ns),
            "position": {
                "epoch": self._time(0),
                "cartographicDegrees": places,
                "forwardExtrapolationType": "HOLD",
            },
            "orientation": {
                "epoch": self._time(0),
                "unitQuaternion": attitudes,
                "forwardExtrapolationType": "HOLD",
            },
            "box": {
                "dimensions": {"cartesian": [width_m, length_m, height_m]},
                "material": _material(colour),
            },
            "point": {"pixelSize": POINT_PX, "color": _colour(colour)},
            "path": {"trailTime": TRAIL_S, "leadTime": 0, "width": LINE_PX,
                     "material": _material(colour)},
            "label": _label(actor, colour, 14),
        }  # fmt: skip

    def _words(
        self, name: str, words: str, place: str | None, begin_ns: int, end_ns: int,
        severity: Severity | None,
    ) -> Packet:  # fmt: skip
        """Return words that stand for as long as they last at an actor, or at the centre."""
        if severity is None:
            colour, line = CALL_COLOUR, 1
        else:
            colour, line = SEVERITY_COLOURS[severity], 2 + self._free_line(place, begin_ns, end_ns)
        return {
            "id": name,
            "name": words,
            "availability": self._interval(begin_ns, end_ns),
            "position": {"reference": f"{place or 'centre'}#position"},
            "label": _label(words, colour, -4 - LINE_HEIGHT_PX * line),
        }

    def _free_line(self, place: str | None, begin_ns: int, end_ns: int) -> int:
        """Return the lowest line at a place on which no other advisory stands, and take it."""
        taken_until = self._lines[place]
        line = next(
            (line for line, until_ns in enumerate(taken_until) if until_ns <= begin_ns),
            len(taken_until),
        )
        taken_until[line : line + 1] = [end_ns]
        return line

    def _on_ground(self, point: tuple[float, float]) -> list[float]:
        latitude_deg, longitude_deg = self._scene.degrees(point)
        return [longitude_deg, latitude_deg, self._scene.ground_m]

    def _interval(self, begin_ns: int, end_ns: int) -> str:
        return f"{self._time(begin_ns)}/{self._time(end_ns)}"

    def _time(self, t_ns: int) -> str:
        return self._scene.time_of_day(t_ns)


def _colour(colour: Colour) -> Packet:
    return {"rgba": [*colour, 255]}


def _material(colour: Colour) -> Packet:
    return {"solidColor": {"color": _colour(colour)}}


def _label(text: str, colour: Colour, down_px: int) -> Packet:
    return {
        "text": text,
        "font": "13px sans-serif",
        "fillColor": _colour(colour),
        "showBackground": True,
        "horizontalOrigin": "LEFT",
        "pixelOffset": {"cartesian2": [10, down_px]},
        "disableDepthTestDistance": LABEL_ABOVE_GROUND_M,
    }
