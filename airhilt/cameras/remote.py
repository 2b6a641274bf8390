"""A studio in a process of its own, so that a renderer that crashes takes no run with it.

Questions and answers are lines of JSON on two pipes; the pixels lie in a file that both processes
map into their memory. `python -m airhilt.cameras.remote` is the other side.
"""

from __future__ import annotations

import json
import mmap
import os
import select
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from airhilt.cameras.bodies import BodyState
from airhilt.cameras.mesh import Floats
from airhilt.cameras.mounts import Camera, cameras_of, find_camera
from airhilt.cameras.outline import Box
from airhilt.cameras.renderers import RendererName
from airhilt.cameras.studio import Frame, Sighting
from airhilt.errors import AirhiltError, CameraError, RendererError, ScenarioError
from airhilt.scenario import Scenario
from airhilt.scenario.geometry import Setting

Planes = tuple[npt.NDArray[np.uint8], npt.NDArray[np.uint8], Floats]
"""Colour, instance, distance."""
BYTES_PER_PIXEL = 3 + 1 + 4
"""Colour, instance, distance."""
TOLD = {error.__name__: error for error in (CameraError, RendererError, ScenarioError)}
"""Errors that go from one process to the other by their names."""
STARTING_S = 120.0


class RemoteStudio:
    """Takes pictures as a `airhilt.cameras.studio.Studio` does, in another process.

    Parameters
    ----------
    names
        Of the cameras; None: those that the scenario declares.
    patience_s
        For the pictures of one instant, before the renderer is given up.

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
        renderer: RendererName = "open3d",
        fine: int = 1,
        patience_s: float = 60.0,
    ) -> None:
        self._renderer = renderer
        self._patience_s = patience_s
        wanted = [camera.name for camera in scenario.cameras] if names is None else list(names)
        self._cameras = _cameras(scenario, wanted)
        self._places = _places(self._cameras)
        self._file = tempfile.TemporaryFile()  # noqa: SIM115 - lives as long as the studio
        size = max(sum(camera_bytes(camera) for camera in self._cameras.values()), 1)
        self._file.truncate(size)
        self._pixels = mmap.mmap(self._file.fileno(), size)
        self._said = tempfile.TemporaryFile()  # noqa: SIM115
        self._process, self._ask, self._answers = self._start()
        self._unread = b""
        try:
            opened = self._exchange(
                {
                    "scenario": scenario.model_dump(mode="json"),
                    "cameras": wanted,
                    "renderer": renderer,
                    "fine": fine,
                },
                STARTING_S,
            )
        except BaseException:
            self.close()
            raise
        self.actors: tuple[str, ...] = tuple(opened["actors"])

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
        frames = []
        for name in names:
            colour, instance, distance = self._planes(name)
            sightings = tuple(_sighting(found) for found in answer["sightings"][name])
            frames.append(
                Frame(
                    name, t_ns, views[name], colour.copy(), distance.copy(), instance.copy(),
                    sightings,
                )
            )  # fmt: skip
        return frames

    def close(self) -> None:
        """End the process."""
        self._ask.close()
        try:
            self._process.wait(5.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._answers.close()
        self._pixels.close()
        self._file.close()
        self._said.close()

    def __enter__(self) -> RemoteStudio:
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
        command = [sys.executable, "-m", "airhilt.cameras.remote"]
        numbers = [str(number) for number in (questions, answer, shared)]
        process = subprocess.Popen(  # noqa: S603 - our own module
            [*command, *numbers],
            stdin=subprocess.DEVNULL,
            stdout=self._said,
            stderr=self._said,
            pass_fds=(questions, answer, shared),
            env={**os.environ, **ENVIRONMENT},
        )
        os.close(questions)
        os.close(answer)
        return process, os.fdopen(ask, "wb"), os.fdopen(answers, "rb", buffering=0)

    def _exchange(self, question: Mapping[str, Any], patience_s: float) -> Any:
        try:
            self._ask.write(json.dumps(question).encode() + b"\n")
            self._ask.flush()
            line = self._line(time.monotonic() + patience_s)
        except (OSError, ValueError):
            line = b""
        if not line:
            raise self._died()
        answer = json.loads(line)
        if "error" in answer:
            raise TOLD.get(answer["error"], RendererError)(answer["text"])
        return answer

    def _line(self, until_s: float) -> bytes:
        """Return the next line of answers; empty when there will be none."""
        while b"\n" not in self._unread:
            left_s = until_s - time.monotonic()
            if left_s <= 0.0 or not select.select([self._answers], [], [], left_s)[0]:
                self._process.kill()
                raise RendererError(
                    f"the renderer {self._renderer} has not answered for "
                    f"{self._patience_s:.0f} s; no more pictures are drawn"
                )
            part = self._answers.read(1 << 16)
            if not part:
                return b""
            self._unread += part
        line, _, self._unread = self._unread.partition(b"\n")
        return line

    def _died(self) -> RendererError:
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(5.0)
        self._said.seek(0)
        last = self._said.read().decode(errors="replace").strip().splitlines()[-1:]
        cause = f": {last[0]}" if last else ""
        code = self._process.returncode
        how = f"signal {-code}" if code is not None and code < 0 else f"exit code {code}"
        return RendererError(
            f"the process of renderer {self._renderer} has ended ({how}){cause}; no more pictures "
            "are drawn"
        )


ENVIRONMENT = {"EGL_PLATFORM": "surfaceless", "OMP_NUM_THREADS": "1", "LP_NUM_THREADS": "1"}
"""For drivers without a display; and one core for pictures, because a run needs the other."""


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
    from airhilt.cameras.bodies import model_of

    setting = Setting.of(scenario)
    carriers = {camera.mount.actor for camera in scenario.cameras if camera.mount.type == "actor"}
    models = {
        actor.callsign: model_of(actor) for actor in scenario.actors if actor.callsign in carriers
    }
    known = cameras_of(scenario, setting, models)
    return {name: find_camera(known, name) for name in names}


def _places(cameras: Mapping[str, Camera]) -> dict[str, int]:
    """Return where in the file each picture begins: a multiple of what a float takes."""
    places, place = {}, 0
    for name, camera in cameras.items():
        places[name] = place
        place += camera_bytes(camera)
    return places


def _sighting(found: Mapping[str, Any]) -> Sighting:
    return Sighting(**{**found, "box": Box(*found["box"])})


# --- the other side -------------------------------------------------------------------------


def serve(questions: IO[bytes], answer: Callable[[Any], None], shared: int) -> None:
    """Answer until there are no more questions: the first opens the studio."""
    from airhilt.cameras.stage import open_studio

    opening = json.loads(questions.readline())
    scenario = Scenario.model_validate(opening["scenario"])
    names = opening["cameras"]
    cameras = _cameras(scenario, names)
    places = _places(cameras)
    pixels = mmap.mmap(shared, 0)
    try:
        studio = open_studio(
            scenario, Setting.of(scenario), names, opening["renderer"], opening["fine"]
        )
    except AirhiltError as error:
        answer(_told(error))
        return
    answer({"actors": studio.actors})
    for line in questions:
        question = json.loads(line)
        bodies = [BodyState(*body) for body in question["bodies"]]
        try:
            frames = studio.shoot(question["cameras"], bodies, question["t_ns"])
        except AirhiltError as error:
            answer(_told(error))
            continue
        for frame in frames:
            colour, instance, distance = planes(pixels, places[frame.camera], cameras[frame.camera])
            colour[...] = frame.colour
            instance[...] = frame.instance
            distance[...] = frame.distance_m
        sightings = {
            frame.camera: [asdict(sighting) for sighting in frame.sightings] for frame in frames
        }
        answer({"sightings": sightings})
    studio.close()


def _told(error: AirhiltError) -> dict[str, str]:
    return {"error": type(error).__name__, "text": str(error)}


def main(numbers: Sequence[str]) -> None:
    """Serve on the pipes and the file of these descriptors."""
    questions, answers, shared = (int(number) for number in numbers)
    with os.fdopen(questions, "rb") as asked, os.fdopen(answers, "wb", buffering=0) as told:
        serve(asked, lambda message: _write(told, message), shared)


def _write(told: IO[bytes], message: Any) -> None:
    told.write(json.dumps(message).encode() + b"\n")


if __name__ == "__main__":
    main(sys.argv[1:])
