"""Looks that runs share: what a detector finds in a picture, kept by the content of pictures.

Runs of one sweep that differ only in what cameras cannot see look at the same pictures until
somebody acts on an advisory. What a `airhilt.assistant.vision.gating.Gate` finds in one depends on
the pictures before it, so a look is kept by the SHA-256 of all of them. Who has looked at the same
ones needs neither the detector nor the pixels.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Protocol, runtime_checkable

import numpy as np

import airhilt.assistant.vision
import airhilt.imaging
from airhilt.assistant.vision.detector import Found
from airhilt.assistant.vision.gating import Look, SeesParts
from airhilt.assistant.vision.tiling import Tile
from airhilt.host.caches import CacheFolder
from airhilt.host.files import source_sha256
from airhilt.host.machine import processor_sha256


@runtime_checkable
class Reproducible(SeesParts, Protocol):
    """A detector whose answer depends on its files, its libraries and the picture alone."""

    @property
    def identity(self) -> Sequence[str]:
        """SHA-256 of its files, and names and versions of its libraries."""


class SharedLooks:
    """The looks of one detector at tiles, for all processes of a user."""

    def __init__(self, detector: Reproducible) -> None:
        self._folder = CacheFolder("detections")
        self._identity = [_code(), *detector.identity, np.__version__, processor_sha256()]

    def get(
        self,
        history: str,
        tile: Tile,
        shape: Sequence[int],
        plan: Sequence[object] | None,
        look: Callable[[], Look],
    ) -> Look:
        """Return a look, which is taken if nobody has after pictures with the same hash.

        Parameters
        ----------
        plan
            All else that it depends on, as JSON.
        """
        key = json.dumps([*self._identity, history, tile, shape, plan])
        kept = self._folder.get(key, lambda: json.dumps(look()).encode())
        windows, found, is_partial = json.loads(kept)
        return Look(
            tuple(Tile(*window) for window in windows),
            tuple(Found(label, confidence, tuple(box)) for label, confidence, box in found),
            is_partial,
        )


def _code() -> str:
    packages = (airhilt.imaging, airhilt.assistant.vision)
    return source_sha256(*(Path(place) for package in packages for place in package.__path__))
