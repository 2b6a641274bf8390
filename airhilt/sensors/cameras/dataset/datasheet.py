"""The datasheet of a data set: T. Gebru et al., Datasheets for Datasets, CACM 64 (12), 2021."""

from __future__ import annotations

from collections import Counter
from typing import Any

from airhilt.host.files import replace_file
from airhilt.sensors.cameras.dataset.records import Records


def write(records: Records) -> None:
    """Write ``datasheet.md``."""
    places: Counter[str] = Counter()
    sides, visibility, empty = [], [], 0
    for record in records:
        image = record["image"]
        places[image["airport"] or "open country"] += 1
        visibility.append(image["visibility_m"])
        sides += [max(each["bbox"][2:]) for each in record["annotations"]]
        empty += not record["annotations"]
    told = ", ".join(f"{name} {count}" for name, count in sorted(places.items()))
    settings = ", ".join(f"{name} {value}" for name, value in records.settings.items())
    sizes = ", ".join(f"{share} % under {_quantile(sides, share):.0f}" for share in (25, 50, 75))
    header, *rows = records.balance().table()
    table = [header, ["---", *("---:" for _ in header[1:])], *rows]
    text = f"""# Datasheet

**Motivation.** Pictures with their truth, to train and to judge detectors of aircraft, vehicles and
animals.

**Composition.** {records.count} drawn pictures, no photographs; no people can be recognised.
{empty} have nobody in them. Pictures by place: {told}. Visibility {min(visibility):.0f} to
{max(visibility):.0f} m. Longest sides of boxes in pixels: {sizes}.

{chr(10).join(f"| {' | '.join(row)} |" for row in table)}

Boxes are about all of a body that is within the picture, whether hidden or not, cut at the
border. Masks are of the visible pixels; `area` is their number. `calibration` is that of a pinhole
without distortion: `rotation` takes the camera's axes (right, down, ahead) to east, north and up.
Depths, if exported, are along the optical axis in m, as float32.

**Collection.** Drawn by AIRHILT. Settings: {settings}. The same settings give the same bytes.

**Splits.** Worlds are split, never the pictures of one world: weather, light and landscape are not
shared. Airports are; export a test set with `--airport` if it must show another place.

**Uses.** Textures, lenses and sensors are models: a detector trained on these pictures alone is
not one for photographs.

**Distribution and maintenance.** The pictures are yours. `airhilt dataset export` with the settings
above makes them anew.
"""
    replace_file(records.folder / "datasheet.md", text.encode())


def _quantile(values: list[Any], share: int) -> float:
    return float(sorted(values)[len(values) * share // 100]) if values else 0.0
