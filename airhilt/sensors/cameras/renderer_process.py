"""A studio in a process of its own, so that a renderer that crashes takes no run with it.

Questions and answers are lines of JSON on two pipes; the pixels lie in a file that both processes
map into their memory. `python -m airhilt.sensors.cameras.renderer_process` is the other side.
"""

from __future__ import annotations

import json
import mmap
import os
import selectors
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, replace
from pathlib import Path
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from airhilt.errors import AirhiltError, CameraError, RendererError, ScenarioError
from airhilt.imaging.masks import Mask, mask_of, runs_of
from airhilt.scenario import Scenario
from airhilt.sensors.cameras import AUTO
from airhilt.sensors.cameras.mounts import Camera, cameras_of, find_camera
from airhilt.sensors.cameras.renderers import require_renderer
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sensors.cameras.scene.projected_box import Box
from airhilt.sensors.cameras.scene_renderer import STILL_SAMPLES, Frame, Sighting
from airhilt.sensors.cameras.view import View
from airhilt.shapes.mesh import Floats
from airhilt.world.site import ScenarioSite

Planes = tuple[npt.NDArray[np.uint8], npt.NDArray[np.uint8], Floats]
"""Colour, instance, distance."""
BYTES_PER_PIXEL = 3 + 1 + 4
"""Colour, instance, distance."""
TOLD = {error.__name__: error for error in (CameraError, RendererError, ScenarioError)}
"""Errors that go from one process to the other by their names."""
STARTING_S = 120.0
PATIENCE_S = 60.0
SLOWEST_SAMPLES_PER_S = 250_000.0
"""Of a renderer on a busy core: it is given a second more for each as many samples."""
MOST_SAID_BYTES = 1 << 20
"""Of what the other process says besides its answers, before it is forgotten."""
LAST_SAID_BYTES = 1 << 12
"""Of that, in which its last line is."""


class RendererProcess:
    """Takes pictures as a `SceneRenderer` does, in another process.

    Parameters
    ----------
    names
        Of the cameras; None: those that the scenario declares.
    patience_s
        For the pictures of one instant, before the renderer is given up. What it takes to draw
        all that the cameras see, sample by sample, is added.

    Attributes
    ----------
    renderer
        Name of the renderer that draws.
    actors
        Those of the numbers in ``Frame.instance``, from 1.
    own_aircraft
        For each camera the pixels that the aircraft which carries it may cover, shape (rows,
        columns).

    Raises
    ------
    CameraError
        There is no such camera, or it could see nothing.
    RendererError
        The renderer cannot be opened, or its process has died.
    """

    def __init__(
        self,
        scenario: Scenario,
        names: Sequence[str] | None = None,
        renderer: str = AUTO,
        supersampling: int = 1,
        patience_s: float = PATIENCE_S,
    ) -> None:
        self.renderer = renderer
        wanted = [camera.name for camera in scenario.cameras] if names is None else list(names)
        self._cameras = _cameras(scenario, wanted)
        samples = sum(_samples(camera, supersampling) for camera in self._cameras.values())
        drawing_s = samples / SLOWEST_SAMPLES_PER_S
        self._patience_s = patience_s + drawing_s
        self._places = _places(self._cameras)
        size = max(sum(camera_bytes(camera) for camera in self._cameras.values()), 1)
        try:
            self._said = tempfile.TemporaryFile(buffering=0)  # noqa: SIM115
            self._file = _shared_file()
            self._file.truncate(size)
            self._pixels = mmap.mmap(self._file.fileno(), size)
        except OSError as error:
            raise RendererError(
                f"the renderer {renderer} has no room for pictures of {size / 1e6:.0f} MB and for "
                f"what it says: {error.strerror}; expected that much memory, and a few kB where "
                "temporary files are (TMPDIR)"
            ) from None
        self._process, self._ask, self._answers = self._start()
        self._unread = b""
        self._last: dict[str, Frame] = {}
        try:
            opened = self._exchange(
                {
                    "scenario": scenario.model_dump(mode="json"),
                    "cameras": wanted,
                    "renderer": renderer,
                    "fine": supersampling,
                },
                STARTING_S + drawing_s,
            )
        except BaseException:
            self.close()
            raise
        self.renderer = opened["renderer"]
        self.actors: tuple[str, ...] = tuple(opened["actors"])
        self.own_aircraft: Mapping[str, Mask] = {
            name: _mask(runs, self._cameras[name]) for name, runs in opened["own_aircraft"].items()
        }

    def shoot(self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int) -> list[Frame]:
        """Take the pictures of all cameras that are due at an instant.

        Raises
        ------
        CameraError
            A pose is not finite, or a camera is mounted on something that is not there.
        RendererError
            The renderer's process has died, or does not answer.
        """
        there = {body.actor: body for body in bodies}
        views = {name: find_camera(self._cameras, name).view(there) for name in names}
        answer = self._exchange(
            {"cameras": list(names), "bodies": [list(body) for body in bodies], "t_ns": t_ns},
            self._patience_s,
        )
        return [self._frame(name, t_ns, views[name], answer["pictures"][name]) for name in names]

    def _frame(self, name: str, t_ns: int, view: View, told: Mapping[str, Any]) -> Frame:
        sightings = tuple(_sighting(found) for found in told["sightings"])
        last = self._last.get(name)
        if told["unchanged"] and last is not None:
            return replace(last, t_ns=t_ns, view=view, sightings=sightings, unchanged=True)
        colour, instance, distance = self._planes(name)
        frame = Frame(
            name, t_ns, view, colour.copy(), distance.copy(), instance.copy(), sightings
        ).sealed()
        self._last[name] = frame
        return frame

    def close(self) -> None:
        """End the process; a question that it died before reading is lost with it."""
        try:
            with suppress(OSError, subprocess.TimeoutExpired):
                self._ask.close()
                self._process.wait(5.0)
        finally:
            self._process.kill()
            self._process.wait()
            self._answers.close()
            self._pixels.close()
            self._file.close()
            self._said.close()

    def __enter__(self) -> RendererProcess:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def process_id(self) -> int:
        """Of the other process."""
        return self._process.pid

    def _planes(self, name: str) -> Planes:
        return planes(self._pixels, self._places[name], self._cameras[name])

    def _start(self) -> tuple[subprocess.Popen[bytes], IO[bytes], IO[bytes]]:
        questions, ask = os.pipe()
        answers, answer = os.pipe()
        shared = self._file.fileno()
        numbers = [str(number) for number in (questions, answer, shared)]
        process = subprocess.Popen(  # noqa: S603 - our own module
            [*COMMAND, *numbers],
            stdin=subprocess.DEVNULL,
            stdout=self._said,
            stderr=self._said,
            # Ctrl-C is for the run, which then ends this process itself.
            start_new_session=True,
            pass_fds=(questions, answer, shared),
            env=_environment(),
        )
        os.close(questions)
        os.close(answer)
        return process, os.fdopen(ask, "wb"), os.fdopen(answers, "rb", buffering=0)

    def _exchange(self, question: Mapping[str, Any], patience_s: float) -> Any:
        try:
            self._ask.write(json.dumps(question).encode() + b"\n")
            self._ask.flush()
            line = self._line(patience_s)
        except (OSError, ValueError):
            line = b""
        if not line:
            raise self._died()
        self._forget()
        answer = json.loads(line)
        if "error" in answer:
            raise TOLD.get(answer["error"], RendererError)(answer["text"])
        return answer

    def _line(self, patience_s: float) -> bytes:
        """Return the next line of answers; empty when there will be none."""
        until_s = time.monotonic() + patience_s
        with selectors.DefaultSelector() as selector:
            selector.register(self._answers, selectors.EVENT_READ)
            while b"\n" not in self._unread:
                left_s = until_s - time.monotonic()
                if left_s <= 0.0 or not selector.select(left_s):
                    self._process.kill()
                    raise RendererError(
                        f"the renderer {self.renderer} has not answered for {patience_s:.0f} s, "
                        f"with pictures of {_sizes(self._cameras.values())} pixels; no more are "
                        "drawn: take smaller ones (width_px, height_px) or another --renderer"
                    )
                part = self._answers.read(1 << 16)
                if not part:
                    return b""
                self._unread += part
        line, _, self._unread = self._unread.partition(b"\n")
        return line

    def _forget(self) -> None:
        """Make room for what the process says: it writes where this side's file stands too."""
        if os.fstat(self._said.fileno()).st_size > MOST_SAID_BYTES:
            self._said.seek(0)
            self._said.truncate()

    def _died(self) -> RendererError:
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(5.0)
        self._said.seek(max(os.fstat(self._said.fileno()).st_size - LAST_SAID_BYTES, 0))
        last = self._said.read().decode(errors="replace").strip().splitlines()[-1:]
        cause = f": {last[0]}" if last else ""
        return RendererError(
            f"the process of renderer {self.renderer} has ended "
            f"({_how(self._process.returncode)}){cause}; no more pictures are drawn"
        )


COMMAND = (sys.executable, "-P", "-m", "airhilt.sensors.cameras.renderer_process")
"""Of the other side; -P: not from the folder in which it happens to start."""
ENVIRONMENT = {"EGL_PLATFORM": "surfaceless", "OMP_NUM_THREADS": "1", "LP_NUM_THREADS": "2"}
"""For drivers without a display. While pictures are drawn a run waits for them: two threads draw
some of them sooner."""


def _environment() -> dict[str, str]:
    """Return that of the other side, which imports from where this one does."""
    places = [str(Path(place).absolute()) for place in sys.path]
    return {**os.environ, **ENVIRONMENT, "PYTHONPATH": os.pathsep.join(places)}


def _shared_file() -> IO[bytes]:
    """Return a file for pixels, in memory where the system has such."""
    if hasattr(os, "memfd_create"):
        return os.fdopen(os.memfd_create("airhilt"), "w+b")
    return tempfile.TemporaryFile()


def _how(code: int | None) -> str:
    return f"signal {-code}" if code is not None and code < 0 else f"exit code {code}"


def _samples(camera: Camera, supersampling: int) -> int:
    """Return how many samples a picture has at most; a fixed camera's first one has more."""
    along = max(supersampling, STILL_SAMPLES) if camera.is_fixed else supersampling
    return camera.intrinsics.width_px * camera.intrinsics.height_px * along**2


def _sizes(cameras: Iterable[Camera]) -> str:
    """Return how large pictures are, for a message."""
    sizes = {(camera.intrinsics.width_px, camera.intrinsics.height_px) for camera in cameras}
    return ", ".join(f"{width} x {height}" for width, height in sorted(sizes))


def camera_bytes(camera: Camera) -> int:
    """Return the room that a picture of a camera takes."""
    return camera.intrinsics.width_px * camera.intrinsics.height_px * BYTES_PER_PIXEL


def planes(pixels: mmap.mmap, place: int, camera: Camera) -> Planes:
    """Return colour, instance and distance of a camera's picture, as they lie in the file."""
    rows, columns = camera.intrinsics.height_px, camera.intrinsics.width_px
    count = rows * columns
    distance = np.frombuffer(pixels, np.float32, count, place)
    colour = np.frombuffer(pixels, np.uint8, 3 * count, place + 4 * count)
    instance = np.frombuffer(pixels, np.uint8, count, place + 7 * count)
    shape = rows, columns
    return colour.reshape(*shape, 3), instance.reshape(shape), distance.reshape(shape)


def _cameras(scenario: Scenario, names: Sequence[str]) -> dict[str, Camera]:
    from airhilt.sensors.cameras.scene.bodies import model_of

    site = ScenarioSite.of(scenario)
    carriers = {camera.carrier for camera in scenario.cameras}
    models = {
        actor.callsign: model_of(actor) for actor in scenario.actors if actor.callsign in carriers
    }
    known = cameras_of(scenario, site, models)
    return {name: find_camera(known, name) for name in names}


def _places(cameras: Mapping[str, Camera]) -> dict[str, int]:
    """Return where in the file each picture begins: a multiple of what a float takes."""
    places, place = {}, 0
    for name, camera in cameras.items():
        places[name] = place
        place += camera_bytes(camera)
    return places


def _mask(runs: Sequence[int], camera: Camera) -> Mask:
    return mask_of(runs, camera.intrinsics.height_px, camera.intrinsics.width_px)


def _sighting(found: Mapping[str, Any]) -> Sighting:
    return Sighting(**{**found, "box": Box(*found["box"])})


def probe(renderer: str) -> None:
    """Let a process of its own draw something.

    Raises
    ------
    RendererError
        It could not.
    """
    try:
        done = subprocess.run(  # noqa: S603 - our own module
            [*COMMAND, renderer],
            capture_output=True,
            text=True,
            env=_environment(),
            timeout=STARTING_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise RendererError(
            f"the renderer {renderer} has not drawn anything for {STARTING_S:.0f} s"
        ) from None
    if done.returncode:
        last = done.stderr.strip().splitlines()[-1:]
        raise RendererError(
            last[0]
            if last and done.returncode == 1
            else f"the process of renderer {renderer} has ended ({_how(done.returncode)})"
        )


# --- the other side -------------------------------------------------------------------------


def serve(questions: IO[bytes], answer: Callable[[Any], None], shared: int) -> None:
    """Answer until there are no more questions: the first opens the studio."""
    from airhilt.sensors.cameras.scene.builder import open_scene_renderer

    opening = json.loads(questions.readline())
    scenario = Scenario.model_validate(opening["scenario"])
    names = opening["cameras"]
    cameras = _cameras(scenario, names)
    places = _places(cameras)
    pixels = mmap.mmap(shared, 0)
    try:
        studio = open_scene_renderer(
            scenario, ScenarioSite.of(scenario), names, opening["renderer"], opening["fine"]
        )
    except AirhiltError as error:
        answer(_told(error))
        return
    own = {name: runs_of(studio.own_aircraft(name)) for name in names}
    answer({"renderer": studio.renderer, "actors": studio.actors, "own_aircraft": own})
    for line in questions:
        question = json.loads(line)
        bodies = [BodyState(*body) for body in question["bodies"]]
        try:
            frames = studio.shoot(question["cameras"], bodies, question["t_ns"])
        except AirhiltError as error:
            answer(_told(error))
            continue
        for frame in frames:
            if not frame.unchanged:
                place, camera = places[frame.camera], cameras[frame.camera]
                colour, instance, distance = planes(pixels, place, camera)
                colour[...] = frame.colour
                instance[...] = frame.instance
                distance[...] = frame.distance_m
        answer({"pictures": {frame.camera: _picture(frame) for frame in frames}})
    studio.close()


def _picture(frame: Frame) -> dict[str, Any]:
    """Return what is told about a picture besides its pixels."""
    return {
        "sightings": [asdict(sighting) for sighting in frame.sightings],
        "unchanged": frame.unchanged,
    }


def _told(error: AirhiltError) -> dict[str, str]:
    return {"error": type(error).__name__, "text": str(error)}


def main(numbers: Sequence[str]) -> None:
    """Serve on the pipes and the file of these descriptors, or try the renderer of that name."""
    if len(numbers) == 1:
        try:
            require_renderer(numbers[0])
        except RendererError as error:
            sys.exit(str(error))
        return
    questions, answers, shared = (int(number) for number in numbers)
    with os.fdopen(questions, "rb") as asked, os.fdopen(answers, "wb", buffering=0) as told:
        serve(asked, lambda message: _write(told, message), shared)


def _write(told: IO[bytes], message: Any) -> None:
    told.write(json.dumps(message).encode() + b"\n")


if __name__ == "__main__":
    main(sys.argv[1:])
