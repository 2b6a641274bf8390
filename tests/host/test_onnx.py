"""Execution providers of networks."""

from __future__ import annotations

import pytest

from airhilt.assistant.vision.detectors.embedded import EmbeddedDetector
from airhilt.errors import AirhiltError, VisionError
from airhilt.host.onnx import CPU, PROVIDERS, providers


@pytest.mark.parametrize("given", ["", CPU, f" {CPU} ,"])
def test_the_processor_does_what_no_other_provider_does(
    monkeypatch: pytest.MonkeyPatch, given: str
) -> None:
    monkeypatch.setenv(PROVIDERS, given)
    assert providers(AirhiltError) == [CPU]


def test_a_provider_that_is_not_there_is_an_error_that_names_those_that_are(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv(PROVIDERS, "WarpExecutionProvider")
    with pytest.raises(VisionError, match=rf"'WarpExecutionProvider'.*expected of .*{CPU}"):
        EmbeddedDetector()
