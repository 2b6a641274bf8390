"""The cameras of a run, what is kept of their pictures, or why there are none."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from functools import partial
from typing import TYPE_CHECKING

from airhilt.cosim.context import RunContext
from airhilt.cosim.observer import Observer
from airhilt.cosim.participants import Participants
from airhilt.cosim.recorded import Recorded
from airhilt.cosim.setup import Setup
from airhilt.cosim.world_loop import WorldLoop
from airhilt.errors import RendererError, RunStopped
from airhilt.messages import ModalityState
from airhilt.options import Options
from airhilt.record.pictures import KeyPictures
from airhilt.record.video import VideoRecorder
from airhilt.scenario import Scenario

if TYPE_CHECKING:
    from airhilt.host.child_process import ChildProcess
    from airhilt.sensors.cameras.renderer_process import RendererKeeper, RendererProcess
    from airhilt.sensors.cameras.sensor import CameraSensor


class Vision:
    """The cameras of a run, and the renderer that draws for them, if somebody might look.

    Without a renderer, `mount`, `start` and `finish` do nothing.

    Parameters
    ----------
    processes
        Processes that have been started to draw.
    observer
        Is told what a user should know at once, such as why nothing can be drawn.

    Raises
    ------
    AirhiltError
        There is no such renderer, or a camera could see nothing.
    RendererError
        Nothing can be drawn here of what was drawn when the run was recorded.
    RunStopped
        Nothing can be drawn, and the run is strict.
    """

    def __init__(
        self,
        setup: Setup,
        participants: Participants,
        processes: Sequence[ChildProcess],
        observer: Observer,
    ) -> None:
        options, recorded = setup.options, setup.recorded
        self._renderer: RendererProcess | None = None
        self._unavailable_reason = recorded.unavailable_reason
        """Why pictures that somebody would look at cannot be drawn; empty if they can."""
        self._is_watched = participants.does("vision")
        self._sensor: CameraSensor | None = None
        self._recorders: list[KeyPictures | VideoRecorder] = []
        has_viewers = _has_viewers(setup, participants) or recorded.has_pictures
        if self._unavailable_reason or not has_viewers:
            return
        try:
            self._renderer = _open_renderer(setup.scenario, options, processes)
        except RendererError as error:
            if recorded.is_replay:
                raise RendererError(f"cannot be replayed here: {error}") from None
            self._unavailable_reason = str(error)
            if error.is_of_machine:
                observer.machine_failed(str(error))
            text = f"vision is not evaluated: {error}"
            if options.strict:
                raise RunStopped(
                    f"not begun, as --strict asks: {text}; leave cameras out with --no-cameras"
                ) from None
            observer.notice(text)

    def close(self) -> None:
        """Let the renderer go."""
        if self._renderer is not None:
            self._renderer.close()

    @property
    def renderer(self) -> str:
        """Name of the renderer that draws; empty if no pictures are drawn."""
        return "" if self._renderer is None else self._renderer.renderer

    @property
    def state(self) -> tuple[ModalityState, str]:
        """State of vision when the run begins, and its cause."""
        if self._unavailable_reason:
            return "not evaluated", self._unavailable_reason
        return "on" if self._renderer is not None and self._is_watched else "off", ""

    def mount(self, context: RunContext, world: WorldLoop) -> None:
        """Add the cameras to a run, and let recorders take what is published."""
        if self._renderer is None:
            return
        from airhilt.sensors.cameras.sensor import CameraSensor
        from airhilt.sensors.cameras.shared_pictures import SharedPictures

        setup = context.setup
        actors = setup.scenario.pair or tuple(setup.actors)
        pictures_path, video_path = setup.folder.pictures_path, setup.folder.video_path
        self._recorders = [
            KeyPictures(pictures_path, actors=actors, closest_ns=world.closest_approach_ns)
        ]
        if setup.options.video:
            self._recorders.append(VideoRecorder(video_path, notice=context.observer.notice))
        context.router.observers += (recorder.take for recorder in self._recorders)
        renderer = self._renderer
        self._sensor = CameraSensor(
            context.director,
            SharedPictures(renderer) if renderer.identity else renderer,
            setup.scenario.cameras,
            setup.site,
            setup.actors,
            is_adaptive=setup.options.camera_rate == "adaptive",
            state_at_ns=lambda: world.ticked_ns,
            publish=context.router.publish,
            lost=partial(context.lose_modality, "vision", "cameras_lost", "cameras"),
            loss=setup.recorded.cameras_lost,
        )

    def start(self) -> None:
        """Publish what never changes about the cameras, and schedule their exposures."""
        if self._sensor is not None:
            self._sensor.start()

    def finish(self) -> None:
        """Write what is still to be kept of the pictures.

        Raises
        ------
        RunFolderError
            The disk takes no more.
        """
        with ExitStack() as stack:
            for recorder in self._recorders:
                stack.callback(recorder.close)


@contextmanager
def started_renderers(
    scenario: Scenario,
    options: Options,
    recorded: Recorded,
    is_watched: bool,
    keeper: RendererKeeper | None,
) -> Iterator[Sequence[ChildProcess]]:
    """Start the processes that draw while a run is set up, if somebody may look at its pictures.

    Parameters
    ----------
    is_watched
        True if the caller gives workers, which may look.
    keeper
        Has the process that draws for run after run; None: this run has its own, as many as draw
        soonest.
    """
    may_look = (
        is_watched
        or options.video
        or options.endpoint is not None
        or bool(options.attach)
        or options.asks_for_detections
    )
    with ExitStack() as stack:
        processes: list[ChildProcess] = []
        if options.cameras and scenario.cameras and (may_look or recorded.has_pictures):
            with suppress(RendererError):  # A later start tells what is wrong.
                if keeper is not None:
                    processes.append(keeper.process())
                else:
                    for process in _start_renderers(scenario, options):
                        stack.callback(process.close)
                        processes.append(process)
        yield processes


def _has_viewers(setup: Setup, participants: Participants) -> bool:
    """Return whether there are cameras, and somebody might look at their pictures."""
    options = setup.options
    is_watched = (
        participants.does("vision") or bool(participants.programs) or options.endpoint is not None
    )
    return options.cameras and bool(setup.scenario.cameras) and (is_watched or options.video)


def _start_renderers(scenario: Scenario, options: Options) -> Iterator[ChildProcess]:
    """Yield processes that draw for one run, as they are started."""
    from airhilt.sensors.cameras.renderer_process import processes_for, start_renderer

    for _ in range(1 if options.share_pictures else processes_for(scenario)):
        yield start_renderer()


def _open_renderer(
    scenario: Scenario, options: Options, processes: Sequence[ChildProcess]
) -> RendererProcess:
    # Not at the top: a run without cameras starts without the libraries behind them.
    from airhilt.sensors.cameras.renderer_process import RendererProcess

    return RendererProcess(
        scenario,
        renderer=options.renderer,
        processes=processes,
        shares_pictures=options.share_pictures,
    )
