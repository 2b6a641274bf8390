"""The workers that AIRHILT brings along, one by one."""

from __future__ import annotations

import pytest

from airhilt.assistant.reference import reference_worker, vision_worker
from airhilt.assistant.vision.shared_looks import SharedLooks
from airhilt.assistant.vision.worker import VisionWorker
from airhilt.engine_families import FAMILIES
from airhilt.errors import WorkerError

SERVICE = "http://127.0.0.1:9"
"""A service, which nobody asks as long as there is nothing to do."""


@pytest.mark.parametrize("kind", sorted({family.modality for family in FAMILIES}))
def test_a_worker_is_called_by_its_task_unless_it_has_a_name(kind: str) -> None:
    engine = SERVICE if kind in ("asr", "tts") else None
    for name in (None, "mine"):
        description = reference_worker(kind, engine, name).description
        assert (description.modality, description.name) == (kind, name or kind)


def test_there_is_no_other_kind_of_worker() -> None:
    with pytest.raises(WorkerError, match="no reference worker 'radar'"):
        reference_worker("radar")


@pytest.mark.parametrize(
    ("detector", "shares", "is_shared"),
    [("embedded", True, True), ("embedded", False, False)],
)
def test_detections_are_shared_if_that_is_asked_for_and_the_detector_repeats_them(
    detector: str, shares: bool, is_shared: bool
) -> None:
    worker = vision_worker(detector, shares_detections=shares)
    assert isinstance(worker, VisionWorker)
    assert isinstance(worker._gate._looks, SharedLooks) is is_shared
