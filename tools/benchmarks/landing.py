"""A landing at Washington before cameras: its bodies for a renderer, and the scenario of a run."""

from __future__ import annotations

import math

from airhilt import load
from airhilt.geodesy.positions import RunwayPosition
from airhilt.imaging.view import Intrinsics, Pose
from airhilt.scenario import Scenario
from airhilt.sensors.cameras.mounts import Camera, Mount, cameras_of, local_frame_of
from airhilt.sensors.cameras.scene.bodies import BodyState, Model, aircraft_model, kind_model
from airhilt.sensors.cameras.scene.builder import landscape_of, light_of
from airhilt.sensors.cameras.scene_renderer import SceneRenderer
from airhilt.units import DEGREE, FOOT
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.airport import load_airport


class LandingScene:
    """Washington: a 737 on final to runway 01, a 747 and a fire truck on it, and two cameras."""

    def __init__(self) -> None:
        scenario = load("s01b_nominal")
        self._site = ScenarioSite.of(scenario)
        self._light = light_of(scenario, self._site)
        self._landscape = landscape_of(scenario, self._site, self._light)
        self._models: dict[str, Model] = {
            "737": aircraft_model("737"),
            "B747": aircraft_model("B747"),
            "fire_truck": kind_model("fire_truck"),
        }
        nose = Mount("737", Pose.of((0.0, 17.5, 1.0), 0.0, -0.03), sees_own_aircraft=False)
        self._cameras = [
            cameras_of(scenario, self._site)["runway_01"],
            Camera("nose", Intrinsics(640, 360, math.radians(60.0)), nose),
        ]

    def renderer(self, renderer: str) -> SceneRenderer:
        """Return a renderer with both cameras."""
        return SceneRenderer(self._landscape, self._light, self._models, self._cameras, renderer)

    def bodies(self, turn_rad: float = 0.0) -> list[list[BodyState]]:
        """Return where all are in the pictures of a second, 70 m/s down a path of 3 degrees."""
        return [
            [
                self._body("737", 4.4 * k - 700.0, 45.0 - 0.23 * k, turn_rad * k, "gear"),
                self._body("B747", 900.0 + k, 4.1, 1.2, "gear"),
                self._body("fire_truck", 500.0 + k, 0.0, 1.5, "body"),
            ]
            for k in range(16)
        ]

    def _body(
        self, actor: str, along_m: float, up_m: float, turned: float, shape: str
    ) -> BodyState:
        assert self._site.layout is not None
        course = self._site.layout.runway("01").course_rad
        place = RunwayPosition(type="runway", runway="01", along_m=along_m)
        east, north = local_frame_of(self._site).to_local(self._site.place(place))
        return BodyState(actor, east, north, up_m, course + turned, 0.0, 0.0, shape, True)


def watched_landing() -> Scenario:
    """Return a minute of a landing before a tower, a runway, a nose and a tail camera."""
    document = load("s01b_nominal").model_dump(mode="json")
    document |= {"name": "watched", "duration_s": 60.0, "end_when": [], "cameras": []}
    for camera in load_airport("KDCA").cameras:
        if camera.name in ("tower_south", "runway_01"):
            latitude, longitude = (angle / DEGREE for angle in camera.place)
            place = {"type": "geodetic", "lat_deg": latitude, "lon_deg": longitude}
            mount = {
                "type": "fixed",
                "position": place,
                "height_ft": camera.height_m / FOOT,
                "azimuth_deg": camera.azimuth_deg,
                "elevation_deg": camera.elevation_deg,
            }
            fov_deg = camera.horizontal_fov_deg
            document["cameras"].append(
                {"name": camera.name, "mount": mount, "horizontal_fov_deg": fov_deg}
            )
    document["cameras"] += [
        {"name": station, "mount": {"type": "actor", "actor": "AAL123", "station": station}}
        for station in ("nose", "tail")
    ]
    return Scenario.model_validate(document)
