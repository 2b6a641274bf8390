"""Any bytes are a WAV file of speech, or refused by name."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from airhilt.audio.wav import decode_wav, encode_wav
from airhilt.errors import SpeechError
from fuzzing import any_input

WHOLE = encode_wav(np.zeros(50, np.float32))
HEAD_BYTES = 44
changes = st.lists(st.tuples(st.integers(0, len(WHOLE) - 1), st.integers(0, 255)), max_size=6)


@any_input
@given(changes, st.integers(0, len(WHOLE)), st.binary(max_size=30))
def test_a_changed_file_gives_samples_within_their_range_or_a_named_error(
    changed: list[tuple[int, int]], length: int, more: bytes
) -> None:
    data = bytearray(WHOLE)
    for place, value in changed:
        data[place] = value
    assert_read(bytes(data[:length]) + more)
    assert_read(bytes(data))


@any_input
@given(st.binary(max_size=300))
def test_any_bytes_after_the_head_of_a_file_are_read_or_refused(data: bytes) -> None:
    assert_read(WHOLE[:HEAD_BYTES] + data)
    assert_read(b"RIFF" + len(data).to_bytes(4, "little") + b"WAVE" + data)


def assert_read(data: bytes) -> None:
    with suppress(SpeechError):
        samples = decode_wav(data, "any.wav")
        assert samples.dtype == np.float32
        assert samples.size > 0
        assert float(np.abs(samples).max()) <= 1.0
