"""Draws the moving picture of the README: a camera, the plan, the radio and the warning of a run.

    python tools/front_page.py RUN --camera tower --from 60 --to 120

RUN is the folder of a run at an airport, made with ``airhilt cosim ... --video``. The picture goes to
``docs/images/run.webp``. Needs ``pip install '.[video]'``.
"""

from __future__ import annotations

import argparse
from bisect import bisect_right
from collections.abc import Iterator
from pathlib import Path
from textwrap import fill

import av
import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.animation import PillowWriter
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from airhilt.displays.scene import AREA_COLOURS, Scene
from airhilt.displays.story import Story
from airhilt.messages import NS_PER_S, ActorTruth
from airhilt.metrics.result import Result, open_result
from airhilt.record import open_run

Picture = npt.NDArray[np.uint8]
OUTPUT = Path(__file__).parent.parent / "docs" / "images" / "run.webp"
SIZE_INCHES, DOTS_PER_INCH = (9.6, 5.4), 100
PERIOD_S = 0.5
"""Simulated time between two pictures."""
PICTURES_PER_S = 8
LINES = 4
"""Calls that stand on the picture at once."""
LINE_LENGTH = 66
"""Letters in a line of the radio."""
STYLE = {
    "axes.edgecolor": "none",
    "axes.facecolor": "#10151c",
    "figure.facecolor": "#10151c",
    "font.size": 9,
    "text.color": "#e6edf3",
}
QUIET, LOUD, WARNING = "#8b98a5", "#e6edf3", "#ff6b5e"


def video_pictures(path: Path, times_s: list[float]) -> Iterator[Picture]:
    """Yield the picture of a video that is shown at each of some rising times."""
    with av.open(str(path)) as video:
        frames = video.decode(video=0)
        shown = following = next(frames)
        for time_s in times_s:
            while following is not None and (following.time or 0.0) <= time_s:
                shown, following = following, next(frames, None)
            yield shown.to_ndarray(format="rgb24")


class Plan:
    """The plan view: the airport, and each actor with its name and where it came from."""

    def __init__(self, axes: Axes, scene: Scene, story: Story, until_s: float) -> None:
        self._scene, self._story = scene, story
        axes.set(xticks=[], yticks=[], aspect="equal")
        for outline in scene.outlines():
            east_m, north_m = zip(*outline.points, strict=True)
            colour = [part / 255.0 for part in AREA_COLOURS[outline.area]]
            match outline.area:
                case "runway" | "building":
                    axes.fill(east_m, north_m, color=colour)
                case "taxiway":
                    axes.plot(east_m, north_m, color=colour, linewidth=0.4)
        ends = np.array([self._place(track, until_s) for track in story.tracks.values()])
        centre, half_m = ends.mean(axis=0), max(700.0, 0.8 * np.ptp(ends, axis=0).max())
        axes.set_xlim(centre[0] - half_m, centre[0] + half_m)
        axes.set_ylim(centre[1] - half_m, centre[1] + half_m)
        self._marks = {
            actor: (
                axes.plot([], [], color=np.divide(scene.colour(actor), 255.0), linewidth=1.2)[0],
                axes.plot([], [], "o", color=np.divide(scene.colour(actor), 255.0), markersize=5)[0],
                axes.text(0.0, 0.0, f"  {actor}", clip_on=True, va="center"),
            )
            for actor in story.tracks
        }

    def draw(self, time_s: float) -> None:
        """Move the actors to where they are at a time."""
        for actor, (trail, dot, name) in self._marks.items():
            track = self._story.tracks[actor]
            been = [self._place(track, time_s - back_s) for back_s in range(30, -1, -1)]
            trail.set_data(*zip(*been, strict=True))
            dot.set_data(*([value] for value in been[-1]))
            name.set_position(been[-1])

    def _place(self, track: list[ActorTruth], time_s: float) -> tuple[float, float]:
        last = bisect_right(track, time_s * NS_PER_S, key=lambda state: state.t_ns) - 1
        east_m, north_m, _ = self._scene.pose(track[max(last, 0)]).position
        return east_m, north_m


class Radio:
    """The words on the frequency as they are spoken, and the advisories that are in force."""

    def __init__(self, axes: Axes, story: Story) -> None:
        self._axes, self._story = axes, story

    def draw(self, time_s: float) -> None:
        """Write what is heard, and what is told, at a time."""
        self._axes.clear()
        self._axes.set_axis_off()
        now_ns = time_s * NS_PER_S
        line = 0.0
        calls = [call for call in self._story.calls if call.t_tx_ns <= now_ns]
        for call in calls[-LINES:]:
            said = min(1.0, (now_ns - call.t_tx_ns) / (call.t_end_ns - call.t_tx_ns))
            words = call.text[: round(said * len(call.text))]
            colour = LOUD if said < 1.0 else QUIET
            self._write(line, f"{call.speaker}: {words}", colour)
            line += 1.0
        told = [
            advisory
            for advisory, until_ns in self._story.advisories
            if advisory.t_ns <= now_ns < until_ns and advisory.severity != "INFO"
        ]
        for line, advisory in enumerate(told[:2], LINES):
            self._write(line, f"to {advisory.recipient}: {advisory.message}", WARNING)

    def _write(self, line: float, words: str, colour: str) -> None:
        text = fill(words, LINE_LENGTH * 2, max_lines=1, placeholder=" ...")
        self._axes.text(0.0, 1.0 - line / (LINES + 2), text, color=colour, va="top",
                        transform=self._axes.transAxes)  # fmt: skip


def draw(run: Result, camera: str, begin_s: float, end_s: float, output: Path) -> None:
    """Write the moving picture of a run between two times."""
    story, scene = Story.of(run), Scene(open_run(run.folder))
    times_s = [float(time_s) for time_s in np.arange(begin_s, end_s, PERIOD_S)]
    figure = Figure(figsize=SIZE_INCHES, dpi=DOTS_PER_INCH)
    view = figure.add_axes((0.0, 0.28, 0.66, 0.66))
    view.set_axis_off()
    plan = Plan(figure.add_axes((0.67, 0.28, 0.32, 0.66)), scene, story, end_s)
    radio = Radio(figure.add_axes((0.01, 0.01, 0.98, 0.25)), story)
    figure.text(0.01, 0.955, f"{run.summary.scenario}: camera {camera}")
    clock = figure.text(0.99, 0.955, "", ha="right")
    shown = None
    writer = PillowWriter(fps=PICTURES_PER_S)
    with writer.saving(figure, str(output), DOTS_PER_INCH):
        pictures = video_pictures(run.folder / "video" / f"{camera}.mp4", times_s)
        for time_s, picture in zip(times_s, pictures, strict=True):
            if shown is None:
                shown = view.imshow(picture, aspect="auto")
            shown.set_data(picture)
            plan.draw(time_s)
            radio.draw(time_s)
            clock.set_text(f"{time_s:.0f} s")
            writer.grab_frame()


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("run", type=Path, metavar="RUN")
    parser.add_argument("--camera", required=True)
    parser.add_argument("--from", dest="begin_s", type=float, default=0.0, metavar="S")
    parser.add_argument("--to", dest="end_s", type=float, required=True, metavar="S")
    parser.add_argument("--output", type=Path, default=OUTPUT)
    args = parser.parse_args()
    mpl.rcParams.update(STYLE)
    draw(open_result(args.run), args.camera, args.begin_s, args.end_s, args.output)


if __name__ == "__main__":
    main()
