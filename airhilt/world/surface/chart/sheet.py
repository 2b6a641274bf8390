"""The map of a diagram, layer by layer."""

from __future__ import annotations

import math
from collections.abc import Iterator
from importlib import resources
from itertools import chain
from xml.sax.saxutils import escape

from shapely import Polygon, box

from airhilt.world.surface import path as lines
from airhilt.world.surface.chart import svg
from airhilt.world.surface.chart.labels import Labels
from airhilt.world.surface.chart.margin import margin
from airhilt.world.surface.chart.view import HEADER_PX, View, view_of
from airhilt.world.surface.ground_plan import (
    CameraShape,
    GroundPlan,
    RunwayEndShape,
    RunwayShape,
    ground_plan,
)
from airhilt.world.surface.layout import Layout
from airhilt.world.surface.path import Local

CAMERA_REACH_PX = 26.0
"""Length of the wedge that shows where a camera looks, in px."""


def as_svg(layout: Layout) -> str:
    """Return the diagram of an airport as an SVG document."""
    airport, plan = layout.airport, ground_plan(layout)
    view = view_of(plan)
    labels = Labels(plan, view)
    parts = chain(
        _ground(plan, view),
        _taxiways(plan, view),
        *(_runway(runway, view) for runway in plan.runways),
        _holds(plan, view),
        _buildings(plan, view),
        labels.buildings(),
        _tower(plan, view),
        _cameras(plan, view),
        labels.runways(),
        labels.taxiways(),
        margin(airport, plan, view),
    )
    size = f"{view.width:.0f}", f"{view.height:.0f}"
    style = resources.files(__package__).joinpath("style.css").read_text("utf-8")
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{size[0]}" height="{size[1]}" '
            f'viewBox="0 0 {size[0]} {size[1]}" role="img">',
            f"<title>{escape(airport.name)} ({airport.icao})</title>",
            f"<style>\n{style}</style>",
            *parts,
            "</svg>\n",
        ]
    )


def _ground(plan: GroundPlan, view: View) -> Iterator[str]:
    yield '<rect class="page" width="100%" height="100%"/>'
    place = f'x="0" y="{HEADER_PX}" width="{view.width:.0f}" height="{view.map_height:.0f}"'
    yield f'<clipPath id="map"><rect {place}/></clipPath>'
    yield f'<rect class="land" {place}/>'
    window = box(0.0, HEADER_PX, view.width, HEADER_PX + view.map_height)
    for water in plan.water:
        outline = view.all(water.outline)
        yield svg.area("water", outline, water.name, ' clip-path="url(#map)"')
        visible = Polygon(outline).buffer(0.0).intersection(window)
        if not visible.is_empty:
            at, half = visible.representative_point(), 4.5 * len(water.name)
            x = min(max(at.x, half), view.width - half)
            yield svg.text("name", (x, at.y), water.name)
    for runway in plan.runways:
        outline = view.all(runway.protected)
        yield svg.area("protected", outline, f"protected area of {runway.name}")


def _taxiways(plan: GroundPlan, view: View) -> Iterator[str]:
    for leg in plan.taxiway_legs:
        width = max(leg.width_m * view.scale, 2.5)
        yield svg.line("taxiway", view.leg(leg.ends), f' style="stroke-width:{width:.1f}"')
    for leg in plan.taxiway_legs:
        yield svg.line("guide", view.leg(leg.ends))
    for stand in plan.stands:
        yield svg.circle("stand", view(stand.place), 3.0, stand.name)


def _runway(runway: RunwayShape, view: View) -> Iterator[str]:
    yield svg.area("runway", view.all(runway.pavement), runway.name)
    dashes = ' style="stroke-width:0.9" stroke-dasharray="9 7"'
    yield svg.line("marking", view.leg(runway.centreline), dashes)
    for end in runway.ends:
        yield from _threshold(end, view)


def _threshold(end: RunwayEndShape, view: View) -> Iterator[str]:
    """Yield the bar of a threshold, and an arrow before it if it is displaced."""
    threshold = view(end.threshold)
    ahead = lines.unit(view(end.start), view(end.far_end))
    across = (-ahead[1], ahead[0])
    half = end.width_m * view.scale / 2.0
    bar = lines.step(threshold, across, -half), lines.step(threshold, across, half)
    yield svg.line("marking", bar, ' style="stroke-width:2"')
    if end.displaced_m:
        tip = lines.step(threshold, ahead, -6.0)
        for side in (-1, 1):
            wing = lines.step(lines.step(tip, ahead, -6.0), across, side * half)
            yield svg.line("marking", (tip, wing), ' style="stroke-width:1.2"')


def _holds(plan: GroundPlan, view: View) -> Iterator[str]:
    for hold in plan.holds:
        ends = view.leg(hold.ends(least_half_m=5.0 / view.scale))
        yield svg.line("hold", ends, name=f"hold {hold.name}")
    for crossing in plan.intersections:
        yield svg.circle("crossing", view(crossing.place), 9.0, crossing.name)


def _buildings(plan: GroundPlan, view: View) -> Iterator[str]:
    for building in plan.buildings:
        yield svg.area("building", view.all(building.outline), building.name)


def _tower(plan: GroundPlan, view: View) -> Iterator[str]:
    if plan.tower is not None:
        x, y = view(plan.tower)
        triangle = [(x, y - 9.0), (x + 6.0, y + 5.0), (x - 6.0, y + 5.0)]
        yield svg.area("tower", triangle, "tower")


def _cameras(plan: GroundPlan, view: View) -> Iterator[str]:
    for camera in plan.cameras:
        yield svg.area("camera", _wedge(camera, view), camera.name)


def _wedge(camera: CameraShape, view: View) -> list[Local]:
    """Return the outline of what a camera looks at, cut off near it."""
    at = view(camera.place)
    angles = [
        math.radians(camera.azimuth_deg + part * camera.horizontal_fov_deg)
        for part in (-0.5, -0.25, 0.0, 0.25, 0.5)
    ]
    rim = [
        (at[0] + CAMERA_REACH_PX * math.sin(a), at[1] - CAMERA_REACH_PX * math.cos(a))
        for a in angles
    ]
    return [at, *rim]
