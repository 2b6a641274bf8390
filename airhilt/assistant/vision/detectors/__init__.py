"""The detectors: one file an engine, each with its `ENGINE`.

A detector of another package is found by an entry point of the group ``airhilt.detectors`` that
names its `airhilt.engines.Engine`, such as ``mine = "my_package.detector:ENGINE"``.
"""

from __future__ import annotations

from collections.abc import Sequence

from airhilt.assistant.vision.detector import Detector
from airhilt.engines import EngineFamily
from airhilt.errors import VisionError

FAMILY = EngineFamily[Detector](
    "detector",
    "airhilt.detectors",
    __name__,
    "ENGINE",
    error=VisionError,
    product=Detector,
)


def vision_engine(name: str, also: Sequence[str] = ()) -> Detector:
    """Return the detector of a name such as ``embedded`` or ``yolo:models/yolov10n.pt``.

    Parameters
    ----------
    also
        Words that the caller takes in the place of a name, such as ``none``, for error messages.

    Raises
    ------
    VisionError
        There is none of that name, or it cannot be loaded.
    """
    return FAMILY.create(name, also)
