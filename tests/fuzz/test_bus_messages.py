"""Whatever a program publishes is a message of its key, or refused by name."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel, ValidationError

from airhilt.errors import WorkerError
from airhilt.messages import BUS_MESSAGES, UNREGISTERED, WORKER_MESSAGES, WORKER_OUTPUTS
from airhilt.workers.pool import parse_output
from fuzzing import any_input

MODELS: dict[str, type[BaseModel]] = {**BUS_MESSAGES, **WORKER_MESSAGES}
LONGEST = 2000
"""Greatest number of characters of an error."""

leaves = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20)
values = st.recursive(
    leaves,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner),
    max_leaves=10,
)


def like(model: type[BaseModel]) -> st.SearchStrategy[dict[str, Any]]:
    """Return documents with the fields of a model, of any values."""
    names = list(model.model_fields)
    return st.dictionaries(
        st.sampled_from(names) | st.text(max_size=5), values, max_size=len(names)
    )


@any_input
@given(st.sampled_from(sorted(MODELS)), st.data())
def test_what_is_accepted_is_written_and_read_as_the_same(name: str, data: st.DataObject) -> None:
    model = MODELS[name]
    try:
        message = model.model_validate_json(json.dumps(data.draw(like(model))))
    except ValidationError:
        return
    assert model.model_validate_json(message.model_dump_json()) == message


KEYS = sorted({key.replace("*", chunk) for key in WORKER_OUTPUTS for chunk in ("AAL123", "119100")})


@any_input
@given(
    st.sampled_from(KEYS) | st.text(max_size=20),
    st.binary(max_size=200) | values.map(lambda value: json.dumps(value).encode()),
    values,
    st.sampled_from([UNREGISTERED, "detector"]),
)
def test_any_output_of_a_worker_is_a_message_or_refused_by_name(
    key: str, payload: bytes, attachment: Any, worker: str
) -> None:
    with pytest.raises(WorkerError) as refused:
        parse_output(worker, key, payload, 1_000, attachment)
    assert len(str(refused.value)) <= LONGEST
