"""Places bodies in front of the camera of a random scene, and moves them on."""

from __future__ import annotations

import math

import numpy as np
from shapely import Point

from airhilt.imaging.view import Pose, View
from airhilt.sensors.cameras.dataset.scenes import AIRCRAFT, BIRDS, KINDS, Sitting
from airhilt.sensors.cameras.scene.bodies import BodyState, Model
from airhilt.sensors.cameras.scene.illumination import EXTINCTION
from airhilt.units import DEGREE
from airhilt.world.surface.layout import Layout

SMALLEST_PX, LARGEST_PX = 5.0, 250.0
"""Least and greatest size of bodies in pixels; sizes are spread evenly in their logarithm."""
FAINTEST = 0.03
"""Part of a body's contrast that the air must leave for it to be placed."""
FARTHEST_M = 20_000.0
TRIES = 15
"""Number of tries to place a body within a picture; some pictures have no room for one."""
ROLLING_BELOW_M = 10.0
GROUND_M_S, AIR_M_S, BIRD_M_S = 8.0, 75.0, 15.0
DESCENT = math.tan(3.0 * DEGREE)
WOBBLE_RAD, WOBBLE_HZ = 0.4 * DEGREE, 0.3
"""Amplitude and frequency of pitch and roll in flight."""
_EXTENT_M = {kind: extent for _, group in KINDS for kind, _, extent in group}
_OFTEN = {kind: often for _, group in KINDS for kind, often, _ in group}
_FLYING = frozenset(kind for kind, *_ in (*AIRCRAFT, *BIRDS))


def cast(
    sitting: Sitting, camera: str, draws: np.random.Generator, empty: float
) -> list[BodyState]:
    """Return the bodies in front of a camera.

    Parameters
    ----------
    empty
        Part of the pictures that have nobody in them.
    """
    bodies: dict[str, BodyState] = {}
    chosen = sitting.cameras[camera]
    if not isinstance(chosen.at, Pose):
        carrier = chosen.at.actor
        bodies[carrier] = _carrier(sitting, carrier, draws)
    view = chosen.view(bodies)
    count = 0 if draws.random() < empty else 1 + int(draws.integers(6))
    free = [actor for actor in sitting.models if not actor.startswith("carrier")]
    if sitting.layout is None:
        free = [actor for actor in free if _kind(actor) in _FLYING]
    for _ in range(count):
        often = np.array([_OFTEN[_kind(actor)] for actor in free], dtype=float)
        actor = free.pop(int(draws.choice(len(free), p=often / often.sum())))
        body = _placed(sitting, actor, view, draws)
        if body is not None:
            bodies[actor] = body
    return list(bodies.values())


def gone_on(body: BodyState, t_s: float) -> BodyState:
    """Return where a body is after some time: on the ground, or in flight and on the way down."""
    is_bird = body.shape.startswith("flying")
    rolling = body.up_m < ROLLING_BELOW_M and not is_bird
    way = t_s * (GROUND_M_S if rolling else BIRD_M_S if is_bird else AIR_M_S)
    sinks = body.shape == "gear" and not rolling
    sink = min(way * DESCENT, 0.8 * body.up_m) if sinks else 0.0
    wobble = 0.0 if rolling else WOBBLE_RAD * math.sin(math.tau * WOBBLE_HZ * t_s)
    return body._replace(
        east_m=body.east_m + way * math.sin(body.heading_rad),
        north_m=body.north_m + way * math.cos(body.heading_rad),
        up_m=body.up_m - sink,
        pitch_rad=body.pitch_rad + wobble,
        roll_rad=body.roll_rad + wobble,
    )


def _carrier(sitting: Sitting, actor: str, draws: np.random.Generator) -> BodyState:
    """Return an aircraft that carries a camera: on the ground, on final, or in flight."""
    kind = sitting.models[actor].aircraft
    assert kind is not None
    layout = sitting.layout
    choice = draws.random()
    if layout is not None and choice < 0.35:
        (east, north), heading = _on_pavement(layout, draws)
        wheels = kind.dimensions.wheel_height_offset_m
        return BodyState(actor, east, north, wheels, heading, 0.0, 0.0, "gear", True)
    if layout is not None and choice < 0.7:
        (east, north, up), heading = _on_final(layout, draws)
    else:
        east, north = (float(value) for value in draws.uniform(-4000.0, 4000.0, size=2))
        up = float(draws.uniform(120.0, 1500.0))
        heading = float(draws.uniform(0.0, math.tau))
        if layout is None:
            up = sitting.height_m * float(draws.uniform(0.95, 1.1))
    pitch, roll = _attitude(draws)
    shape = "gear" if up < 600.0 else "clean"
    return BodyState(actor, east, north, up, heading, pitch, roll, shape, up < 3048.0)


def _kind(actor: str) -> str:
    return actor.rpartition("-")[0]


def _placed(
    sitting: Sitting, actor: str, view: View, draws: np.random.Generator
) -> BodyState | None:
    """Return a body somewhere in a picture; None if no place for it was found."""
    kind = _kind(actor)
    model = sitting.models[actor]
    aloft = kind in _FLYING and (sitting.layout is None or draws.random() < 0.6)
    wheels = 0.0
    if model.aircraft is not None:
        wheels = model.aircraft.dimensions.wheel_height_offset_m
    seen_m = min(-math.log(FAINTEST) / EXTINCTION * sitting.light.visibility_m, FARTHEST_M)
    lens = view.intrinsics
    for _ in range(TRIES):
        size = math.exp(draws.uniform(math.log(SMALLEST_PX), math.log(LARGEST_PX)))
        # What is seen of the greatest extent, from most sides.
        away = 0.85 * _EXTENT_M[kind] * lens.focal_px / size
        if away > seen_m or away < _EXTENT_M[kind]:
            continue
        place = _place(sitting, view, away, aloft, wheels, draws)
        if place is None:
            continue
        position, heading = place
        at = view.in_camera(position)
        if at[2] <= 0.0 or math.dist(position, view.pose.position_m) > seen_m:
            continue
        column, row = view.pixels(at)
        if not (0.0 <= column < lens.width_px and 0.0 <= row < lens.height_px):
            continue
        if any(
            position[2] < block.height_m and block.outline.covers(Point(*position[:2]))
            for block in sitting.landscape.blocks
        ):
            continue
        return _body(actor, model, position, heading, aloft, draws)
    return None


def _place(
    sitting: Sitting,
    view: View,
    away_m: float,
    aloft: bool,
    wheels_m: float,
    draws: np.random.Generator,
) -> tuple[tuple[float, float, float], float] | None:
    """Return a place and a heading, in the picture or not."""
    camera = view.pose.position_m
    heading = float(draws.uniform(0.0, math.tau))
    choice = draws.random()
    if aloft:
        if sitting.layout is not None and choice < 0.2:
            return _on_final(sitting.layout, draws)
        column = np.array([draws.uniform(0.0, view.intrinsics.width_px)], dtype=np.float32)
        row = np.array([draws.uniform(0.0, view.intrinsics.height_px)], dtype=np.float32)
        towards = view.directions(column, row)[:, 0]
        east, north, up = (
            float(at + away_m * part) for at, part in zip(camera, towards, strict=True)
        )
        if up < wheels_m + 3.0:
            return None
        if choice > 0.5:
            # It comes, or is being overtaken.
            side = 1.0 if choice > 0.65 else -1.0
            course = math.atan2(side * (camera[0] - east), side * (camera[1] - north))
            heading = course + float(draws.normal(0.0, 15.0)) * DEGREE
        return (east, north, up), heading
    if sitting.layout is not None and choice < 0.3:
        (east, north), heading = _on_pavement(sitting.layout, draws)
        return (east, north, wheels_m), heading
    if away_m <= camera[2]:
        return None
    level = math.sqrt(away_m**2 - camera[2] ** 2)
    ahead = view.pose.rotation[:, 1]
    side = float(draws.uniform(-0.5, 0.5)) * view.intrinsics.horizontal_fov_rad
    azimuth = math.atan2(ahead[0], ahead[1]) + side
    east = camera[0] + level * math.sin(azimuth)
    north = camera[1] + level * math.cos(azimuth)
    return (east, north, wheels_m), heading


def _body(
    actor: str,
    model: Model,
    position: tuple[float, float, float],
    heading: float,
    aloft: bool,
    draws: np.random.Generator,
) -> BodyState:
    east, north, up = position
    if model.aircraft is not None:
        pitch, roll = _attitude(draws) if aloft else (0.0, 0.0)
        low = up < 600.0 and (not aloft or draws.random() < 0.7)
        lit = up < 3048.0 and draws.random() < (0.9 if aloft else 0.5)
        return BodyState(
            actor, east, north, up, heading, pitch, roll, "gear" if low else "clean", lit
        )
    shapes = [name for name in model.shapes if name.startswith("flying") == aloft]
    shape = shapes[int(draws.integers(len(shapes)))]
    return BodyState(actor, east, north, up, heading, 0.0, 0.0, shape, True)


def _attitude(draws: np.random.Generator) -> tuple[float, float]:
    """Return pitch and roll in flight: most fly straight, some turn."""
    bank = 3.0 if draws.random() < 0.7 else 18.0
    return float(draws.normal(2.0, 3.0)) * DEGREE, float(draws.normal(0.0, bank)) * DEGREE


def _on_final(
    layout: Layout, draws: np.random.Generator
) -> tuple[tuple[float, float, float], float]:
    """Return a place on the glide path of a runway, and the heading of who flies there."""
    ends = [end for strip in layout.strips.values() for end in strip.ends]
    end = ends[int(draws.integers(len(ends)))]
    east, north = layout.local_frame.to_local(end.threshold)
    before = math.exp(draws.uniform(math.log(150.0), math.log(12_000.0)))
    aside = float(draws.normal(0.0, 0.01)) * before
    sin, cos = math.sin(end.course_rad), math.cos(end.course_rad)
    up = 18.0 + before * math.tan(end.glide_path_rad + float(draws.normal(0.0, 0.003)))
    place = east - before * sin + aside * cos, north - before * cos - aside * sin, up
    return place, end.course_rad + float(draws.normal(0.0, 2.0)) * DEGREE


def _on_pavement(layout: Layout, draws: np.random.Generator) -> tuple[tuple[float, float], float]:
    """Return a place on a runway or a taxiway, and a heading along it."""
    airport = layout.airport
    edges = airport.taxiways.edges
    if edges and draws.random() < 0.6:
        nodes = edges[int(draws.integers(len(edges)))].nodes
        start, end = (np.asarray(layout.local_frame.to_local(layout.node(name))) for name in nodes)
    else:
        strip = list(layout.strips.values())[int(draws.integers(len(layout.strips)))]
        start, end = (np.asarray(corner) for corner in strip.centreline.coords)
    if draws.random() < 0.5:
        start, end = end, start
    east, north = start + float(draws.random()) * (end - start)
    along = end - start
    return (float(east), float(north)), math.atan2(along[0], along[1])
