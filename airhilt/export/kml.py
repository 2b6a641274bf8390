"""KML: tracks, airport, calls and advisories for Google Earth and programs like it.

KML 2.3 is OGC 12-007r2; ``gx:Track`` is Google's form of its ``Track``. Altitudes are above mean
sea level. The run begins at the time of day of its daylight.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence
from pathlib import Path

from airhilt.displays.lines import megahertz
from airhilt.displays.scene import AREA_COLOURS, Outline, Scene
from airhilt.displays.story import Story
from airhilt.messages import ActorTruth
from airhilt.metrics.result import Result

KML = "http://www.opengis.net/kml/2.2"
GX = "http://www.google.com/kml/ext/2.2"
WIDTH_PX = "3"


def write(run: Result, out: Path) -> list[Path]:
    """Write the run as ``run.kml``."""
    path = out / "run.kml"
    ET.register_namespace("", KML)
    ET.register_namespace("gx", GX)
    document = _Document(run.info.run, Scene(run), Story.of(run))
    tree = ET.ElementTree(document.root)
    ET.indent(tree)
    tree.write(path, encoding="utf-8", xml_declaration=True)
    return [path]


class _Document:
    def __init__(self, name: str, scene: Scene, story: Story) -> None:
        self.root = ET.Element(f"{{{KML}}}kml")
        self._scene, self._story = scene, story
        document = _add(self.root, "Document")
        _add(document, "name", name)
        airport = self._folder(document, "Airport")
        for outline in scene.outlines():
            self._add_outline(airport, outline)
        tracks = self._folder(document, "Tracks")
        for actor, states in story.tracks.items():
            self._add_track(tracks, actor, states)
        calls = self._folder(document, "Radio")
        for call in story.calls:
            words = f"{call.speaker} on {megahertz(call.frequency_khz)}: {call.text}"
            self._add_words(calls, words, (call.speaker,), call.t_tx_ns, call.t_end_ns)
        advisories = self._folder(document, "Advisories")
        for advisory, until_ns in story.advisories:
            words = f"{advisory.severity} to {advisory.recipient}: {advisory.message}"
            names = advisory.recipient, *advisory.traffic
            self._add_words(advisories, words, names, advisory.t_ns, until_ns)

    def _folder(self, document: ET.Element, name: str) -> ET.Element:
        folder = _add(document, "Folder")
        _add(folder, "name", name)
        return folder

    def _add_outline(self, folder: ET.Element, outline: Outline) -> None:
        placemark = _add(folder, "Placemark")
        _add(placemark, "name", f"{outline.area} {outline.name}")
        _add_line_style(placemark, AREA_COLOURS[outline.area])
        line = _add(placemark, "LineString")
        _add(line, "tessellate", "1")
        places = (self._scene.degrees(point) for point in outline.points)
        _add(line, "coordinates", " ".join(f"{lon:.7f},{lat:.7f}" for lat, lon in places))

    def _add_track(self, folder: ET.Element, actor: str, states: Sequence[ActorTruth]) -> None:
        placemark = _add(folder, "Placemark")
        _add(placemark, "name", actor)
        _add_line_style(placemark, self._scene.colour(actor))
        track = ET.SubElement(placemark, f"{{{GX}}}Track")
        _add(track, "altitudeMode", "absolute")
        for state in states:
            _add(track, "when", self._time(state.t_ns))
        for state in states:
            ET.SubElement(track, f"{{{GX}}}coord").text = _place(state, " ")
        for state in states:
            angles = f"{state.heading_deg:.2f} {state.pitch_deg:.2f} {state.roll_deg:.2f}"
            ET.SubElement(track, f"{{{GX}}}angles").text = angles

    def _add_words(
        self, folder: ET.Element, words: str, names: tuple[str, ...], begin_ns: int, end_ns: int
    ) -> None:
        """Add words for as long as they last, where the first of the names is that has a place."""
        placemark = _add(folder, "Placemark")
        _add(placemark, "name", words)
        span = _add(placemark, "TimeSpan")
        _add(span, "begin", self._time(begin_ns))
        _add(span, "end", self._time(end_ns))
        point = _add(placemark, "Point")
        actor = self._story.teller(names)
        if actor is None:
            latitude_deg, longitude_deg = self._scene.degrees((0.0, 0.0))
            _add(point, "coordinates", f"{longitude_deg:.7f},{latitude_deg:.7f},0")
        else:
            states = self._story.tracks[actor]
            here = next((state for state in states if state.t_ns >= begin_ns), states[-1])
            _add(point, "altitudeMode", "absolute")
            _add(point, "coordinates", _place(here, ","))

    def _time(self, t_ns: int) -> str:
        return self._scene.time_of_day(t_ns)


def _add(parent: ET.Element, name: str, text: str | None = None) -> ET.Element:
    child = ET.SubElement(parent, f"{{{KML}}}{name}")
    child.text = text
    return child


def _add_line_style(placemark: ET.Element, colour: tuple[int, int, int]) -> None:
    red, green, blue = colour
    line = _add(_add(placemark, "Style"), "LineStyle")
    _add(line, "color", f"ff{blue:02x}{green:02x}{red:02x}")
    _add(line, "width", WIDTH_PX)


def _place(state: ActorTruth, separator: str) -> str:
    parts = (
        f"{state.longitude_deg:.7f}", f"{state.latitude_deg:.7f}", f"{state.altitude_m:.2f}"
    )  # fmt: skip
    return separator.join(parts)
