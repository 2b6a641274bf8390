"""Rerun: a recording with map, 3-D, cameras with boxes, plots and log, and its own blueprint.

The timeline is ``run``. Pictures and boxes stand at the time at which the picture was taken.
"""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np

from airhilt.displays.lines import line_of
from airhilt.displays.pictures import RecordedPictures
from airhilt.displays.scene import (
    AREA_COLOURS,
    Position,
    Scene,
    ground_speed_m_s,
    quaternion,
    srgb_colours,
)
from airhilt.engines import Package
from airhilt.imaging.pinhole import Pinhole
from airhilt.messages import ActorTruth, CameraFrame, Detections, Message, Severity
from airhilt.metrics.result import Result

with Package("rerun-sdk", "rerun").importing():
    import rerun as rr
    import rerun.blueprint as rrb

TIMELINE = "run"
LEVELS = {
    Severity.INFO: rr.TextLogLevel.INFO,
    Severity.ADVISORY: rr.TextLogLevel.INFO,
    Severity.CAUTION: rr.TextLogLevel.WARN,
    Severity.WARNING: rr.TextLogLevel.ERROR,
}
BOX_COLOUR = (255, 204, 0)
ACTOR_RADIUS = rr.Radius.ui_points(6.0)
LINE_RADIUS = rr.Radius.ui_points(1.0)
PLOTS = {"altitude_m": "Altitude, m", "ground_speed_m_s": "Ground speed, m/s"}
"""Names of the plots, by entity."""


def write(run: Result, out: Path) -> list[Path]:
    """Write the run as ``run.rrd``, which ``rerun`` opens."""
    path = out / "run.rrd"
    scene, pictures = Scene(run), RecordedPictures(run)
    recording = rr.RecordingStream("airhilt", recording_id=run.info.run)
    recording.set_log_time_enabled(False)
    recording.set_log_tick_enabled(False)
    recording.save(path)
    shown = _Recording(recording, scene)
    for message in run.messages():
        if isinstance(message, CameraFrame):
            if message.encoding == "rgb8" and (jpeg := pictures.jpeg(message)):
                shown.show_picture(message, jpeg)
        elif not isinstance(message, dict):
            shown.show(message)
    shown.finish()
    recording.send_blueprint(_blueprint([*scene.actors], shown.cameras))
    recording.disconnect()
    return [path]


class _Recording:
    """Logs the messages of a run to a recording of Rerun."""

    def __init__(self, recording: rr.RecordingStream, scene: Scene) -> None:
        self._recording = recording
        self._scene = scene
        self._tracks: defaultdict[str, list[Position]] = defaultdict(list)
        self._tracks_degrees: defaultdict[str, list[tuple[float, float]]] = defaultdict(list)
        self.cameras: dict[str, None] = {}
        """Names of the cameras with pictures, in the order of their first ones."""
        self._log_airport()
        for actor in scene.actors:
            self._log_actor(actor)

    def show(self, message: Message) -> None:
        """Log a message, if there is something to show for it."""
        match message:
            case ActorTruth():
                self._show_truth(message)
            case Detections():
                self._show_detections(message)
        if line := line_of(message):
            text = f"{line.source}: {line.text}"
            self._log("log", line.t_ns, rr.TextLog(text, level=LEVELS[line.severity]))

    def show_picture(self, frame: CameraFrame, jpeg: bytes) -> None:
        """Log a picture, and where its camera is."""
        self.cameras[frame.camera] = None
        camera, view, pinhole = _camera(frame.camera), frame.view, Pinhole(frame.view)
        pose = self._scene.camera_pose(view)
        at = rr.Transform3D(translation=pose.position_m, mat3x3=pose.rotation)
        lens = rr.Pinhole(
            focal_length=pinhole.focal_px,
            width=view.width_px,
            height=view.height_px,
            principal_point=pinhole.centre_px,
            camera_xyz=rr.ViewCoordinates.RDF,
        )
        self._log(camera, frame.t_frame_ns, at, lens)
        picture = rr.EncodedImage(contents=jpeg, media_type="image/jpeg")
        self._log(f"{camera}/picture", frame.t_frame_ns, picture)

    def finish(self) -> None:
        """Log the whole track of each actor."""
        for actor, track in self._tracks.items():
            colour = self._scene.colour(actor)
            line = rr.LineStrips3D([track], colors=[colour], radii=[LINE_RADIUS])
            self._log_static(f"world/tracks/{actor}", line)
            on_map = rr.GeoLineStrings(
                lat_lon=[self._tracks_degrees[actor]], colors=[colour], radii=[LINE_RADIUS]
            )
            self._log_static(f"map/tracks/{actor}", on_map)

    def _show_truth(self, state: ActorTruth) -> None:
        actor, pose = state.actor, self._scene.pose(state)
        degrees = state.latitude_deg, state.longitude_deg
        self._tracks[actor].append(pose.position_m)
        self._tracks_degrees[actor].append(degrees)
        place = rr.Transform3D(
            translation=pose.position_m, quaternion=rr.Quaternion(xyzw=quaternion(pose.rotation))
        )
        self._log(f"world/actors/{actor}", state.t_ns, place)
        on_map = rr.GeoPoints(
            lat_lon=[degrees], radii=[ACTOR_RADIUS], colors=[self._scene.colour(actor)]
        )
        self._log(f"map/actors/{actor}", state.t_ns, on_map)
        plotted = {"altitude_m": state.altitude_m, "ground_speed_m_s": ground_speed_m_s(state)}
        for name, value in plotted.items():
            self._log(f"plots/{name}/{actor}", state.t_ns, rr.Scalars(value))

    def _show_detections(self, found: Detections) -> None:
        boxes = rr.Boxes2D(
            array=np.array([each.box for each in found.detections]).reshape(-1, 4),
            array_format=rr.Box2DFormat.XYXY,
            labels=[f"{each.label} {each.confidence:.2f}" for each in found.detections],
            colors=[BOX_COLOUR],
        )
        self._log(f"{_camera(found.camera)}/detections", found.t_frame_ns, boxes)

    def _log_airport(self) -> None:
        self._log_static("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP)
        areas = defaultdict(list)
        for outline in self._scene.outlines():
            areas[outline.area].append(outline.points)
        for area, lines in areas.items():
            look: dict[str, Any] = {"colors": [AREA_COLOURS[area]], "radii": [LINE_RADIUS]}
            name = area.replace(" ", "_")
            ground = [[(*point, 0.0) for point in line] for line in lines]
            self._log_static(f"world/airport/{name}", rr.LineStrips3D(ground, **look))
            on_map = [[self._scene.degrees(point) for point in line] for line in lines]
            self._log_static(f"map/airport/{name}", rr.GeoLineStrings(lat_lon=on_map, **look))

    def _log_actor(self, actor: str) -> None:
        mesh, colour = self._scene.mesh(actor), self._scene.colour(actor)
        body = rr.Mesh3D(
            vertex_positions=mesh.corners.reshape(-1, 3),
            vertex_normals=mesh.normals.reshape(-1, 3),
            vertex_colors=np.repeat(srgb_colours(mesh), 3, axis=0),
        )
        self._log_static(f"world/actors/{actor}/body", body)
        name = rr.Points3D([(0.0, 0.0, 0.0)], labels=[actor], colors=[colour], radii=[0.0])
        self._log_static(f"world/actors/{actor}/name", name)
        for plot in PLOTS:
            line = rr.SeriesLines(colors=[colour], names=[actor])
            self._log_static(f"plots/{plot}/{actor}", line)

    def _log(self, entity: str, t_ns: int, *shown: Any) -> None:
        self._recording.set_time(TIMELINE, duration=np.timedelta64(t_ns, "ns"))
        self._recording.log(entity, *shown)

    def _log_static(self, entity: str, shown: Any) -> None:
        self._recording.log(entity, shown, static=True)


def _camera(name: str) -> str:
    return f"world/cameras/{name}"


def _blueprint(actors: list[str], cameras: dict[str, None]) -> rrb.Blueprint:
    """Return what Rerun shows at first: map, 3-D, cameras, plots and log at once."""
    eye = rrb.EyeControls3D(tracking_entity=f"world/actors/{actors[0]}")
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Vertical(
                rrb.MapView(origin="map", name="Map"),
                rrb.Spatial3DView(origin="world", name="3-D", eye_controls=eye),
            ),
            rrb.Vertical(
                *(rrb.Spatial2DView(origin=_camera(name), name=name) for name in cameras),
                *(
                    rrb.TimeSeriesView(origin=f"plots/{plot}", name=title)
                    for plot, title in PLOTS.items()
                ),
            ),
            rrb.TextLogView(origin="log", name="Log"),
        ),
        collapse_panels=True,
    )
