"""The format that YOLO models are trained on: a file of boxes a picture, lists, ``data.yaml``."""

from __future__ import annotations

import json
from pathlib import Path

from airhilt.host.files import replace_file
from airhilt.sensors.cameras.dataset.records import Records


def write(records: Records) -> None:
    """Write ``labels/``, the list of pictures of each split, and ``data.yaml``.

    A box is its class, its middle and its sides, in parts of the picture.
    """
    folder, balance = records.folder, records.balance()
    numbers = {label: number for number, label in enumerate(balance.classes)}
    (folder / "labels").mkdir(exist_ok=True)
    pictures: dict[str, list[str]] = {"train": [], "val": [], "test": []}
    for record in records:
        image = record["image"]
        columns, rows = image["width"], image["height"]
        lines = []
        for each in record["annotations"]:
            left, top, width, height = each["bbox"]
            middle = (left + width / 2.0) / columns, (top + height / 2.0) / rows
            box = (*middle, width / columns, height / rows)
            lines.append(" ".join((str(numbers[each["class"]]), *(f"{part:.6f}" for part in box))))
        name = Path(image["file_name"])
        _write_lines(folder / "labels" / f"{name.stem}.txt", lines)
        pictures[image["split"]].append(f"./{name.as_posix()}")
    for split, names in pictures.items():
        _write_lines(folder / f"{split}.txt", names)
    about = {**{split: f"{split}.txt" for split in pictures}, "names": list(numbers)}
    # JSON is YAML.
    _write_lines(
        folder / "data.yaml", [f"{key}: {json.dumps(each)}" for key, each in about.items()]
    )


def _write_lines(path: Path, lines: list[str]) -> None:
    replace_file(path, "".join(f"{line}\n" for line in lines).encode())
