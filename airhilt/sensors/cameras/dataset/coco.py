"""COCO's format: T.-Y. Lin et al., Microsoft COCO, ECCV 2014.

``annotations.json`` has all pictures, and a file a split has those of that split. What COCO has no
word for stands beside it under names of AIRHILT's own.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any, BinaryIO

from airhilt.host.files import replacing
from airhilt.sensors.cameras.dataset.records import Records


def write(records: Records) -> None:
    """Write the annotations of all pictures, and those of each split."""
    balance = records.balance()
    numbers = {label: number for number, label in enumerate(balance.classes, start=1)}
    for split in (None, *sorted(balance.pictures)):
        name = "annotations" if split is None else f"annotations_{split}"
        with replacing(records.folder / f"{name}.json") as stream:
            info = {"description": "AIRHILT", **records.settings}
            stream.write(b'{"info":' + _json(info) + b',"images":[')
            _write_list(stream, (image for image, _ in _pictures(records, numbers, split)))
            stream.write(b'],"annotations":[')
            every = _pictures(records, numbers, split)
            _write_list(stream, (each for _, annotations in every for each in annotations))
            categories = [{"id": number, "name": label} for label, number in numbers.items()]
            stream.write(b'],"categories":' + _json(categories) + b"}")


def _pictures(
    records: Records, numbers: dict[str, int], split: str | None
) -> Iterator[tuple[dict[str, Any], list[dict[str, Any]]]]:
    """Return the pictures of a split and their annotations, which have one number in all files."""
    identity = 0
    for record in records:
        image, annotations = record["image"], record["annotations"]
        if split in (None, image["split"]):
            yield image, [
                {"id": identity + index, "image_id": image["id"],
                 "category_id": numbers[each.pop("class")], **each}
                for index, each in enumerate(annotations, start=1)
            ]  # fmt: skip
        identity += len(annotations)


def _write_list(stream: BinaryIO, items: Iterator[dict[str, Any]]) -> None:
    for index, item in enumerate(items):
        stream.write((b"," if index else b"") + _json(item))


def _json(item: object) -> bytes:
    return json.dumps(item, separators=(",", ":")).encode()
