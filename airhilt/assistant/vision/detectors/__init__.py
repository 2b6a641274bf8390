"""The detectors: one file an engine, each with its `ENGINE`.

A detector of another package is found by an entry point of the group ``airhilt.detectors`` that
names its `airhilt.engines.Engine`, such as ``mine = "my_package.detector:ENGINE"``.
"""

from __future__ import annotations

from airhilt.assistant.vision.detector import Detector
from airhilt.engine_families import DETECTORS
from airhilt.engines import EngineFamily

FAMILY: EngineFamily[Detector] = DETECTORS


def vision_engine(name: str) -> Detector:
    """Return the detector of a name such as ``embedded`` or ``yolo:models/yolov10n.pt``.

    Raises
    ------
    VisionError
        There is none of that name, or it cannot be loaded.
    """
    return FAMILY.create(name)
