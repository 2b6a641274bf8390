"""Any document is a scenario, or refused in few words; mutated scenarios have tests of their own.

`tools/fuzz_scenarios.py` mutates those that ship.
"""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from airhilt.errors import AirhiltError
from airhilt.world.loading import load_text
from fuzzing import any_input

KEYS = ("name", "title", "family", "scene", "type", "duration_s", "actors", "radio", "cameras")
numbers = st.integers() | st.floats()
leaves = st.none() | st.booleans() | numbers | st.text(max_size=20) | st.sampled_from(KEYS)
documents = st.recursive(
    leaves,
    lambda inner: (
        st.lists(inner, max_size=5)
        | st.dictionaries(st.sampled_from(KEYS) | st.text(max_size=8), inner, max_size=8)
    ),
    max_leaves=30,
)


@any_input
@given(documents.map(json.dumps) | st.text())
def test_any_document_that_is_no_scenario_is_refused_in_few_words(text: str) -> None:
    with pytest.raises(AirhiltError) as refused:
        load_text(text, "any.json")
    assert len(str(refused.value)) <= 500
