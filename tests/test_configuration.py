"""Configurations take what they have, and answer the rest with what would be right."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from airhilt.assistant.decision.engines.reference import ReferenceEngine
from airhilt.configuration import read_configuration, settings
from airhilt.engine_families import ASSISTANTS
from airhilt.errors import AirhiltError
from airhilt.scenario import documents
from paths import DOCS


def test_values_take_the_place_of_defaults_and_of_nothing_else() -> None:
    engine = ASSISTANTS.create("reference", configuration={"runways": {"warning_s": 8}})
    assert isinstance(engine, ReferenceEngine)
    assert engine.configuration.runways.warning_s == 8.0
    assert engine.configuration.runways.caution_s == 60.0
    assert engine.configuration.separation == ReferenceEngine().configuration.separation


@pytest.mark.parametrize(
    ("given", "answer"),
    {
        "a misspelt name": ({"runways": {"warning": 8}}, "runways/warning: .*did you mean 'warn"),
        "a misspelt part": ({"runway": {}}, "runway: .*did you mean 'runways'"),
        "a name of a part": ({"late_s": 8}, "late_s: .*did you mean 'runways/late_s'"),
        "beyond a limit": ({"sight": {"tau_vis": 1.5}}, "sight/tau_vis: .*less than or equal to 1"),
        "in the wrong order": (
            {"runways": {"warning_s": 70}}, "runways: warning_s is 70; expected at most caution_s",
        ),
        "a rule of another name": ({"runways": {"rules": ["occupied"]}}, "'occupancy'"),
        "not a number": ({"runways": {"warning_s": "soon"}}, "valid number.*found 'soon'"),
    }.values(),
)  # fmt: skip
def test_what_is_wrong_is_answered_with_what_would_be_right(given: Any, answer: str) -> None:
    with pytest.raises(AirhiltError, match=f"^configuration of 'reference': .*{answer}"):
        ASSISTANTS.create("reference", configuration=given)


@pytest.mark.parametrize(
    ("content", "answer"), [("[1]", "expected a JSON object"), ("{", "no JSON"), (None, "No such")]
)
def test_a_file_that_holds_no_object_is_refused_by_its_name(
    tmp_path: Path, content: str | None, answer: str
) -> None:
    path = tmp_path / "mine.json"
    if content is not None:
        path.write_text(content)
    with pytest.raises(AirhiltError, match=f"{re.escape(str(path))}: .*{answer}"):
        read_configuration(path)


@pytest.mark.parametrize("read", [read_configuration, documents.read])
def test_a_pipe_or_a_device_is_refused_and_not_read(
    tmp_path: Path, read: Callable[[Path], Any]
) -> None:
    os.mkfifo(tmp_path / "pipe.json")
    for path in (tmp_path / "pipe.json", Path("/dev/zero")):
        with pytest.raises(AirhiltError, match=f"{re.escape(str(path))}: .*no regular file"):
            read(path)


@pytest.mark.parametrize("name", ["reference", "paper"])
def test_every_setting_says_what_it_is_and_time_its_unit_and_source(name: str) -> None:
    for place, field in settings(ASSISTANTS.configuration_model(name)):
        assert field.description, place
        if place[-1].endswith("_s"):
            assert re.search(r"\bin s\b", field.description), place
            assert re.search(r"chosen|assumption|EUROCONTROL|arXiv", field.description), place


def test_the_engine_of_the_page_has_its_configuration() -> None:
    blocks = re.findall(r"```python\n(.*?)```", (DOCS / "your-assistant.md").read_text(), re.DOTALL)
    names: dict[str, Any] = {}
    exec(next(block for block in blocks if "class Calm" in block), names)
    engine = names["ENGINE"]
    calm = engine.create("", engine.configured({"least_ft": 500}))
    assert calm.configuration.least_ft == 500.0
    with pytest.raises(AirhiltError, match=r"'calm': least_ft: .* 5000, found 6000"):
        engine.configured({"least_ft": 6000})
