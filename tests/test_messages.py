"""Every message on the bus is strict, has a schema and, if it comes from outside, a limit."""

from __future__ import annotations

import json
import re

import pytest
from pydantic import ValidationError

from airhilt.messages import (
    BUS_MESSAGES,
    WORKER_MESSAGES,
    WORKER_OUTPUTS,
    ActorCommand,
    Climb,
    Clock,
    Detection,
    LiveReport,
    Message,
    PageRefusal,
    Part,
    PartialTranscript,
    SeatAction,
    Severity,
    bus_message,
    json_schemas,
)

MODELS = {**BUS_MESSAGES, **WORKER_MESSAGES}
CLOCK = {"run": "r1", "phase": "running", "pace": "virtual"}


def test_messages_have_one_base_which_is_strict() -> None:
    assert all(issubclass(model, Message) for model in BUS_MESSAGES.values())
    assert all(issubclass(model, Part) for model in WORKER_MESSAGES.values())
    with pytest.raises(ValidationError, match="Extra inputs are not permitted"):
        Clock.model_validate(CLOCK | {"colour": "red"})
    with pytest.raises(ValidationError, match="greater than or equal to 0"):
        Clock.model_validate(CLOCK | {"t_ns": -1})
    with pytest.raises(ValidationError, match="finite"):
        Climb(sense="climb", altitude_ft=float("nan"), vertical_rate_fpm=1.0)


def test_a_key_tells_the_class_of_its_messages_unless_it_has_several() -> None:
    for template, model in BUS_MESSAGES.items():
        key, _, one_of_several = template.partition(" ")
        key = re.sub(r"{\w+}", "A_1", key)
        assert bus_message(key) is (None if one_of_several else model), template
        assert bus_message(f"{key}/more/of/it") is None


def test_severities_rise_from_info_to_warning() -> None:
    assert [severity.rank for severity in Severity] == [0, 1, 2, 3]
    assert Severity.INFO.rank < Severity.WARNING.rank


def test_there_is_a_schema_for_every_key() -> None:
    schemas = json_schemas()
    assert set(schemas) == set(MODELS)
    assert json.loads(json.dumps(schemas)) == schemas
    assert all(schemas[key]["title"] == model.__name__ for key, model in MODELS.items())


def test_the_schema_has_the_limit_of_every_key_that_others_publish_on() -> None:
    limits = {
        key: schema["x-airhilt-limit"]
        for key, schema in json_schemas().items()
        if "x-airhilt-limit" in schema
    }
    assert limits["advisory/{recipient}"] == {"size_bytes": 32_000, "rate_hz": 50}
    assert {MODELS[key] for key in limits} == {
        *WORKER_OUTPUTS.values(), PartialTranscript, ActorCommand, LiveReport, PageRefusal,
        SeatAction,
    }  # fmt: skip


def test_a_detection_whose_box_has_no_room_is_refused() -> None:
    for box in ((5.0, 5.0, 5.0, 5.0), (30.0, 10.0, 8.0, 6.0), (1.0, 9.0, 8.0, 2.0)):
        with pytest.raises(ValidationError, match="no width and height"):
            Detection(label="airplane", confidence=0.5, box=box)
