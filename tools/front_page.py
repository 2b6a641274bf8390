"""Draws the moving picture of the README: a camera, the plan, the radio and the warning of a run.

    python tools/front_page.py              make the run, and draw it
    python tools/front_page.py --run RUN    draw a run that is there

The picture goes to ``docs/images/run.webp``. Needs ``pip install '.[video]'``.
"""

from __future__ import annotations

import argparse
from bisect import bisect_right
from collections.abc import Iterator
from pathlib import Path
from textwrap import fill
from typing import Any

import av
import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.animation import PillowWriter
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import airhilt
from airhilt.displays.scene import AREA_COLOURS, Scene
from airhilt.displays.story import Story
from airhilt.messages import ActorTruth
from airhilt.metrics.result import Result, open_result
from airhilt.record import open_run
from airhilt.scenario import Scenario
from airhilt.units import SECOND_NS

Picture = npt.NDArray[np.uint8]
OUTPUT = Path(__file__).parent.parent / "docs" / "images" / "run.webp"
SCENARIO, SHOWN_S = "s01a_misaddressed", (20.0, 80.0)
CAMERA = {
    "name": "tower",
    "mount": {
        "type": "fixed",
        "position": {"type": "geodetic", "lat_deg": 38.8500252, "lon_deg": -77.0420737},
        "height_ft": 187,
        "azimuth_deg": 152,
        "elevation_deg": -3,
    },
    "horizontal_fov_deg": 52,
    "width_px": 1280,
    "height_px": 720,
    "rate_hz": 2,
}
SIZE_INCHES, DOTS_PER_INCH = (9.6, 5.4), 100
PERIOD_S = 0.5
"""Simulated time between two pictures."""
PICTURES_PER_S = 8
LINES, LETTERS = 4, 132
"""Calls that stand on the picture at once, and letters in each."""
STYLE: dict[Any, Any] = {
    "axes.edgecolor": "none",
    "axes.facecolor": "#10151c",
    "figure.facecolor": "#10151c",
    "font.size": 9,
    "text.color": "#e6edf3",
}
QUIET, LOUD, WARNING = "#8b98a5", "#e6edf3", "#ff6b5e"


def video_pictures(path: Path, times_s: list[float]) -> Iterator[Picture]:
    """Yield the picture of a video that is shown at each of some rising times."""
    waiting = iter(times_s)
    due_s = next(waiting, None)
    with av.open(str(path)) as video:
        for frame in video.decode(video=0):
            while due_s is not None and (frame.time or 0.0) >= due_s:
                yield np.asarray(frame.to_ndarray(format="rgb24"), np.uint8)
                due_s = next(waiting, None)


class Plan:
    """The plan view: the airport, and each actor with its name and where it came from."""

    def __init__(
        self, axes: Axes, scene: Scene, story: Story, pair: list[str], *shown_s: float
    ) -> None:
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
        corners = np.array(
            [self._place(story.tracks[actor], t_s) for actor in pair for t_s in shown_s]
        )
        low, high = corners.min(axis=0), corners.max(axis=0)
        centre, half_m = (low + high) / 2.0, max(1500.0, 0.6 * (high - low).max())
        axes.set_xlim(centre[0] - half_m, centre[0] + half_m)
        axes.set_ylim(centre[1] - half_m, centre[1] + half_m)
        self._marks = {
            actor: (
                axes.plot([], [], color=np.divide(scene.colour(actor), 255.0), linewidth=1.2)[0],
                axes.plot([], [], "o", color=np.divide(scene.colour(actor), 255.0), markersize=5)[
                    0
                ],
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
        last = bisect_right(track, time_s * SECOND_NS, key=lambda state: state.t_ns) - 1
        east_m, north_m, _ = self._scene.pose(track[max(last, 0)]).position_m
        return east_m, north_m


class Radio:
    """The words on the frequency as they are spoken, and the advisories that are in force."""

    def __init__(self, axes: Axes, story: Story) -> None:
        self._axes, self._story = axes, story

    def draw(self, time_s: float) -> None:
        """Write what is heard, and what is told, at a time."""
        self._axes.clear()
        self._axes.set_axis_off()
        now_ns = time_s * SECOND_NS
        calls = [call for call in self._story.calls if call.t_tx_ns <= now_ns]
        for line, call in enumerate(calls[-LINES:]):
            said = min(1.0, (now_ns - call.t_tx_ns) / (call.t_end_ns - call.t_tx_ns))
            words = call.text[: round(said * len(call.text))]
            colour = LOUD if said < 1.0 else QUIET
            self._write(line, f"{call.speaker}: {words}", colour)
        told = [
            advisory
            for advisory, until_ns in self._story.advisories
            if advisory.t_ns <= now_ns < until_ns and advisory.severity in ("CAUTION", "WARNING")
        ]
        for line, advisory in enumerate(told[:2], LINES):
            self._write(line, f"to {advisory.recipient}: {advisory.message}", WARNING)

    def _write(self, line: int, words: str, colour: str) -> None:
        text = fill(words, LETTERS, max_lines=1, placeholder=" ...")
        self._axes.text(0.0, 1.0 - line / (LINES + 2), text, color=colour, va="top",
                        transform=self._axes.transAxes)  # fmt: skip


def draw(run: Result) -> None:
    """Write the moving picture of a run."""
    story, scene = Story.of(run), Scene(open_run(run.folder))
    times_s = [float(time_s) for time_s in np.arange(*SHOWN_S, PERIOD_S)]
    figure = Figure(figsize=SIZE_INCHES, dpi=DOTS_PER_INCH)
    view = figure.add_axes((0.0, 0.28, 0.66, 0.66))
    view.set_axis_off()
    pair = run.info.realised["conflict"]["actors"]
    plan = Plan(
        figure.add_axes((0.67, 0.28, 0.32, 0.66)), scene, story, pair, *times_s[len(times_s) // 3 :]
    )
    radio = Radio(figure.add_axes((0.01, 0.01, 0.98, 0.25)), story)
    figure.text(0.01, 0.955, f"{SCENARIO}: a camera on the tower")
    clock = figure.text(0.99, 0.955, "", ha="right")
    shown = None
    writer = PillowWriter(fps=PICTURES_PER_S)
    with writer.saving(figure, str(OUTPUT), DOTS_PER_INCH):
        pictures = video_pictures(run.folder / "video" / "tower.mp4", times_s)
        for time_s, picture in zip(times_s, pictures, strict=True):
            if shown is None:
                shown = view.imshow(picture, aspect="auto")
            shown.set_data(picture)
            plan.draw(time_s)
            radio.draw(time_s)
            clock.set_text(f"{time_s:.0f} s")
            writer.grab_frame()


def made_run() -> Result:
    """Make the run of `SCENARIO` with one camera on the tower, in a new folder."""
    changed = airhilt.load(SCENARIO).model_dump(mode="json")
    changed["cameras"] = [CAMERA]
    changed["weather"]["visibility_m"] = 12000
    changed["perturbations"] = [
        each for each in changed["perturbations"] if each["path"] != "weather/visibility_m"
    ]
    return airhilt.run(Scenario.model_validate(changed), latency="fixed", video=True)


def main() -> None:
    """Draw the picture."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--run", type=Path, metavar="RUN")
    args = parser.parse_args()
    with mpl.rc_context(STYLE):
        draw(open_result(args.run) if args.run else made_run())


if __name__ == "__main__":
    main()
