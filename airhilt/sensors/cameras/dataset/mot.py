"""The format of MOTChallenge for sequences: A. Milan et al., MOT16, arXiv 1603.00831, section 3.4.

A folder a sequence holds ``img1/``, ``gt/gt.txt`` and ``seqinfo.ini``. The pictures are links to
those of the export.
"""

from __future__ import annotations

import os
from itertools import groupby
from typing import Any

from airhilt.host.files import replace_file
from airhilt.sensors.cameras.dataset.records import Records


def write(records: Records) -> None:
    """Write a folder for each sequence below ``mot/<split>/``."""
    numbers = {label: number for number, label in enumerate(records.balance().classes, start=1)}
    ordered = sorted(records, key=lambda each: (each["image"]["sequence"], each["image"]["step"]))
    for _, group in groupby(ordered, key=lambda each: int(each["image"]["sequence"])):
        _write_sequence(records, numbers, list(group))


def _write_sequence(
    records: Records, numbers: dict[str, int], pictures: list[dict[str, Any]]
) -> None:
    first, last = pictures[0]["image"], pictures[-1]["image"]
    name = f"{first['sequence']:06}"
    folder = records.folder / "mot" / first["split"] / name
    for part in ("img1", "gt"):
        (folder / part).mkdir(parents=True, exist_ok=True)
    tracks: dict[str, int] = {}
    lines = []
    for record in pictures:
        image = record["image"]
        link = folder / "img1" / f"{image['step']:06}.jpg"
        link.unlink(missing_ok=True)
        os.link(records.folder / image["file_name"], link)
        for each in record["annotations"]:
            track = tracks.setdefault(each["actor"], len(tracks) + 1)
            box = ",".join(f"{part:.2f}" for part in each["bbox"])
            category, seen = numbers[each["class"]], each["visible_fraction"]
            lines.append(f"{image['step']},{track},{box},1,{category},{seen}\n")
    replace_file(folder / "gt" / "gt.txt", "".join(lines).encode())
    lasted_s = last["t_s"] - first["t_s"]
    rate_hz = (len(pictures) - 1) / lasted_s if lasted_s else 1.0
    about = (
        f"[Sequence]\nname={name}\nimDir=img1\nframeRate={rate_hz:g}\nseqLength={len(pictures)}\n"
        f"imWidth={first['width']}\nimHeight={first['height']}\nimExt=.jpg\n"
    )
    replace_file(folder / "seqinfo.ini", about.encode())
