"""Foxglove: an MCAP of Foxglove's messages with map, 3-D, cameras, radio and log, and a layout.

Times are those of the run, as in ``log.mcap``.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

from airhilt.displays.foxglove_channels import LOG, FoxgloveChannels, truth_topic
from airhilt.displays.pictures import RecordedPictures
from airhilt.displays.scene import AREA_COLOURS, Outline, Scene, quaternion, srgb_colours
from airhilt.displays.sound import recorded_sound
from airhilt.engines import Package
from airhilt.imaging.view import Pose
from airhilt.messages import ActorTruth, CameraFrame, Transmission
from airhilt.metrics.result import Result

with Package("foxglove-sdk", "foxglove").importing():
    from foxglove import Context, channels, layouts, open_mcap
    from foxglove.messages import (
        Color,
        FrameTransform,
        FrameTransforms,
        LinePrimitive,
        LinePrimitiveLineType,
        Point3,
        Quaternion,
        SceneEntity,
        SceneUpdate,
        TextPrimitive,
        TriangleListPrimitive,
        Vector3,
    )
    from foxglove.messages import Pose as FoxglovePose

WORLD, TRANSFORMS, SCENE = "world", "/tf", "/scene"
LINE_PX = 2.0
NAME_SIZE_PX = 14.0
SEEN_FROM_M = 500.0
"""Distance of the eye from the first actor, in m."""
FARTHEST_M = 200_000.0
"""Greatest distance that is drawn, in m."""
NAME_ABOVE_M = 12.0
"""Height of an actor's name above its reference point, in m."""


def write(run: Result, out: Path) -> list[Path]:
    """Write the run for Foxglove: ``run.mcap``, and ``layout.json`` to import there."""
    mcap, layout = out / "run.mcap", out / "layout.json"
    scene, pictures = Scene(run), RecordedPictures(run)
    context = Context()
    shown = FoxgloveChannels(context, lambda t_ns: t_ns)
    cameras: dict[str, None] = {}
    frequencies: dict[int, None] = {}
    with open_mcap(mcap, context=context):
        shown.give_out(channels.SceneUpdateChannel, SCENE, _scene_update(scene), 0)
        for message in run.messages():
            match message:
                case ActorTruth():
                    moved = _transform(shown, message.t_ns, message.actor, scene.pose(message))
                    shown.give_out(channels.FrameTransformsChannel, TRANSFORMS, moved, message.t_ns)
                case CameraFrame(encoding="rgb8") if jpeg := pictures.jpeg(message):
                    cameras[message.camera] = None
                    pose = scene.camera_pose(message.view)
                    moved = _transform(shown, message.t_frame_ns, message.camera, pose)
                    shown.give_out(channels.FrameTransformsChannel, TRANSFORMS, moved, message.t_ns)
                    shown.show_picture(message, jpeg)
                case Transmission() if pcm := recorded_sound(run, message):
                    frequencies[message.frequency_khz] = None
                    shown.show_sound(message, pcm, message.t_tx_ns)
            if not isinstance(message, dict):
                shown.show(message)
    layout.write_text(_layout([*scene.actors], cameras, frequencies).to_json())
    return [mcap, layout]


def _transform(shown: FoxgloveChannels, t_ns: int, frame: str, pose: Pose) -> FrameTransforms:
    (x, y, z), (qx, qy, qz, qw) = pose.position_m, quaternion(pose.rotation)
    return FrameTransforms(
        transforms=[
            FrameTransform(
                timestamp=shown.timestamp(t_ns),
                parent_frame_id=WORLD,
                child_frame_id=frame,
                translation=Vector3(x=x, y=y, z=z),
                rotation=Quaternion(x=qx, y=qy, z=qz, w=qw),
            )
        ]
    )


# --- the scene ------------------------------------------------------------------------------


def _scene_update(scene: Scene) -> SceneUpdate:
    """Return airport and actors in one message: a display that jumps in time takes the last."""
    airport = [
        SceneEntity(frame_id=WORLD, id=f"{outline.area} {number} {outline.name}", **_area(outline))
        for number, outline in enumerate(scene.outlines())
    ]
    return SceneUpdate(entities=[*airport, *(_actor(scene, actor) for actor in scene.actors)])


def _area(outline: Outline) -> dict[str, Any]:
    colour = _colour(AREA_COLOURS[outline.area])
    points = [Point3(x=x, y=y, z=0.0) for x, y in outline.points]
    if outline.area == "runway":
        fan = [p for pair in pairwise(points[1:-1]) for p in (points[0], *pair)]
        return {"triangles": [TriangleListPrimitive(points=fan, color=colour)]}
    line = LinePrimitive(
        type=LinePrimitiveLineType.LineStrip,
        thickness=LINE_PX,
        scale_invariant=True,
        points=points,
        color=colour,
    )
    return {"lines": [line]}


def _actor(scene: Scene, actor: str) -> SceneEntity:
    mesh = scene.mesh(actor)
    body = TriangleListPrimitive(
        points=[Point3(x=x, y=y, z=z) for x, y, z in mesh.corners.reshape(-1, 3).tolist()],
        colors=[colour for each in srgb_colours(mesh).tolist() for colour in [_colour(each)] * 3],
    )
    name = TextPrimitive(
        pose=FoxglovePose(
            position=Vector3(z=NAME_ABOVE_M), orientation=Quaternion(x=0.0, y=0.0, z=0.0, w=1.0)
        ),
        billboard=True,
        font_size=NAME_SIZE_PX,
        scale_invariant=True,
        color=_colour(scene.colour(actor)),
        text=actor,
    )
    return SceneEntity(frame_id=actor, id=actor, frame_locked=True, triangles=[body], texts=[name])


def _colour(rgb: tuple[int, int, int]) -> Color:
    red, green, blue = (value / 255.0 for value in rgb)
    return Color(r=red, g=green, b=blue, a=1.0)


# --- the layout -----------------------------------------------------------------------------


def _layout(
    actors: Sequence[str], cameras: Iterable[str], frequencies: Iterable[int]
) -> layouts.Layout:
    """Return a layout that shows map, 3-D, cameras, plots, radio and log at once."""
    three_d = layouts.ThreeDeePanel(
        config=layouts.ThreeDeeConfig(
            fixed_frame=WORLD,
            follow_tf=actors[0],
            follow_mode="follow-position",
            camera_state=layouts.ThreeDeeCameraState(
                distance=SEEN_FROM_M, phi=60.0, near=1.0, far=FARTHEST_M
            ),
            topics={SCENE: layouts.BaseRendererSceneUpdateTopicSettings(visible=True)},
        )
    )
    pictures = [
        layouts.ImagePanel(
            title=camera,
            config=layouts.ImageConfig(
                image_mode=layouts.ImageModeConfig(
                    image_topic=f"/camera/{camera}/frame",
                    calibration_topic=f"/camera/{camera}/calibration",
                    annotations={
                        f"/vision/{camera}": layouts.ImageAnnotationSettings(visible=True)
                    },
                )
            ),
        )
        for camera in cameras
    ]
    plots = [
        _plot("Altitude, m", actors, "altitude"),
        _plot("Vertical speed, m/s", actors, "velocity.z"),
    ]
    radio = [
        layouts.AudioPanel(
            title=f"{frequency_khz} kHz",
            config=layouts.AudioConfig(topic=f"/radio/{frequency_khz}/tx"),
        )
        for frequency_khz in frequencies
    ]
    log = layouts.LogPanel(config=layouts.LogConfig(topic_to_render=LOG))
    map_panel = layouts.MapPanel(config=layouts.MapConfig(layer="map"))
    columns = [[map_panel, three_d], [*pictures, *plots], [log, *radio]]
    return layouts.Layout(content=_split("row", [_split("column", each) for each in columns]))


def _plot(title: str, actors: Sequence[str], value: str) -> layouts.PlotPanel:
    series = [
        layouts.PlotSeries(value=f"{truth_topic(actor)}.{value}", label=actor, enabled=True)
        for actor in actors
    ]
    return layouts.PlotPanel(title=title, config=layouts.PlotConfig(paths=series))


def _split(direction: Any, parts: list[Any]) -> layouts.SplitContainer:
    share = 1.0 / len(parts)
    items = [layouts.SplitItem(proportion=share, content=part) for part in parts]
    return layouts.SplitContainer(direction=direction, items=items)
