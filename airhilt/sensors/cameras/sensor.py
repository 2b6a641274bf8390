"""The cameras of a run: when they expose, and what they publish."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Literal

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
from airhilt.sensors.cameras.body_states import states_of
from airhilt.sensors.cameras.frame import CameraPicture, PictureSource
from airhilt.sensors.cameras.mounts import local_frame_of
from airhilt.sim import Director, Priority
from airhilt.sim.payload import Payload
from airhilt.units import DEGREE, SECOND_NS, seconds_to_ns
from airhilt.world.actors.actor import Actor
from airhilt.world.site import ScenarioSite

NO_PIXELS_SHA256 = hashlib.sha256(b"").hexdigest()


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

    def begins_second(self, seq: int) -> bool:
        """Return whether an exposure is the first of its second; seconds begin with exposure 0."""
        before, now = (
            (self.end_ns(each) - self.phase_ns) // SECOND_NS for each in (max(seq - 1, 0), seq)
        )
        return seq == 0 or now > before


class CameraSensor:
    """Schedules the exposures of a scenario's cameras; those due at an instant share one pass.

    A picture is published at the end of its exposure; drawing it takes no simulation time. The
    camera of an aircraft that has come to its end gives no more pictures.

    With adaptive exposure a camera exposes once a second until a body would cover two pixels, and
    at its rate from then on. Of an exposure that is left out only the header is published, so that
    workers take their turns at the same times as with all pictures.

    Parameters
    ----------
    is_adaptive
        True for adaptive exposure.
    state_at_ns
        Returns the time that the states of the actors are of.
    publish
        Called with a key and a message; ``raw`` is the payload of a key whose message is only its
        header.
    lost
        Called when there will be no more pictures, with the cause, and true if that is of the
        machine.
    loss
        Time at which an earlier run, which is replayed, lost its pictures, in ns, and the cause;
        None if it did not.
    """

    def __init__(
        self,
        director: Director,
        source: PictureSource,
        cameras: Sequence[Camera],
        site: ScenarioSite,
        actors: Mapping[str, Actor],
        *,
        is_adaptive: bool = False,
        state_at_ns: Callable[[], int],
        publish: Callable[..., None],
        lost: Callable[[str, bool], None],
        loss: tuple[int, str] | None = None,
    ) -> None:
        self._director = director
        self._source = source
        self._cameras = {camera.name: camera for camera in cameras}
        self._local_frame = local_frame_of(site)
        self._ground_m = site.ground_m
        self._actors = actors
        self._state_at_ns = state_at_ns
        self._publish = publish
        self._lost = lost
        self._loss = loss
        self._exposures = {
            camera.name: Exposures(camera.rate_hz, seconds_to_ns(camera.phase_s))
            for camera in cameras
        }
        self._passed = dict.fromkeys(self._cameras, 0)
        """Number of exposures that are over, by camera."""
        self._sparse = set(self._cameras) if is_adaptive else set()
        """Cameras that expose once a second."""

    def start(self) -> None:
        """Publish what never changes about each camera, and schedule the first exposures."""
        for camera in self._cameras.values():
            own = self._source.own_aircraft.get(camera.name)
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
        return self._exposures[name].end_ns(self._passed[name])

    def _expose(self) -> None:
        """Take the pictures of all cameras that are due now."""
        now_ns = self._director.now_ns
        due = [name for name in self._cameras if self._due_ns(name) == now_ns]
        able = [name for name in due if not self._has_ended(self._cameras[name])]
        if able and self._loss is not None and now_ns >= self._loss[0]:
            self._lost(self._loss[1], False)
            return
        try:
            left_out, pictures = self._look(able, now_ns) if able else ({}, {})
        except (CameraError, RendererError) as error:
            self._lost(str(error), error.is_of_machine)
            return
        for name in able:
            if name in left_out:
                self._publish_frame(name, left_out[name], "none", NO_PIXELS_SHA256, b"")
            else:
                self._publish_picture(pictures[name])
        for name in due:
            self._passed[name] += 1
        self._schedule()

    def _look(
        self, names: Sequence[str], now_ns: int
    ) -> tuple[dict[str, View], dict[str, CameraPicture]]:
        """Return the views of cameras whose exposures are left out, and the pictures of others."""
        bodies = states_of(
            self._actors.values(), self._local_frame, self._ground_m, now_ns, self._state_at_ns()
        )
        doubtful = [
            name
            for name in names
            if name in self._sparse and not self._exposures[name].begins_second(self._passed[name])
        ]
        prospects = self._source.prospects(doubtful, bodies, now_ns) if doubtful else {}
        self._sparse -= {name for name, prospect in prospects.items() if prospect.has_body}
        left_out = {name: each.view for name, each in prospects.items() if not each.has_body}
        taken = [name for name in names if name not in left_out]
        pictures = self._source.take(taken, bodies, now_ns) if taken else []
        return left_out, {picture.camera: picture for picture in pictures}

    def _has_ended(self, camera: Camera) -> bool:
        carrier = camera.carrier
        return carrier is not None and self._actors[carrier].body.ended is not None

    def _publish_picture(self, picture: CameraPicture) -> None:
        now_ns, name = self._director.now_ns, picture.camera
        truth = CameraTruth(
            t_ns=now_ns,
            camera=name,
            seq=self._passed[name],
            t_frame_ns=now_ns,
            sightings=tuple(SightingTruth(**asdict(each)) for each in picture.sightings),
        )
        self._publish(f"truth/camera/{name}", truth)
        self._publish_frame(name, picture.view, "rgb8", picture.sha256, picture.pixels)

    def _publish_frame(
        self, name: str, view: View, encoding: Literal["rgb8", "none"], sha256: str, pixels: Payload
    ) -> None:
        now_ns = self._director.now_ns
        header = CameraFrame(
            t_ns=now_ns,
            camera=name,
            seq=self._passed[name],
            t_frame_ns=now_ns,
            view=view_message(view, self._local_frame, self._cameras[name].carrier),
            encoding=encoding,
            sha256=sha256,
        )
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
