"""The cameras of a run: when they expose, and what they publish."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from airhilt.errors import CameraError, RendererError
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.imaging.masks import runs_of
from airhilt.imaging.view import View
from airhilt.messages import (
    CameraFrame,
    CameraInfo,
    CameraTruth,
    CameraView,
    SightingTruth,
)
from airhilt.scenario.models import Camera
from airhilt.sensors.base import Publish
from airhilt.sensors.cameras.frame import Frame
from airhilt.sensors.cameras.mounts import local_frame_of
from airhilt.sensors.cameras.scene.bodies import BodyState, states_of
from airhilt.sim import Director, Priority
from airhilt.units import DEGREE, SECOND_NS, seconds_to_ns
from airhilt.world.actors.actor import Actor
from airhilt.world.site import ScenarioSite


class FrameSource(Protocol):
    """Source of the pictures of all cameras that are due at an instant."""

    own_aircraft: Mapping[str, npt.NDArray[np.bool_]]
    """Pixels that a camera's own aircraft may cover, by camera."""

    def shoot(self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int) -> list[Frame]:
        """Take the pictures.

        Raises
        ------
        RendererError
            It cannot, and never will again.
        """
        ...


@dataclass(frozen=True)
class Exposures:
    """The exposure times of a camera: evenly spaced, without drift.

    Attributes
    ----------
    phase_ns
        End of the first exposure.
    """

    rate_hz: float
    phase_ns: int

    def end_ns(self, seq: int) -> int:
        """Return when an exposure ends."""
        return self.phase_ns + round(seq * SECOND_NS / self.rate_hz)


class CameraSensor:
    """Lets the cameras of a scenario expose, all that are due at an instant in one pass.

    A picture is published at the end of its exposure; drawing it takes no simulation time. The
    camera of an aircraft that has come to its end gives no more pictures.

    Parameters
    ----------
    state_at_ns
        Returns the time that the states of the actors are of.
    lost
        Called with the cause when there will be no more pictures.
    """

    def __init__(
        self,
        director: Director,
        frame_source: FrameSource,
        cameras: Sequence[Camera],
        site: ScenarioSite,
        actors: Mapping[str, Actor],
        *,
        state_at_ns: Callable[[], int],
        publish: Publish,
        lost: Callable[[str], None],
    ) -> None:
        self._director = director
        self._frame_source = frame_source
        self._cameras = {camera.name: camera for camera in cameras}
        self._local_frame = local_frame_of(site)
        self._ground_m = site.ground_m
        self._actors = actors
        self._state_at_ns = state_at_ns
        self._publish = publish
        self._lost = lost
        self._exposures = {
            camera.name: Exposures(camera.rate_hz, seconds_to_ns(camera.phase_s))
            for camera in cameras
        }
        self._taken = dict.fromkeys(self._cameras, 0)
        self._sha256: dict[str, str] = {}

    def start(self) -> None:
        """Publish what never changes about each camera, and schedule the first exposures."""
        for camera in self._cameras.values():
            own = self._frame_source.own_aircraft.get(camera.name)
            self._publish(
                f"camera/{camera.name}/info",
                CameraInfo(
                    t_ns=self._director.now_ns,
                    camera=camera.name,
                    rate_hz=camera.rate_hz,
                    width_px=camera.width_px,
                    height_px=camera.height_px,
                    horizontal_fov_deg=camera.horizontal_fov_deg,
                    carrier=camera.carrier,
                    own_aircraft=() if own is None else runs_of(own),
                ),
            )
        self._schedule()

    def _schedule(self) -> None:
        due_ns = min(self._due_ns(name) for name in self._cameras)
        self._director.at(due_ns, self._expose, Priority.SENSOR)

    def _due_ns(self, name: str) -> int:
        return self._exposures[name].end_ns(self._taken[name])

    def _expose(self) -> None:
        """Take the pictures of all cameras that are due now."""
        now_ns = self._director.now_ns
        due = [name for name in self._cameras if self._due_ns(name) == now_ns]
        able = [name for name in due if not self._has_ended(self._cameras[name])]
        try:
            frames = self._frame_source.shoot(able, self._bodies(), now_ns) if able else []
        except (CameraError, RendererError) as error:
            self._lost(str(error))
            return
        for frame in frames:
            self._publish_frame(frame, self._taken[frame.camera])
        for name in due:
            self._taken[name] += 1
        self._schedule()

    def _has_ended(self, camera: Camera) -> bool:
        carrier = camera.carrier
        return carrier is not None and self._actors[carrier].body.ended is not None

    def _bodies(self) -> list[BodyState]:
        return states_of(
            self._actors.values(),
            self._local_frame,
            self._ground_m,
            self._director.now_ns,
            self._state_at_ns(),
        )

    def _publish_frame(self, frame: Frame, seq: int) -> None:
        now_ns, name = self._director.now_ns, frame.camera
        pixels = frame.colour.tobytes()
        if not frame.unchanged or name not in self._sha256:
            self._sha256[name] = hashlib.sha256(pixels).hexdigest()
        header = CameraFrame(
            t_ns=now_ns,
            camera=name,
            seq=seq,
            t_frame_ns=now_ns,
            view=view_message(frame.view, self._local_frame, self._cameras[name].carrier),
            sha256=self._sha256[name],
        )
        truth = CameraTruth(
            t_ns=now_ns,
            camera=name,
            seq=seq,
            t_frame_ns=now_ns,
            sightings=tuple(SightingTruth(**asdict(each)) for each in frame.sightings),
        )
        self._publish(f"truth/camera/{name}", truth)
        self._publish(f"camera/{name}/frame", header, raw=pixels)


def view_message(view: View, local_frame: LocalFrame, carrier: str | None) -> CameraView:
    """Return a view as a message."""
    east, north, up = view.pose.position_m
    latitude, longitude = local_frame.to_place(east, north)
    heading, pitch, roll = angles_of(view.pose.rotation)
    lens = view.intrinsics
    return CameraView(
        latitude_deg=latitude / DEGREE,
        longitude_deg=longitude / DEGREE,
        height_m=up,
        heading_deg=heading / DEGREE % 360.0 % 360.0,  # The first gives 360 for -1e-15.
        pitch_deg=pitch / DEGREE,
        roll_deg=roll / DEGREE,
        horizontal_fov_deg=lens.horizontal_fov_rad / DEGREE,
        width_px=lens.width_px,
        height_px=lens.height_px,
        carrier=carrier,
    )


def angles_of(rotation: npt.NDArray[np.float64]) -> tuple[float, float, float]:
    """Return heading, pitch and roll (rad) of an attitude, the inverse of `view.attitude`."""
    right, ahead, up = rotation[:, 0], rotation[:, 1], rotation[:, 2]
    heading = math.atan2(ahead[0], ahead[1])
    pitch = math.asin(min(max(float(ahead[2]), -1.0), 1.0))
    roll = math.atan2(-right[2], up[2])
    return heading, pitch, roll
