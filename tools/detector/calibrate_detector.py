r"""Fit a detector's confidences, and count its false detections in minutes of cameras.

    python tools/detector/calibrate_detector.py data/dev --network detector/detector.onnx \
        --seed 401 --airport KDCA --airport KSFO --airport EHAM --airport RJTT --airport en_route
    python tools/detector/calibrate_detector.py --seed 501 --airport LSZH --airport en_route

With folders of ``airhilt dataset export`` it fits how likely a finding is to be true by score,
size and class (see `airhilt.assistant.vision.detectors.embedded.Calibration`), and writes that
into the ``card.json`` beside the network, with the lowest threshold that gives at most one false
detection a minute for each kind of camera. Without folders it only counts.

Counted is before cameras like those of ``airhilt dataset export`` where nobody is: fixed ones, and
ones on aircraft that roll, fly straight or descend. Pictures are taken at 16 Hz and looked at as a
vision worker does: parts of the own aircraft are left out, and things are followed from picture to
picture. A false detection is one that is confirmed, that is, found three times: who listens to a
vision worker hears of it as one thing, however long it lasts.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from rich.progress import track
from scipy import optimize

from airhilt.assistant.vision.detector import Found, Picture, once
from airhilt.assistant.vision.detectors.embedded import (
    CARD,
    DOUBTFUL,
    LEAST_SCORE,
    MODEL,
    REFERENCE_PX,
    Calibration,
    EmbeddedDetector,
)
from airhilt.assistant.vision.tracker import Tracker
from airhilt.assistant.vision.worker import beside
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.messages import CONFIRMED_HITS, CameraView
from airhilt.sensors.cameras.dataset.pictures import scene_renderer_of
from airhilt.sensors.cameras.dataset.placement import cast, gone_on
from airhilt.sensors.cameras.dataset.scenes import Casting, Sitting, station_of
from airhilt.sensors.cameras.scene.bodies import BodyState
from airhilt.sensors.cameras.scene_renderer import SceneRenderer
from airhilt.sensors.cameras.sensor import view_message
from airhilt.sim.streams import stream
from airhilt.units import seconds_to_ns
from detector_data import CLASSES, Shot, read_folder
from detector_disturbances import half_disturbed
from eval_detector import loosely, matched, on_faint

RATE_HZ = 16.0
SIZE = (640, 360)
THRESHOLDS = tuple(round(1.0 / (1.0 + math.exp(-0.25 * step)), 3) for step in range(-8, 25))
RIDGE = 1e-2
"""Times the squares of the coefficients: what few findings tell is believed little."""
SMALL_CHANCE = 0.01
"""Findings of a score under it are left out of the fit."""
MOST_A_MINUTE = 1.0
MOST_RUNS_OF_A_SITTING = 6


@dataclass(frozen=True)
class Exposure:
    """A picture of a run: when and where to it was taken, and whether it is the last one again."""

    t_ns: int
    view: CameraView
    picture: Picture
    own: npt.NDArray[np.bool_]
    unchanged: bool


@dataclass
class Count:
    """Minutes of cameras of a kind, and false detections in them by threshold."""

    minutes: float = 0.0
    false: dict[float, int] = field(default_factory=lambda: dict.fromkeys(THRESHOLDS, 0))

    def a_minute(self, threshold: float) -> float:
        """Return how many there are in a minute."""
        return self.false[threshold] / self.minutes


def runs(
    casting: Casting, count: int, seed: int, seconds: float, renderer: str
) -> Iterator[tuple[str, Iterator[Exposure]]]:
    """Yield kinds of cameras, each with the pictures of one of them."""
    done = number = 0
    while done < count:
        sitting = casting.sitting(number, seed, "minutes")
        drawing = scene_renderer_of(sitting, renderer)
        try:
            chosen = sitting.order[:MOST_RUNS_OF_A_SITTING]
            for camera in chosen[: count - done]:
                draws = stream(seed, f"minutes/run/{sitting.place}", number, done)
                begin = cast(sitting, camera, draws, empty=1.0)
                yield (
                    station_of(camera),
                    shots(sitting, drawing, camera, begin, seconds),
                )
                done += 1
        finally:
            drawing.close()
        number += 1


def shots(
    sitting: Sitting,
    drawing: SceneRenderer,
    camera: str,
    begin: Sequence[BodyState],
    seconds: float,
) -> Iterator[Exposure]:
    """Yield the pictures of a camera while its aircraft, if it has one, goes on."""
    frame = sitting.layout.local_frame if sitting.layout is not None else LocalFrame((0.8, 0.0))
    carrier = sitting.cameras[camera].carrier
    for index in range(round(seconds * RATE_HZ)):
        t_s = index / RATE_HZ
        taken = drawing.shoot([camera], [gone_on(body, t_s) for body in begin], seconds_to_ns(t_s))[
            0
        ]
        number = drawing.actors.index(carrier) + 1 if carrier is not None else -1
        yield Exposure(
            taken.t_ns,
            view_message(taken.view, frame, carrier),
            taken.colour,
            taken.instance == number,
            taken.unchanged,
        )


def false_detections(detector: EmbeddedDetector, pictures: Iterator[Exposure]) -> dict[float, int]:
    """Return for each threshold how many things are confirmed that are not there."""
    trackers = {threshold: Tracker(threshold) for threshold in THRESHOLDS}
    confirmed: dict[float, set[int | None]] = {threshold: set() for threshold in THRESHOLDS}
    found: list[Found] = []
    for shot in pictures:
        if not shot.unchanged:
            found = beside(shot.own, detector.detect(shot.picture))
        for threshold, tracker in trackers.items():
            heard = [each for each in found if each.confidence >= DOUBTFUL * threshold]
            confirmed[threshold] |= {
                each.track_id
                for each in tracker.follow(shot.t_ns, shot.view, heard)
                if each.hits >= CONFIRMED_HITS
            }
    return {threshold: len(ids) for threshold, ids in confirmed.items()}


def counted(
    detector: EmbeddedDetector, casting: Casting, count: int, seed: int, seconds: float,
    renderer: str,
) -> dict[str, Count]:  # fmt: skip
    """Return what is counted for each kind of camera."""
    counts: dict[str, Count] = {}
    each = runs(casting, count, seed, seconds, renderer)
    for kind, pictures in track(
        each, "cameras", total=count, transient=True, disable=not sys.stderr.isatty()
    ):
        of_kind = counts.setdefault(kind, Count())
        of_kind.minutes += seconds / 60.0
        for threshold, number in false_detections(detector, pictures).items():
            of_kind.false[threshold] += number
    return counts


def chosen_threshold(counts: Mapping[str, Count]) -> float:
    """Return the lowest from which on no kind of camera has more than allowed."""
    bad = [
        threshold
        for threshold in THRESHOLDS
        if any(count.a_minute(threshold) > MOST_A_MINUTE for count in counts.values())
    ]
    better = [threshold for threshold in THRESHOLDS if threshold > max(bad, default=0.0)]
    if not better:
        raise SystemExit(f"{max(THRESHOLDS)} gives more than {MOST_A_MINUTE:g} a minute")
    return better[0]


def findings(
    detector: EmbeddedDetector, pictures: Sequence[Shot], seed: int
) -> tuple[list[Found], list[bool]]:
    """Return what is found in pictures, every second disturbed, uncalibrated, and if it is true.

    What lies on bodies that can hardly be seen, or on the own aircraft, is left out.
    """
    found: list[Found] = []
    is_true: list[bool] = []
    seen = half_disturbed(pictures, (seed,))
    for shot, picture in track(
        seen, "pictures", len(pictures), transient=True, disable=not sys.stderr.isatty()
    ):
        told = sorted(detector.uncalibrated(picture), key=lambda one: -one.confidence)
        here = [
            each
            for each in beside(shot.own_aircraft(), once(told))
            if each.confidence >= SMALL_CHANCE and not on_faint(shot.bodies, each)
        ]
        _, used = matched(shot.bodies, here, loosely)
        found += here
        is_true += [index in used for index in range(len(here))]
    return found, is_true


def fitted(found: Sequence[Found], is_true: Sequence[bool]) -> Calibration:
    """Return the calibration under which what is true and what is not is most likely."""
    label = np.array([CLASSES.index(each.label) for each in found])
    score = np.array([each.confidence for each in found]).clip(LEAST_SCORE, 1.0 - LEAST_SCORE)
    sides = np.array(
        [max(each.box[2] - each.box[0], each.box[3] - each.box[1], 1.0) for each in found]
    )
    x, u = np.log(score / (1.0 - score)), np.log2(sides / REFERENCE_PX)
    columns = np.column_stack((np.eye(len(CLASSES))[label], x, u, u * u, x * u))
    signs = np.where(is_true, 1.0, -1.0)

    def loss(coefficients: npt.NDArray[np.float64]) -> float:
        odds = columns @ coefficients
        return float(
            np.logaddexp(0.0, -signs * odds).mean()
            + RIDGE / len(found) * coefficients @ coefficients
        )

    best = optimize.minimize(loss, np.zeros(columns.shape[1]), method="L-BFGS-B").x
    by_class = {name: round(float(best[index]), 4) for index, name in enumerate(CLASSES)}
    logit, size, squared, both = (round(float(value), 4) for value in best[len(CLASSES) :])
    return Calibration(
        of_class=by_class, logit=logit, size=size, size_squared=squared, logit_and_size=both
    )


def main() -> None:
    """Fit if there are pictures, count, and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*", type=Path, metavar="DATA", help="pictures to fit on")
    parser.add_argument("--network", type=Path, default=MODEL, metavar="FILE")
    parser.add_argument("--airport", action="append", required=True, metavar="ICAO")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--cameras", type=int, default=36, help="number of cameras")
    parser.add_argument(
        "--seconds", type=float, default=20.0, help="time that each camera runs, in s"
    )
    parser.add_argument("--renderer", default="moderngl")
    given = parser.parse_args()
    path = given.network.with_name(CARD)
    card: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    if given.folders:
        shots = [shot for folder in given.folders for shot in read_folder(folder)]
        calibration = fitted(*findings(EmbeddedDetector(given.network), shots, given.seed))
        card["calibration"] = calibration.model_dump()
        write(path, card)
    detector = EmbeddedDetector(given.network, DOUBTFUL * min(THRESHOLDS))
    casting = Casting(given.airport, SIZE)
    counts = counted(detector, casting, given.cameras, given.seed, given.seconds, given.renderer)
    kinds = sorted(counts)
    print("threshold  " + "  ".join(f"{kind:>10}" for kind in kinds) + "   false a minute")
    for threshold in THRESHOLDS:
        cells = (f"{counts[kind].a_minute(threshold):10.2f}" for kind in kinds)
        print(f"{threshold:9.3f}  " + "  ".join(cells))
    print("minutes    " + "  ".join(f"{counts[kind].minutes:10.1f}" for kind in kinds))
    if given.folders:
        card["threshold"] = chosen_threshold(counts)
        card["false_a_minute"] = {
            kind: round(counts[kind].a_minute(card["threshold"]), 2) for kind in kinds
        }
        card["counted_minutes"] = {kind: round(counts[kind].minutes, 1) for kind in kinds}
        write(path, card)
        print(f"{path}: threshold {card['threshold']}")


def write(path: Path, card: dict[str, Any]) -> None:
    """Write a card."""
    path.write_text(json.dumps(card, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
