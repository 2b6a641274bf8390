"""Detections that runs share: what a detector finds in a picture, kept by the picture's content.

Runs of one sweep that differ only in what cameras cannot see look at the same pictures until
somebody acts on an advisory. A detector whose answer depends on the picture alone need not look at
one twice. Which parts of a picture it is asked about is left to
`airhilt.assistant.vision.gating.Gate`, so a run that shares has the same detections as one that
does not.
"""

from __future__ import annotations

import hashlib
import json
import platform
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Protocol, runtime_checkable

import numpy as np

import airhilt.assistant.vision
import airhilt.imaging
from airhilt.assistant.vision.detector import Detector, Found, Picture
from airhilt.assistant.vision.gating import SeesParts
from airhilt.assistant.vision.tiling import Tile
from airhilt.caches import CacheFolder
from airhilt.files import source_sha256

PROCESSOR = Path("/proc/cpuinfo")
"""Description of the processor on Linux: networks are computed with the instructions it has."""


@runtime_checkable
class Reproducible(SeesParts, Protocol):
    """A detector whose answer depends on its files, its libraries and the picture alone."""

    @property
    def identity(self) -> Sequence[str]:
        """SHA-256 of its files, and names and versions of its libraries."""
        ...


class SharedDetector:
    """Asks a detector about each picture once, whichever process has asked before.

    Attributes
    ----------
    name, threshold
        As those of the detector.
    """

    def __init__(self, detector: Reproducible) -> None:
        self.name, self.threshold = detector.name, detector.threshold
        self._detector = detector
        self._folder = CacheFolder("detections")
        self._identity = [_code(), *detector.identity, np.__version__, _processor()]
        self._last: tuple[Picture, str] | None = None

    def detect(self, picture: Picture) -> Sequence[Found]:
        """Return what is in a picture; see `Detector.detect`."""
        return self._found(picture, None, lambda: self._detector.detect(picture))

    def detect_in(self, picture: Picture, part: Tile) -> Sequence[Found]:
        """Return what is in a part of a picture; see `SeesParts.detect_in`."""
        return self._found(picture, part, lambda: self._detector.detect_in(picture, part))

    def _found(
        self, picture: Picture, part: Tile | None, detect: Callable[[], Sequence[Found]]
    ) -> Sequence[Found]:
        key = json.dumps([*self._identity, picture.shape, self._sha256(picture), part])
        content = self._folder.get(key, lambda: json.dumps(detect()).encode())
        return [
            Found(label, confidence, tuple(box)) for label, confidence, box in json.loads(content)
        ]

    def _sha256(self, picture: Picture) -> str:
        """Return the SHA-256 of the pixels; several parts of one picture may be asked for."""
        if self._last is None or self._last[0] is not picture:
            digest = hashlib.sha256(np.ascontiguousarray(picture).data).hexdigest()
            self._last = picture, digest
        return self._last[1]


def shared(detector: Detector) -> Detector:
    """Return a detector that shares what it finds, or itself if it may answer differently."""
    return SharedDetector(detector) if isinstance(detector, Reproducible) else detector


def _code() -> str:
    packages = (airhilt.imaging, airhilt.assistant.vision)
    return source_sha256(*(Path(place) for package in packages for place in package.__path__))


def _processor() -> str:
    """Return what is known of the processor, by which libraries choose their instructions."""
    known = {platform.machine()}
    with suppress(OSError):
        lines = PROCESSOR.read_text().splitlines()
        known |= {line for line in lines if line.startswith(("flags", "Features", "model name"))}
    return hashlib.sha256("\n".join(sorted(known)).encode()).hexdigest()
