"""Builds the scene of a scenario, and what draws it."""

from __future__ import annotations

from collections.abc import Sequence

from airhilt.scenario import Scenario
from airhilt.scenario.models import Airborne, Daylight, Weather
from airhilt.sensors.cameras import AUTO
from airhilt.sensors.cameras.mounts import Camera, cameras_of, find_camera, local_frame_of
from airhilt.sensors.cameras.scene.bodies import Model, model_of
from airhilt.sensors.cameras.scene.illumination import Illumination, sun_direction
from airhilt.sensors.cameras.scene.landscape import Landscape, airport_landscape, open_country
from airhilt.sensors.cameras.scene.rain import rain_visibility_m
from airhilt.sensors.cameras.scene_renderer import SceneRenderer
from airhilt.units import FOOT
from airhilt.world.site import ScenarioSite

FOGGY_M = 3000.0
HAZY_M = 8000.0
"""Visibilities between which the blue of the sky fades, in m."""
BACKGROUND_EN_ROUTE = 5.0
"""Factor by which ground and clouds are seen farther than bodies en route: haze gets thinner with
height, and the scenario's visibility is that at the height of the camera."""
CLOUDS_UNDER_TRAFFIC = 0.6
"""Height of the cloud tops as a share of the lowest flight's height: no cloud hides a flight."""
LOWEST_CLOUDS_M = 400.0


def light_of(scenario: Scenario, site: ScenarioSite) -> Illumination:
    """Return the illumination of a scenario."""
    latitude_rad, _ = local_frame_of(site).origin
    en_route = site.layout is None
    texture = scenario.appearance.texture
    return air_and_sun(scenario.weather, scenario.daylight, texture, latitude_rad, en_route)


def air_and_sun(
    weather: Weather, daylight: Daylight, texture: float, latitude_rad: float, en_route: bool
) -> Illumination:
    """Return the illumination of a place; rain reduces the visibility."""
    rain_m = rain_visibility_m(weather.rain_mm_h)
    visibility = 1.0 / (1.0 / weather.visibility_m + 1.0 / rain_m)
    thick = (HAZY_M - weather.visibility_m) / (HAZY_M - FOGGY_M)
    overcast = 1.0 if weather.rain_mm_h > 0.0 else min(max(thick, 0.0), 1.0)
    sun = sun_direction(latitude_rad, daylight.date, daylight.solar_time_h)
    background = BACKGROUND_EN_ROUTE if en_route else 1.0
    return Illumination(
        sun,
        visibility,
        overcast,
        background,
        texture,
        clouds=weather.cloud_cover,
        wet=weather.rain_mm_h > 0.0,
    )


def landscape_of(
    scenario: Scenario, site: ScenarioSite, light: Illumination, is_kept: bool = False
) -> Landscape:
    """Return the landscape of a scenario; that of an airport from the cache if it is kept there."""
    if site.layout is not None:
        return airport_landscape(site.layout, light, is_kept)
    heights = [
        actor.initial.altitude_ft * FOOT - site.ground_m
        for actor in scenario.actors
        if isinstance(actor.initial, Airborne)
    ]
    tops = CLOUDS_UNDER_TRAFFIC * min(heights, default=0.0)
    clouds = tops if tops > LOWEST_CLOUDS_M else None
    name = f"{site.centre.lat_deg:.3f} {site.centre.lon_deg:.3f}"
    return open_country(light, name, clouds)


def open_scene_renderer(
    scenario: Scenario,
    site: ScenarioSite,
    names: Sequence[str] | None = None,
    renderer: str = AUTO,
    supersampling: int = 1,
    keeps_backgrounds: bool = False,
    shares_pictures: bool = False,
) -> SceneRenderer:
    """Return the renderer for cameras of a scenario: those named, or those that it declares.

    Raises
    ------
    CameraError
        There is no such camera, or it could see nothing.
    RendererError
        The renderer cannot be opened.
    """
    models: dict[str, Model] = {
        actor.callsign: model_of(actor, scenario.files) for actor in scenario.actors
    }
    known = cameras_of(scenario, site)
    wanted = [camera.name for camera in scenario.cameras] if names is None else names
    cameras: list[Camera] = [find_camera(known, name) for name in wanted]
    light = light_of(scenario, site)
    landscape = landscape_of(scenario, site, light, keeps_backgrounds)
    return SceneRenderer(
        landscape, light, models, cameras, renderer, scenario.weather.rain_mm_h, supersampling,
        keeps_backgrounds, shares_pictures,
    )  # fmt: skip
