"""Forms with a file, there and back."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from airhilt.host.forms import decoded_form, encoded_form


@given(st.binary(max_size=2_000), st.text(st.characters(codec="ascii", exclude_categories=["Cc"])))
def test_a_form_arrives_as_it_was_sent(file: bytes, text: str) -> None:
    body, content_type = encoded_form({"prompt": text, "file": file})
    assert decoded_form(body, content_type) == {"prompt": text.encode(), "file": file}


def test_what_is_no_form_has_no_fields() -> None:
    assert decoded_form(b"RIFF", "audio/wav") == {}
    assert decoded_form(b"RIFF", "multipart/form-data") == {}
