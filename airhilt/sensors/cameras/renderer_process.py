"""Pictures from processes of their own, so that a renderer that crashes takes no run with it.

`airhilt.sensors.cameras.renderer_server` is the other side.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import replace
from typing import Any, Literal

from airhilt.errors import RendererLost
from airhilt.host.child_process import ChildProcess, Ended, NoAnswer
from airhilt.host.machine import available_cores
from airhilt.imaging.masks import Mask
from airhilt.imaging.view import View
from airhilt.scenario import Scenario
from airhilt.sensors.cameras import AUTO, STILL_SAMPLES
from airhilt.sensors.cameras.frame import CameraPicture, Prospect
from airhilt.sensors.cameras.mounts import Camera, cameras_named, find_camera
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sim.payload import Payload

States = dict[str, Any]
"""States of cameras by name, as `CameraState.to_json` returns them."""
MODULE = "airhilt.sensors.cameras.renderer_server"
ENVIRONMENT = {"EGL_PLATFORM": "surfaceless", "OMP_NUM_THREADS": "1", "LP_NUM_THREADS": "2"}
"""Environment for drivers without a display. A run waits while pictures are drawn: two threads
draw some of them sooner."""
MOST_PROCESSES = 4
"""Most processes of a run; each takes some 300 MB for the scene."""
STARTING_S = 120.0
"""Time that a process has to open its scene, in s."""
PATIENCE_S = 60.0
"""Time that it has for the pictures of one instant, in s."""
SLOWEST_SAMPLES_PER_S = 250_000.0
"""Samples that a renderer on a busy core draws in a second; it is given the time for all."""


class RendererProcess:
    """Takes pictures as a `SceneRenderer` does, in other processes; a `PictureSource`.

    What a process draws does not depend on the others: their number changes no picture.

    Parameters
    ----------
    names
        Names of the cameras; None takes those that the scenario declares.
    processes
        Processes of `start_renderer`, which stay; each draws for some of the cameras. None: one
        that ends with this.
    shares_pictures
        True if other runs may have the same pictures.

    Attributes
    ----------
    identity
        Identity of the scene if pictures are shared: see `SceneRenderer`.

    Raises
    ------
    CameraError
        There is no such camera, or it could see nothing.
    RendererError
        The renderer cannot be opened; `RendererLost` if its process has died.
    """

    def __init__(
        self,
        scenario: Scenario,
        names: Sequence[str] | None = None,
        renderer: str = AUTO,
        supersampling: int = 1,
        processes: Sequence[ChildProcess] = (),
        shares_pictures: bool = False,
    ) -> None:
        wanted = [camera.name for camera in scenario.cameras] if names is None else list(names)
        self._cameras = cameras_named(scenario, wanted)
        self.renderer = renderer
        samples = sum(_samples(camera, supersampling) for camera in self._cameras.values())
        self._drawing_s = samples / SLOWEST_SAMPLES_PER_S
        self._pixels: dict[str, Payload] = {}
        self._owned = [] if processes else [start_renderer(renderer)]
        self.processes = [*processes, *self._owned]
        shares = shared_out(self._cameras.values(), len(self.processes))
        self._shares = list(zip(self.processes, shares, strict=True))
        opening = (renderer, supersampling, shares_pictures)
        try:
            opened = self._answers(
                "open",
                [(process, (scenario, share, *opening)) for process, share in self._shares],
                STARTING_S,
            )
        except BaseException:
            self.close()
            raise
        self.identity = ""
        self.own_aircraft: dict[str, Mask] = {}
        for name, identity, own_aircraft in opened:
            self.renderer, self.identity = name, identity
            self.own_aircraft |= own_aircraft

    def take(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> list[CameraPicture]:
        """Take the pictures of all cameras that are due at an instant."""
        taken, _ = self.ask("take", names, bodies, t_ns, {})
        return [taken[name] for name in names]

    def prospects(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> dict[str, Prospect]:
        """Return what the pictures of an instant would show, by camera, without taking them."""
        return self.ask("prospects", names, bodies, t_ns, {})[0]

    def ask(
        self,
        what: Literal["take", "prospects"],
        names: Sequence[str],
        bodies: Sequence[BodyState],
        t_ns: int,
        states: States,
    ) -> tuple[dict[str, Any], States]:
        """Return pictures or prospects by camera, and states of the cameras as `RendererServer`."""
        asked = [
            (process, (its, bodies, t_ns, {name: states[name] for name in its if states}))
            for process, share in self._shares
            if (its := [name for name in names if name in share])
        ]
        found: dict[str, Any] = {}
        after: States = {}
        for its_found, its_after in self._answers(what, asked, PATIENCE_S):
            found |= its_found
            after |= its_after
        if what == "take":
            found = {name: self._whole(picture) for name, picture in found.items()}
        return found, after

    def _whole(self, picture: CameraPicture) -> CameraPicture:
        """Return a picture with its pixels, which are the last ones if it has none."""
        pixels = picture.pixels or self._pixels[picture.camera]
        self._pixels[picture.camera] = pixels
        return replace(picture, pixels=pixels)

    def views(self, names: Sequence[str], bodies: Sequence[BodyState]) -> dict[str, View]:
        """Return the views of cameras by name.

        Raises
        ------
        CameraError
            As `ask`.
        """
        there = {body.actor: body for body in bodies}
        return {name: find_camera(self._cameras, name).view(there) for name in names}

    def _answers(
        self, what: str, asked: Sequence[tuple[ChildProcess, tuple[Any, ...]]], patience_s: float
    ) -> list[Any]:
        """Return what each process answers; all are asked at once, and have the time to draw."""
        patience_s += self._drawing_s
        for process, arguments in asked:
            process.tell(what, *arguments)
        with _lost_if_silent(self.renderer, patience_s):
            return [process.answer(patience_s) for process, _ in asked]

    def close(self) -> None:
        """End the process, unless it was given."""
        for process in self._owned:
            process.close()

    def __enter__(self) -> RendererProcess:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class RendererKeeper:
    """Keeps one process that draws for run after run; a new one takes its place if it dies."""

    def __init__(self) -> None:
        self._process: ChildProcess | None = None

    def process(self) -> ChildProcess:
        """Return a process that can draw; errors as `start_renderer`."""
        if self._process is None or not self._process.is_alive:
            self.close()
            self._process = start_renderer()
        return self._process

    def close(self) -> None:
        """End the process."""
        if self._process is not None:
            self._process.close()
        self._process = None


def start_renderer(renderer: str = AUTO) -> ChildProcess:
    """Return a process that can draw.

    Raises
    ------
    RendererLost
        It cannot be started.
    """
    try:
        return ChildProcess(MODULE, ENVIRONMENT)
    except OSError as error:
        raise RendererLost(
            f"the renderer {renderer} cannot be started: {error.strerror}; expected memory for one "
            "more process and its pictures"
        ) from None


def processes_for(scenario: Scenario) -> int:
    """Return how many processes draw for the cameras of a scenario, at least 1.

    A run waits while its pictures are drawn, so all cores may draw; but a process takes a second to
    open its scene, and is worth it for two cameras that move. With half of the cores, which leaves
    the others to the detector, it is worth it for one. A fixed camera's background is drawn once.
    """
    moving = sum(camera.carrier is not None for camera in scenario.cameras)
    cores = available_cores()
    return max(min(max(cores // 2, moving // 2), cores, moving, MOST_PROCESSES), 1)


def shared_out(cameras: Iterable[Camera], processes: int) -> list[list[str]]:
    """Return the cameras of each process: moving and fixed ones in turn."""
    ordered = sorted(cameras, key=lambda camera: camera.is_fixed)
    return [[camera.name for camera in ordered[at::processes]] for at in range(processes)]


def probe(renderer: str) -> None:
    """Let a process of its own draw something.

    Raises
    ------
    RendererError
        It could not.
    """
    with closing(start_renderer(renderer)) as process, _lost_if_silent(renderer, STARTING_S):
        process.ask("probe", renderer, patience_s=STARTING_S)


def _samples(camera: Camera, supersampling: int) -> int:
    """Return how many samples a picture has at most; a fixed camera's first one has more."""
    along = max(supersampling, STILL_SAMPLES) if camera.is_fixed else supersampling
    return camera.intrinsics.width_px * camera.intrinsics.height_px * along**2


@contextmanager
def _lost_if_silent(renderer: str, patience_s: float) -> Iterator[None]:
    """Raise RendererLost if a process does not answer."""
    try:
        yield
    except NoAnswer:
        raise RendererLost(
            f"the renderer {renderer} has not answered for {patience_s:.0f} s; no more "
            "pictures are drawn: take smaller ones (width_px, height_px) or another --renderer"
        ) from None
    except Ended as ended:
        raise RendererLost(
            f"the process of renderer {renderer} has ended {ended}; no more pictures are drawn"
        ) from None
