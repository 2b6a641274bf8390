"""Pictures from several processes at a time, each of which draws for some of the cameras.

A run waits while pictures are drawn. What a process draws does not depend on the others, so that
their number changes no picture.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from airhilt.host.child_process import available_cores
from airhilt.imaging.masks import Mask
from airhilt.scenario import Scenario
from airhilt.sensors.cameras import AUTO
from airhilt.sensors.cameras.frame import Frame, Prospect
from airhilt.sensors.cameras.renderer_link import RendererLink
from airhilt.sensors.cameras.renderer_process import RendererProcess
from airhilt.sensors.cameras.scene.bodies import BodyState

MOST_PROCESSES = 4
"""Most processes of a run; each takes some 300 MB for the scene."""
Answer = TypeVar("Answer")


def processes_for(scenario: Scenario) -> int:
    """Return how many processes draw for the cameras of a scenario, at least 1.

    Half of the cores draw: the run and its detector have the others. A fixed camera's background
    is drawn once; only those that move are worth a process.
    """
    moving = sum(camera.carrier is not None for camera in scenario.cameras)
    return max(min(available_cores() // 2, moving, MOST_PROCESSES), 1)


def shared_out(scenario: Scenario, processes: int) -> list[list[str]]:
    """Return the cameras of each process: moving and fixed ones in turn."""
    ordered = sorted(scenario.cameras, key=lambda camera: camera.carrier is None)
    return [[camera.name for camera in ordered[at::processes]] for at in range(processes)]


class RendererPool:
    """Takes pictures as a `RendererProcess` does, with a process for each link.

    Parameters
    ----------
    links
        Processes that have been started, at most as many as there are cameras; they stay.

    Attributes
    ----------
    renderer
        Name of the renderer that draws.
    own_aircraft
        Pixels that the aircraft which carries the camera may cover, by camera.

    Raises
    ------
    CameraError
        A camera could see nothing.
    RendererError
        The renderer cannot be opened, or a process has died.
    """

    def __init__(
        self, scenario: Scenario, links: Sequence[RendererLink], renderer: str = AUTO
    ) -> None:
        shares = shared_out(scenario, len(links))
        with ThreadPoolExecutor(len(links)) as threads:
            opened = [
                threads.submit(RendererProcess, scenario, names, renderer, link=link)
                for names, link in zip(shares, links, strict=True)
            ]
        processes = [future.result() for future in opened]
        self._shares = list(zip(processes, shares, strict=True))
        self.renderer = processes[0].renderer
        self.own_aircraft: Mapping[str, Mask] = {
            name: mask for process in processes for name, mask in process.own_aircraft.items()
        }

    def shoot(self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int) -> list[Frame]:
        """Take the pictures of all cameras that are due at an instant.

        It raises what `RendererProcess.shoot` does.
        """
        parts = self._each(names, lambda process, its: process.shoot(its, bodies, t_ns))
        frames = {frame.camera: frame for part in parts for frame in part}
        return [frames[name] for name in names]

    def prospects(
        self, names: Sequence[str], bodies: Sequence[BodyState], t_ns: int
    ) -> dict[str, Prospect]:
        """Return what pictures of an instant would show, by camera, without taking them.

        It raises what `RendererProcess.shoot` does.
        """
        parts = self._each(names, lambda process, its: process.prospects(its, bodies, t_ns))
        return {name: prospect for part in parts for name, prospect in part.items()}

    def _each(
        self, names: Sequence[str], ask: Callable[[RendererProcess, list[str]], Answer]
    ) -> list[Answer]:
        """Return what each process answers that has some of the cameras, all asked at once."""
        with ThreadPoolExecutor(len(self._shares)) as threads:
            asked = [
                threads.submit(ask, process, its)
                for process, share in self._shares
                if (its := [name for name in names if name in share])
            ]
        return [future.result() for future in asked]

    def close(self) -> None:
        """Take no more pictures; the processes stay."""
        for process, _ in self._shares:
            process.close()
