"""A key of the log has one schema."""

from __future__ import annotations

import json
from pathlib import Path

from mcap.reader import make_reader

from airhilt.messages import TransmissionChunk, TransmissionClosed, TransmissionOpened
from airhilt.record import LogWriter

KEY = "radio/119100/audio"
PIECES = (
    TransmissionOpened(id="t1", frequency_khz=119_100, t_tx_ns=0),
    TransmissionChunk(id="t1", frequency_khz=119_100, seq=0, first_sample=0, samples=1, sha256=""),
    TransmissionClosed(id="t1", frequency_khz=119_100, t_tx_ns=0, t_end_ns=1, samples=1),
)


def test_all_pieces_of_a_transmission_have_one_schema_that_allows_each(tmp_path: Path) -> None:
    log = LogWriter(tmp_path / "log.mcap")
    for piece in PIECES:
        log.write(KEY, "run", type(piece), 0, piece.model_dump_json().encode())
    log.close()
    with (tmp_path / "log.mcap").open("rb") as stream:
        read = [*make_reader(stream).iter_messages()]
    assert len(read) == len(PIECES)
    ((name, text),) = {(schema.name, schema.data) for schema, _, _ in read if schema}
    schema = json.loads(text)
    assert (name, schema["type"]) == ("airhilt.TransmissionAudio", "object")
    allowed = {one["$ref"].rpartition("/")[2] for one in schema["oneOf"]}
    assert allowed == {type(piece).__name__ for piece in PIECES}
