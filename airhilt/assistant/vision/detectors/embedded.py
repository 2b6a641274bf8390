"""The embedded detector: a small network that was trained on pictures of AIRHILT.

It looks for the middles of bodies (X. Zhou et al., Objects as Points, arXiv 1904.07850). A second
network refines what it proposes: see `airhilt.assistant.vision.refiner`.
``tools/detector/train_detector.py`` and ``tools/detector/train_refiner.py`` make the networks, and
docs/detector.md says how well they see.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import numpy as np
import onnxruntime
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from airhilt.assistant.vision.detector import GRID_PX, Found, Picture, Shot, once
from airhilt.assistant.vision.refiner import Refiner, RefinerCard
from airhilt.assistant.vision.tiling import Tile
from airhilt.engines import Engine
from airhilt.errors import VisionError, first_line, first_problem
from airhilt.host.files import read_file, sha256
from airhilt.host.onnx import open_network, require_end
from airhilt.imaging.boxes import area, moved, size_px, within
from airhilt.messages import Confidence, VisibleClass

MODEL = Path(__file__).parents[1] / "model" / "detector.onnx"
LARGEST_CARD_BYTES = 1_000_000
"""Size of the largest file of names and numbers that is read."""
CARD = "card.json"
EXPECTED = (
    "a network of tools/detector/train_detector.py: "
    "'picture', uint8 [1, rows, columns, 3], to 'found', "
    "float [1, n, 6]: left, top, right, bottom, score, class"
)
SMALLEST_PX = 64
"""Shortest side of a picture for the network, in pixels.

Pictures get that and a multiple of `GRID_PX`: their last rows and columns are repeated."""
REFERENCE_PX = 32.0
MOST_LOG_ODDS = 30.0
LEAST_SCORE = 1e-4
"""Least score, and least distance of a score from 1, in the calibration."""
THREADS = 2
"""Number of threads; a run waits while a picture is looked at, and two are faster."""
DOUBTFUL = 0.5
"""Share of the threshold from which findings are reported, so that they can continue tracks."""


class Calibration(BaseModel):
    """Probability that a finding is true, by the network's score, the size and the class.

    The logarithm of the odds is ``of_class + logit x + size u + size_squared u^2 +
    logit_and_size x u``, where ``x`` is that of the score and ``u`` the binary logarithm of the
    longest side of the box over `REFERENCE_PX` (J. Platt, 1999, with the size besides). A network
    is wrong about specks more often than about big bodies.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)
    of_class: dict[VisibleClass, float] = {}
    logit: float = 1.0
    size: float = 0.0
    size_squared: float = 0.0
    logit_and_size: float = 0.0

    def log_odds(self, label: VisibleClass, score: float, longest_px: float) -> float:
        """Return the logarithm of the odds that a finding is true."""
        score = min(max(score, LEAST_SCORE), 1.0 - LEAST_SCORE)
        x, u = math.log(score / (1.0 - score)), math.log2(max(longest_px, 1.0) / REFERENCE_PX)
        slope = self.logit + self.logit_and_size * u
        return self.of_class.get(label, 0.0) + slope * x + (self.size + self.size_squared * u) * u


class Card(BaseModel):
    """The part of the ``card.json`` beside a network that `EmbeddedDetector` reads."""

    model_config = ConfigDict(extra="ignore", frozen=True, allow_inf_nan=False)
    classes: Annotated[tuple[VisibleClass, ...], Field(min_length=1)]
    """Classes in the order of their numbers in the network's output."""
    threshold: Confidence
    """Confidence from which a finding counts by itself.

    It gives one false detection a minute and camera; docs/detector.md says how many elsewhere."""
    calibration: Calibration = Calibration()
    refiner: RefinerCard | None = None
    """Second network; None where the first one's findings are final."""


class EmbeddedDetector:
    """Detects with the network that ships with AIRHILT, or another of its kind.

    Parameters
    ----------
    path
        ONNX file, with its ``card.json`` beside it.
    threshold
        Confidence below which nothing is reported; None: `DOUBTFUL` times the card's.

    Raises
    ------
    VisionError
        A file is missing, or is not what it must be.
    """

    name = "embedded"

    def __init__(
        self, path: Path | None = None, threshold: float | None = None, threads: int = THREADS
    ) -> None:
        file = path or MODEL
        self._card = card = _card(file.with_name(CARD))
        self.threshold = card.threshold
        self._threshold = DOUBTFUL * card.threshold if threshold is None else threshold
        self._files = [file, file.with_name(CARD)]
        self._subject = f"detector {file}"
        self._network = open_network(file, self._subject, EXPECTED, VisionError, threads)
        inputs, outputs = self._network.get_inputs(), self._network.get_outputs()
        takes = [(each.name, each.type, each.shape[-1]) for each in inputs]
        gives = [(each.name, each.type, each.shape[-1]) for each in outputs]
        if takes != [("picture", "tensor(uint8)", 3)] or gives != [("found", "tensor(float)", 6)]:
            both = (*inputs, *outputs)
            told = ", ".join(f"{each.name!r} {each.type} {each.shape}" for each in both)
            raise VisionError(f"{self._subject} has {told}; expected {EXPECTED}")
        empty = np.zeros((1, SMALLEST_PX, SMALLEST_PX, 3), np.uint8)
        require_end(self._network, {"picture": empty}, self._subject, VisionError)
        self._refiner: Refiner | None = None
        if card.refiner is not None:
            self._files.append(file.with_name(card.refiner.file))
            self._refiner = Refiner(card.refiner, file.parent, card.classes, threads)
        self._least_score = 0.0 if card.refiner is None else card.refiner.least_score

    @property
    def identity(self) -> Sequence[str]:
        """SHA-256 of the files, the threshold, and the library: its version and providers."""
        library = f"onnxruntime {onnxruntime.__version__} {' '.join(self._network.get_providers())}"
        return (*(sha256(file) for file in self._files), repr(self._threshold), library)

    def detect(self, picture: Picture) -> Sequence[Found]:
        """Return what is in a picture; see `Detector.detect`."""
        return self._told(picture, self.proposed(picture, self._least_score))

    def detect_in(
        self,
        picture: Picture,
        part: Tile,
        shot: Shot,  # noqa: ARG002
    ) -> Sequence[Found]:
        """Return what is in a part of a picture; see `airhilt.assistant.vision.gating.SeesParts`.

        The first network was trained on tiles of 96 to 288 pixels. The refiner has the whole
        picture.
        """
        proposed = self.proposed(part.of(picture), self._least_score)
        moved_to_part = [one._replace(box=moved(one.box, part.left, part.top)) for one in proposed]
        return self._told(picture, moved_to_part)

    def _told(self, picture: Picture, proposed: list[Found]) -> Sequence[Found]:
        found = []
        for one in self._judged(picture, proposed):
            odds = self._card.calibration.log_odds(one.label, one.confidence, size_px(one.box))
            odds = min(max(odds, -MOST_LOG_ODDS), MOST_LOG_ODDS)
            found.append(one._replace(confidence=1.0 / (1.0 + math.exp(-odds))))
        told = [one for one in found if one.confidence >= self._threshold]
        told.sort(key=lambda one: -one.confidence)
        return told if self._refiner is None else once(told)

    def uncalibrated(self, picture: Picture) -> list[Found]:
        """Return all findings of the last network, with its scores as confidences.

        The refiner may move several onto one body.
        """
        return self._judged(picture, self.proposed(picture))

    def _judged(self, picture: Picture, proposed: list[Found]) -> list[Found]:
        if self._refiner is None:
            return proposed
        rows, columns = picture.shape[:2]
        places = self._refiner.places(proposed, rows * columns)
        judged = self._refiner.judge(picture, places)
        inside = [one._replace(box=within(one.box, columns, rows)) for one in judged]
        return [one for one in inside if area(one.box) > 0.0]

    def proposed(self, picture: Picture, least_score: float = 0.0) -> list[Found]:
        """Return the findings of the first network from a score on, the highest scores first."""
        rows, columns = picture.shape[:2]
        try:
            found = self._network.run(["found"], {"picture": _padded(picture)[None]})[0][0]
        except Exception as error:  # onnxruntime raises classes of its own that share no base
            raise VisionError(f"{self._subject} has failed: {first_line(error)}") from None
        found = found[found[:, 4] >= least_score]
        boxes = [within(tuple(box), columns, rows) for box in found[:, :4].tolist()]
        proposed = [
            Found(self._card.classes[int(number)], score, box)
            for box, (score, number) in zip(boxes, found[:, 4:].tolist(), strict=True)
            if area(box) > 0.0
        ]
        return sorted(proposed, key=lambda one: -one.confidence)


def _card(path: Path) -> Card:
    try:
        return Card.model_validate_json(read_file(path, LARGEST_CARD_BYTES))
    except (OSError, ValidationError) as error:
        why = first_problem(error) if isinstance(error, ValidationError) else error.strerror
        raise VisionError(
            f"{path}: {why}; expected what tools/detector/train_detector.py writes beside a network"
        ) from None


def _padded(picture: Picture) -> Picture:
    rows, columns = picture.shape[:2]
    below, beside = (max(side + -side % GRID_PX, SMALLEST_PX) - side for side in (rows, columns))
    if not below and not beside:
        return np.ascontiguousarray(picture)
    return np.pad(picture, ((0, below), (0, beside), (0, 0)), mode="edge")


def has_card(path: Path) -> bool:
    """Return whether an ``.onnx`` file has a card beside it, as those of this project have."""
    return path.suffix == ".onnx" and path.with_name(CARD).is_file()


ENGINE = Engine(
    name="embedded",
    summary="small network trained on pictures of AIRHILT; ships with it",
    create=lambda file: EmbeddedDetector(Path(file) if file else None),
    argument="FILE.onnx",
    takes=lambda text: has_card(Path(text)),
)
